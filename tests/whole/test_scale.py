"""Large films: dissection, its cost, and what 200,000 vertices take on two cores."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.sparse.csgraph import connected_components

from eulerplateau.film.dissection import Graph, dissect
from eulerplateau.film.quadratic import springs
from eulerplateau.mesh.disk import Disk
from tests.helpers import shapes

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def large() -> Disk:
    """2,791 vertices: dissected several times over."""
    return shapes.mesh_of(*shapes.disk_points(30, jitter=0.2))


def test_parts_hold_every_interior_vertex_once(large: Disk) -> None:
    graph = springs(large).laplacian().tocsr()
    parts = dissect(Graph(graph.indptr, graph.indices), large.loop, large.interior)
    assert len(parts) > 10
    np.testing.assert_array_equal(np.sort(np.concatenate(parts)), large.interior)


def test_what_is_eliminated_first_falls_apart_into_small_pieces(large: Disk) -> None:
    graph = springs(large).laplacian().tocsr()
    parts = dissect(Graph(graph.indptr, graph.indices), large.loop, large.interior)
    # The last part cuts the film in two, and so on down: without the last 2^k - 1 parts
    # no piece holds more than about 1 / 2^k of the vertices.
    for k in (1, 2, 3):
        rest = np.concatenate(parts[: len(parts) - (2**k - 1)])
        _, piece = connected_components(graph[rest][:, rest], directed=False)
        assert np.bincount(piece).max() < 1.3 / 2**k * len(large.interior)


def test_film_is_relaxed_and_stiffness_is_its_pull_on_the_loop(large: Disk) -> None:
    film = springs(large)
    laplacian, condensed = film.laplacian(), film.of_loop(film.rest).condensed
    around = shapes.crumpled(large, 0.1)[large.loop]
    force = laplacian @ condensed.extend(around)
    scale = np.abs(force).max()
    assert np.abs(force[large.interior]).max() < 1e-13 * scale
    pull = condensed.stiffness @ around
    np.testing.assert_allclose(pull, force[large.loop], atol=1e-12 * scale)
    np.testing.assert_array_equal(condensed.stiffness, condensed.stiffness.T)


def test_loop_without_interior_has_its_own_stiffness() -> None:
    mesh = shapes.mesh_of(
        np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]),
        np.array([[0, 1, 2], [0, 2, 3]]),
    )
    film = springs(mesh)
    laplacian, condensed = film.laplacian(), film.of_loop(film.rest).condensed
    expected = laplacian.toarray()[np.ix_(mesh.loop, mesh.loop)]
    np.testing.assert_array_equal(condensed.stiffness, expected)
    np.testing.assert_array_equal(condensed.extend(mesh.x[mesh.loop]), mesh.x)


CHAIN = """
import json, time
import numpy as np
from eulerplateau.mesh import MeshSpec, generate
from eulerplateau.solvers import Problem, solve
from eulerplateau.threads import one_thread
from scripts.studies.common import peak_memory

polygon = {"kind": "stretched-hexagon", "factor": 2.0}
mesh = generate(MeshSpec.model_validate({"polygon": polygon, "vertices": VERTICES}))
x = mesh.x.copy()
x[:, 2] += 1e-3 * np.random.default_rng(1).standard_normal(mesh.n_v)
with one_thread():
    started = time.perf_counter()
    problem = Problem(mesh)
    problem.film.of_loop(mesh.shape)
    seconds = [time.perf_counter() - started]
    for load in (700.0, 705.0):
        found = solve(problem, load, x)
        x = found.shape.x
        seconds.append(found.seconds)
print(json.dumps({
    "seconds": seconds,
    "gigabytes": peak_memory() * 1024 / 1e6,
    "n_unstable": found.n_unstable,
    "converged": found.converged,
    "residual": found.residual,
    "length_error": found.length_error,
}))
"""


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="asks Linux's kernel")
def test_200_000_vertices_take_seconds_and_less_than_a_gigabyte() -> None:
    script = CHAIN.replace("VERTICES", "200_000")
    run = subprocess.run(
        [sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=True
    )
    found = json.loads(run.stdout)
    set_up, _, warm = found["seconds"]
    assert found["converged"]
    assert found["n_unstable"] == 0
    assert found["residual"] < 1e-6
    assert found["length_error"] < 1e-12
    assert set_up < 30
    assert warm < 10
    assert found["gigabytes"] < 1
