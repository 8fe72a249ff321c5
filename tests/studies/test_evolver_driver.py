"""What scripts/error_vs_time asks of Evolver, as far as it can be tried without it."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.mesh.disk import Disk
from eulerplateau.solvers.problem import Problem
from scripts.studies.error_vs_time import evolver
from scripts.studies.error_vs_time.evolver_files import (
    film_datafile,
    newton_script,
    start_script,
    string_datafile,
)
from tests.helpers import shapes

SIGMA = 1400.0


@dataclass(frozen=True)
class Parsed:
    """What a datafile says, read by the rules of Evolver's manual."""

    x: FloatArray
    marked: list[bool]
    edges: IntArray
    edge_length: list[str]
    faces: list[list[int]]
    tensions: list[float]
    fixed: dict[str, float]

    def triangle(self, face: int) -> list[int]:
        """The vertices of a face, in the order its sides are passed."""
        sides = [self.edges[abs(k) - 1][:: 1 if k > 0 else -1] for k in self.faces[face]]
        ends = np.array(sides)
        assert (ends[:, 1] == np.roll(ends[:, 0], -1)).all()
        return ends[:, 0].tolist()


def read(text: str) -> Parsed:
    top, rest = text.split("\nvertices\n")
    vertices, rest = rest.split("\nedges\n")
    edges, _, rest = rest.partition("\nread")[0].partition("\nfaces\n")
    points = [row.split() for row in vertices.splitlines()]
    lines = [row.split() for row in edges.splitlines()]
    faces = [row.split() for row in rest.splitlines()]
    for rows in (points, lines, faces):
        assert [int(row[0]) for row in rows] == list(range(1, len(rows) + 1))
    size = int(re.findall(r"SPACE_DIMENSION (\d)", top)[0])
    fixed = re.findall(r"quantity (\w+) fixed = (\S+) method", top)
    return Parsed(
        x=np.array([row[1 : 1 + size] for row in points], dtype=float),
        marked=["bending" in row for row in points],
        edges=np.array([row[1:3] for row in lines], dtype=np.int64),
        edge_length=[next((w for w in row if "length_" in w), "") for row in lines],
        faces=[[int(side) for side in row[1:4]] for row in faces],
        tensions=[float(row[5]) for row in faces],
        fixed={name: float(value) for name, value in fixed},
    )


@pytest.fixture(scope="module")
def bent(oval: Disk) -> FloatArray:
    """The oval, turned out of its plane."""
    return (oval.x + [0.0, 0.0, 0.5] * oval.x[:, [2, 2, 0]]) @ shapes.rotation()


def test_film_datafile_holds_the_mesh_and_the_start_to_the_last_bit(
    oval: Disk, bent: FloatArray
) -> None:
    film = read(film_datafile(oval, bent, SIGMA).text)
    assert np.array_equal(film.x, bent)
    assert {frozenset(edge) for edge in (film.edges - 1).tolist()} == {
        frozenset(edge) for edge in oval.edges.tolist()
    }
    triangles = [film.triangle(face) for face in range(len(film.faces))]
    assert [sorted(t) for t in triangles] == np.sort(oval.triangles + 1, axis=1).tolist()
    for ours, given in zip(triangles, (oval.triangles + 1).tolist(), strict=True):
        assert ours in [given, given[1:] + given[:1], given[2:] + given[:2]]
    assert film.tensions == [SIGMA] * len(oval.triangles)


def test_every_loop_edge_is_fixed_at_its_own_rest_length_and_no_other_edge(
    oval: Disk, bent: FloatArray
) -> None:
    film = read(film_datafile(oval, bent, SIGMA).text)
    follower = dict(zip(oval.loop.tolist(), np.roll(oval.loop, -1).tolist(), strict=True))
    seen = {}
    for (i, j), name in zip((film.edges - 1).tolist(), film.edge_length, strict=True):
        on_loop = follower.get(i) == j or follower.get(j) == i
        assert bool(name) == on_loop
        if on_loop:
            start = i if follower.get(i) == j else j
            seen[start] = film.fixed[name]
    assert [seen[v] for v in oval.loop.tolist()] == oval.rest_lengths.tolist()


def test_bending_belongs_to_the_loop_vertices(oval: Disk, bent: FloatArray) -> None:
    film = read(film_datafile(oval, bent, SIGMA).text)
    assert np.flatnonzero(film.marked).tolist() == sorted(oval.loop.tolist())


def test_moments_are_fixed_where_the_start_has_them(oval: Disk, bent: FloatArray) -> None:
    moved = bent + np.array([0.1, 0.2, 0.3])
    fixed = read(film_datafile(oval, moved, SIGMA).text).fixed
    shifts = [fixed[f"shift_{axis}"] for axis in "xyz"]
    assert shifts == pytest.approx(moved[oval.loop].sum(axis=0), rel=1e-15)
    assert [fixed[f"turn_{axis}"] for axis in "xyz"] == [0.0, 0.0, 0.0]


def test_string_datafile_is_the_loop_in_order(oval: Disk) -> None:
    data = string_datafile(oval, oval.x, SIGMA)
    string = read(data.text)
    assert np.array_equal(string.x, oval.x[oval.loop, :2])
    n = oval.n_b
    expected = [[v + 1, (v + 1) % n + 1] for v in range(n)]
    assert string.edges.tolist() == expected
    lengths = [string.fixed[name] for name in string.edge_length]
    assert lengths == oval.rest_lengths.tolist()
    assert string.faces == []


def output(ids: list[int], x: FloatArray, energy: float, decrease: float) -> str:
    """What the scripts print, among what Evolver echoes."""
    rows = ["Enter command: quiet on;", f"RESULT {energy!r} 7 {decrease!r} 54.5"]
    rows += [
        f"AT {i} {a!r} {b!r} {c!r}" for i, (a, b, c) in zip(ids, x.tolist(), strict=True)
    ]
    return "\n".join([*rows, "VmHWM:\t    2048 kB", "Enter command: q"])


def test_result_is_read_back_in_the_order_of_the_loop(oval: Disk, bent: FloatArray) -> None:
    """Evolver lists vertices in an order of its own."""
    data = film_datafile(oval, bent, SIGMA)
    mixed = np.random.default_rng(0).permutation(oval.loop)
    run = evolver.parse(output((mixed + 1).tolist(), bent[mixed], 150.5, 0.0), data)
    assert np.array_equal(run.loop, bent[oval.loop])
    assert (run.energy, run.bending, run.steps, run.memory) == (150.5, 54.5, 7, 2.0)


@pytest.mark.parametrize(
    ("decrease", "converged"), [(0.0, True), (1e-12, True), (1.0, False), (-1.0, False)]
)
def test_converged_is_what_no_longer_changes(
    oval: Disk, decrease: float, converged: bool
) -> None:
    data = string_datafile(oval, oval.x, SIGMA)
    ids = list(range(1, oval.n_b + 1))
    run = evolver.parse(output(ids, oval.x[oval.loop], 150.0, decrease), data)
    assert run.converged is converged


@pytest.mark.parametrize("printed", ["", "ERROR 1234", "RESULT (NaN) 3 (NaN) (NaN)"])
def test_output_without_a_result_is_refused(oval: Disk, printed: str) -> None:
    with pytest.raises(ValueError, match="Evolver"):
        evolver.parse(printed, string_datafile(oval, oval.x, SIGMA))


def test_without_evolver_there_is_a_clear_error(
    oval: Disk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", "")
    assert evolver.find_evolver() is None
    with pytest.raises(FileNotFoundError):
        evolver.run_evolver(string_datafile(oval, oval.x, SIGMA), newton_script(True))


def evolver_bending(x: FloatArray) -> float:
    """The formula that Evolver's energies show: (2 u + u^2 / 3) / <s>, u = 1 - cos t."""
    edges = np.roll(x, -1, axis=0) - x
    s = np.linalg.norm(edges, axis=1)
    t = edges / s[:, None]
    u = 1 - (t * np.roll(t, 1, axis=0)).sum(axis=1)
    return float(np.sum((2 * u + u**2 / 3) / ((s + np.roll(s, 1)) / 2)))


def bending(mesh: Disk) -> float:
    """The bending energy of a mesh at rest."""
    return Problem(mesh).bending_energy(mesh.shape)[0]


def test_bending_of_evolver_and_ours_differ_by_a_twelfth_of_the_squared_angle() -> None:
    """Between (2 u + u^2/3) and 2 u lies u/6 = t^2/12: on a regular polygon exactly so."""
    for rings in (2, 4, 8):
        mesh = shapes.mesh_of(*shapes.disk_points(rings))
        u = 1 - np.cos(2 * np.pi / (6 * rings))
        ratio = evolver_bending(mesh.x[mesh.loop]) / bending(mesh)
        assert ratio == pytest.approx(1 + u / 6, rel=1e-12)


def test_start_script_takes_no_step() -> None:
    assert "hessian_seek" not in start_script(True)
    assert "hessian_seek" in newton_script(True)
