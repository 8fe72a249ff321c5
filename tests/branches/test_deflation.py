"""Deflation against Farrell, Birkisson and Funke's formula, and on films."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.branches.deflation import deflated, factor, newton, search, towards_index
from eulerplateau.branches.film_family import family_near, likeness_of
from eulerplateau.solvers import Problem, solve, tangent_model
from tests.helpers.shapes import disk_points, mesh_of

ROOTS = 1.0, -2.0, 0.25


def cubic(x: float) -> float:
    return float(np.prod([x - root for root in ROOTS]))


def slope(x: float) -> float:
    return float(np.polyval(np.polyder(np.poly(ROOTS)), x))


def deflated_step(x: float, known: list[float]) -> float:
    step = -cubic(x) / slope(x)
    slopes = [2 * (x - root) * step for root in known]
    return factor(slopes, [(x - root) ** 2 for root in known]) * step


@pytest.mark.parametrize("known", [[1.0], [1.0, -2.0]])
def test_it_is_newtons_step_of_the_deflated_function(known: list[float]) -> None:
    """G = f prod (1 / |x - r|^2 + 1), its derivative by differences."""

    def g(x: float) -> float:
        return cubic(x) * float(np.prod([1 + 1 / (x - root) ** 2 for root in known]))

    for x in (3.0, 0.6, -1.0, -7.0):
        h = 1e-5
        expected = -g(x) * 2 * h / (g(x + h) - g(x - h))
        assert deflated_step(x, known) == pytest.approx(expected, rel=1e-6)


def test_it_comes_to_all_roots_from_one_start() -> None:
    known: list[float] = []
    for _ in ROOTS:
        x = 1.1
        for _ in range(200):
            x += deflated_step(x, known)
        known.append(x)
    assert sorted(known) == pytest.approx(sorted(ROOTS), abs=1e-12)
    assert known[0] == pytest.approx(1.0, abs=1e-12)


def test_newton_next_to_an_equilibrium_that_is_known_turns_away_from_it() -> None:
    points, triangles = disk_points(4)
    problem = Problem(mesh_of(points * [1.6, 1.0], triangles), "dirichlet")
    load = 500.0
    found = solve(problem, load)
    assert found.converged
    family, x = family_near(problem, found.shape)
    same = likeness_of(problem, 0.01)
    model = tangent_model(family.energy(load), x)
    moved = model.displacement(model.eigen[1][:, 0])
    start = family.energy(load).constraint.project(x + 1e-3 * moved)
    assert start is not None
    back = search(family, start, load, newton)
    assert back is not None
    assert same.distance(back.x, x) < 1e-9
    # Newton's step goes straight back, d^2' = -2 d^2: times 1 / (1 - 2) it goes away.
    near = tangent_model(family.energy(load), start)
    away = deflated([x], same)(near)
    assert away / newton(near) == pytest.approx(-np.ones(len(away)), rel=0.05)
    other = search(family, start, load, deflated([x], same))
    assert other is None or same.distance(other.x, x) > 0.01


def test_climbing_along_soft_modes_comes_back_to_a_saddle_of_that_index() -> None:
    """Where plain descent leaves it: the disk above its first threshold."""
    problem = Problem(mesh_of(*disk_points(4)), "dirichlet")
    # 16 pi^3 n^2 (n^2 - 1) / (n^2 - n - 1): 5953 for n = 2 is below, 7144 for n = 3 above.
    load = 6500.0
    family, x = family_near(problem, problem.disk.shape)
    same = likeness_of(problem, 0.01)
    flat = search(family, x, load, newton)
    assert flat is not None
    index = flat.stability.n_unstable
    assert index > 0
    moved = flat.model.displacement(flat.model.eigen[1][:, :2] @ np.array([1e-2, -2e-2]))
    start = family.energy(load).constraint.project(flat.x + moved)
    assert start is not None
    back = search(family, start, load, towards_index(index))
    assert back is not None
    assert same.distance(back.x, flat.x) < 1e-9
    down = search(family, start, load, towards_index(0))
    assert down is None or same.distance(down.x, flat.x) > 1e-2
