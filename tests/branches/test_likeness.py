"""Which loops are the same: exactly known copies, and how a distance changes."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.film_family import likeness_of
from eulerplateau.branches.likeness import Likeness
from eulerplateau.loop import project_lengths
from eulerplateau.mesh.disk import Disk
from eulerplateau.solvers import Problem
from tests.helpers.shapes import disk_points, mesh_of, rotation

WITHIN = 0.01


def oval() -> Disk:
    points, triangles = disk_points(4)
    return mesh_of(points * [1.6, 1.0], triangles)


def bent(problem: Problem, seed: int = 1) -> FloatArray:
    """A loop without any symmetry that keeps its lengths."""
    rng = np.random.default_rng(seed)
    n = problem.disk.n_b
    s = 2 * np.pi * np.arange(n) / n
    x = problem.disk.x[problem.disk.loop].copy()
    for wave in (2, 3):
        a, b = 0.02 * rng.standard_normal((2, 3))
        x += np.outer(np.cos(wave * s), a) + np.outer(np.sin(wave * s), b)
    found = project_lengths(problem.loop, x)
    assert found is not None
    return found


def same(film: str, disk: Disk | None = None) -> tuple[Problem, Likeness]:
    problem = Problem(oval() if disk is None else disk, film)
    return problem, likeness_of(problem, WITHIN)


@pytest.mark.parametrize("film", ["springs", "area"])
def test_rigid_motions_and_reflections_make_no_difference(film: str) -> None:
    problem, like = same(film)
    x = bent(problem)
    turned = x @ rotation() + [1.0, -2.0, 0.5]
    assert like.distance(x, turned) < 1e-12
    assert like.distance(x, turned * [1.0, 1.0, -1.0]) < 1e-12
    assert like.distance(x, bent(problem, 2)) > 0.01


def test_a_soap_film_may_be_numbered_from_anywhere_either_way_round() -> None:
    problem, like = same("area", mesh_of(*disk_points(4)))
    x = bent(problem)
    assert like.distance(x, np.roll(x, 5, axis=0)) < 1e-12
    assert like.distance(x, np.roll(x, 5, axis=0)[::-1] @ rotation()) < 1e-12


def test_a_soap_films_loop_may_slide_by_a_part_of_an_edge() -> None:
    """Then the rest is curvature's: by half an edge at most another number is nearer."""
    problem, like = same("area", mesh_of(*disk_points(8)))
    x = bent(problem)
    slid = 0.7 * x + 0.3 * np.roll(x, -1, axis=0)
    edge = problem.loop.rest_lengths.max()
    assert np.sqrt(np.mean(np.sum((slid - x) ** 2, axis=1))) > 0.29 * edge
    # Points of a chord lie off the curve by 0.3 * 0.7 / 2 kappa s^2, kappa < 4 pi here.
    assert like.distance(x, slid) < 0.105 * 4 * np.pi * edge**2


def test_a_tied_film_is_renumbered_by_the_symmetries_of_its_rest_shape_only() -> None:
    problem, like = same("springs")
    n = problem.disk.n_b
    assert len(like.numberings) == 4
    x = bent(problem)
    assert like.distance(x, np.roll(x, n // 2, axis=0)) < 1e-12
    assert like.distance(x, np.roll(x, 5, axis=0)) > 0.01
    assert len(same("springs", mesh_of(*disk_points(4)))[1].numberings) >= 12


@pytest.mark.parametrize("film", ["springs", "area"])
def test_a_distance_changes_at_the_rate_its_slope_says(film: str) -> None:
    problem, like = same(film)
    x = bent(problem)
    other = 0.9 * x + 0.1 * bent(problem, 2)
    moved = np.random.default_rng(3).standard_normal(x.shape)
    slope = like.slope(like.difference(x, other), moved)
    h = 1e-6
    ends = [like.difference(x + sign * h * moved, other).square for sign in (1, -1)]
    assert (ends[0] - ends[1]) / (2 * h) == pytest.approx(slope, rel=1e-5)


@pytest.mark.parametrize(("wave", "turns"), [(2, 2), (3, 3), (1, 0)])
def test_parts_that_are_alike_are_counted(wave: int, turns: int) -> None:
    _, like = same("area", mesh_of(*disk_points(8)))
    s = 2 * np.pi * np.arange(48) / 48
    radius = (1 + (0.2 * np.cos(wave * s) if wave > 1 else 0)) / (2 * np.pi)
    x = np.stack([radius * np.cos(s), radius * np.sin(s), 0 * s], axis=1)
    assert like.turns(x, WITHIN) == turns
