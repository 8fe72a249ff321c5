"""Catalogues where it is known what there is."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from eulerplateau.branches import Entry, Plan, catalogue_at, equilibrium_near, explore
from eulerplateau.mesh.disk import Disk
from eulerplateau.solvers import Problem
from tests.helpers.shapes import disk_points, mesh_of


def oval(rings: int = 4) -> Disk:
    points, triangles = disk_points(rings)
    return mesh_of(points * [1.6, 1.0], triangles)


@pytest.fixture(scope="module")
def bare() -> list[Entry]:
    """A loop that next to no film pulls at: a free elastica that is closed."""
    problem = Problem(mesh_of(*disk_points(8)), "dirichlet")
    return catalogue_at(problem, 1e-3, Plan(starts=25))


@pytest.mark.slow
def test_closed_elasticas_are_circles_wound_once_or_more_often(bare: list[Entry]) -> None:
    """Wound m times: energy (2 pi m)^2, and 2 (m - 1) unstable modes, n^2 (n^2 - m^2) < 0.

    Out of the plane, each twice (n = 1 ... m - 1); in it (n^2 - m^2)^2 > 0.
    """
    n = 48
    times = []
    for entry in bare:
        if entry.symmetry.startswith("round"):
            energy, index = entry.equilibrium.energy, entry.equilibrium.n_unstable
            m = round(np.sqrt(energy) / (2 * np.pi))
            # Of the polygon: n^2 times the square of twice the sine of half its turning.
            assert energy == pytest.approx((2 * n * np.sin(np.pi * m / n)) ** 2, abs=1e-3)
            assert index == 2 * (m - 1)
            assert entry.symmetry == ("round" if m == 1 else f"round; wound {m} times")
            times.append(m)
    assert times[:2] == [1, 2]
    assert bare[0].symmetry == "round"


@pytest.mark.slow
def test_the_elastic_eight_is_among_them(bare: list[Entry]) -> None:
    """Curvature 4 k K cn(4 K s), 2 E = K: energy 64 K (E - (1 - k^2) K) = 112.4.

    A polygon of 48 edges errs by 0.6 % already where it is a circle wound twice.
    """
    m = brentq(lambda m: 2 * ellipe(m) - ellipk(m), 0.5, 0.99)
    energy = 64 * ellipk(m) * (ellipe(m) - (1 - m) * ellipk(m))
    energies = np.array([entry.equilibrium.energy for entry in bare])
    assert np.abs(energies / energy - 1).min() < 0.01
    assert min(entry.equilibrium.n_unstable for entry in bare[1:]) > 0


@pytest.mark.slow
def test_above_a_pitchfork_there_are_the_planar_saddle_and_one_twisted_minimum() -> None:
    """Both twists are one, up to reflection; their indices are those of the branches."""
    problem = Problem(oval(), "dirichlet")
    points = explore(problem, (1500.0, 3500.0), special_points=0, unstable_modes=1)
    onset = next(p.special.point.value for p in points if p.special is not None)
    load = 1.01 * onset
    found = catalogue_at(problem, load, Plan(starts=8, index=1))
    lowest, planar = found[:2]
    assert [e.equilibrium.n_unstable for e in (lowest, planar)] == [0, 1]
    assert planar.symmetry == "2-fold; box"
    assert lowest.symmetry.count("half turn") == 3
    assert "mirror" not in lowest.symmetry
    assert sum(entry.equilibrium.n_unstable == 0 for entry in found) == 1
    for entry in found:
        again = equilibrium_near(problem, entry.equilibrium.shape, load)
        assert again.energy == pytest.approx(entry.equilibrium.energy, rel=1e-9)
        assert again.n_unstable == entry.equilibrium.n_unstable


def test_a_soap_disk_below_its_first_threshold_is_the_only_minimum() -> None:
    """48 pi^3 = 1488; E = sigma / 4 pi + 4 pi^2 of the circle, here of a polygon."""
    problem = Problem(mesh_of(*disk_points(4)), "area")
    load = 800.0
    found = catalogue_at(problem, load, Plan(starts=2, index=0))
    (disk,) = found
    assert disk.symmetry == "round"
    n = 24
    area = 1 / (4 * n * np.tan(np.pi / n))
    bending = (2 * n * np.sin(np.pi / n)) ** 2
    assert disk.equilibrium.energy == pytest.approx(load * area + bending, rel=1e-9)
    assert disk.starts
    assert disk.guesses[0] == 0


@pytest.mark.slow
def test_the_same_seed_gives_the_same_catalogue_and_calls_are_counted() -> None:
    problem = Problem(oval(3), "dirichlet")
    calls: list[None] = []
    plan = Plan(starts=1, seed=7)
    first = catalogue_at(problem, 800.0, plan, lambda: calls.append(None))
    second = catalogue_at(problem, 800.0, plan)
    assert len(calls) == 2 * plan.starts
    told = [
        [(e.equilibrium.energy, e.starts, e.guesses, e.symmetry) for e in found]
        for found in (first, second)
    ]
    assert told[0] == told[1]
