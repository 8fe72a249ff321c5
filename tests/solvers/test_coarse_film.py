"""A rough start of a large soap film goes through the minimum of a coarse one."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.mesh import mesh_polygon
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.triangles import directed_edges
from eulerplateau.solvers import Problem, solve, sweep
from eulerplateau.solvers.large_loops.coarse_film import coarse_disk
from eulerplateau.solvers.large_loops.coarse_start import coarsen
from tests.helpers import shapes

LOAD = 1500.0  # at which the film has two lobes


@pytest.fixture(scope="module")
def large() -> Disk:
    return mesh_polygon("stretched-hexagon", factor=2.0, vertices=2500)


@pytest.mark.parametrize("kept", [12, 25, 64])
def test_the_coarse_disk_lies_on_the_loop_with_all_triangles_upright(
    large: Disk, kept: int
) -> None:
    coarse = coarsen(Problem(large, "area").loop, kept)
    disk = coarse_disk(large, coarse)
    assert disk.n_b == kept
    np.testing.assert_array_equal(disk.x[disk.loop], large.x[large.loop[coarse.kept]])
    assert disk.rest_lengths.sum() == pytest.approx(1.0, abs=1e-14)
    # Euler's formula of a disk, whose border is the loop in its order.
    assert len(disk.triangles) == 2 * disk.n_v - 2 - kept
    edges = {tuple(edge) for edge in directed_edges(disk.triangles)}
    border = {edge for edge in edges if edge[::-1] not in edges}
    assert border == set(zip(disk.loop, np.roll(disk.loop, -1), strict=True))
    a, b, c = disk.x[disk.triangles].transpose(1, 0, 2)
    assert (np.cross(b - a, c - a)[:, 2] > 0.0).all()


@pytest.mark.slow
@pytest.mark.parametrize("rod", [{}, {"twist_ratio": 0.7, "link": 0.3}])
def test_a_rough_start_comes_to_the_minimum_that_a_sweep_leads_to(
    large: Disk, rod: dict[str, float]
) -> None:
    """As nearly as it is told on a mesh whose vertices may lie elsewhere."""
    problem = Problem(large, "area", **rod)
    assert large.n_b > 128
    rough = solve(problem, LOAD)
    *_, swept = sweep(problem, [600.0, 900.0, 1200.0, LOAD])
    assert rough.converged
    assert rough.n_unstable == 0
    assert rough.energy == pytest.approx(swept.energy, rel=1e-6)


@pytest.mark.slow
def test_steps_on_the_mesh_do_not_grow_in_number_with_it(large: Disk) -> None:
    finer = mesh_polygon("stretched-hexagon", factor=2.0, vertices=10_000)
    few, many = (solve(Problem(disk, "area"), LOAD) for disk in (large, finer))
    assert few.converged
    assert many.converged
    assert many.iterations <= few.iterations + 1


def test_who_observes_sees_the_loop_of_the_mesh(large: Disk) -> None:
    seen = []
    start = shapes.crumpled(large, 1e-3)
    solve(Problem(large, "area"), 600.0, start, observe=seen.append)
    assert {x.shape for x in seen} == {(large.n_b, 3)}
