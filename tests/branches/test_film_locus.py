"""The disk's critical link over its load, on meshes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.branches import (
    BIFURCATION,
    StepControl,
    follow_locus,
    locus_start,
    special_at,
)
from eulerplateau.branches.film_family import family_near
from eulerplateau.solvers import Problem
from eulerplateau.threads import one_thread
from tests.solvers.test_twist import ROUND, critical_link, disk, lost_at

NU = 1.0
CUBE = 16 * np.pi**3
WINDOW = 0.2 * CUBE, 1.9 * CUBE


def errors(n_b: int) -> tuple[FloatArray, FloatArray]:
    """Ascending loads, and how far the critical link is off there, of itself."""
    near = lost_at("area", NU, ROUND, 2, n_b)
    problem = Problem(disk(n_b), "area", twist_ratio=ROUND, link=near)
    family, x = family_near(problem, disk(n_b).shape, "link", NU * CUBE)
    special = replace(special_at(family, x, near, BIFURCATION), multiplicity=2)
    first = StepControl((0.1, 3.0), 3.0, first_step=0.1, largest_step=0.1, least=-np.inf)
    second = StepControl(WINDOW, WINDOW[1])
    with one_thread():
        start = locus_start(special, "load", NU * CUBE, (first, second))
        points = list(follow_locus(start))
    assert all(point.course.symmetric and point.n_unstable == 0 for point in points)
    values = np.array([point.values for point in points if not point.special])
    links, loads = values[values[:, 1].argsort()].T
    exact = [critical_link("area", load / CUBE, ROUND, 2) for load in loads]
    return loads, links / exact - 1


@pytest.mark.slow
def test_the_disk_s_critical_link_over_its_load_has_order_2_all_along() -> None:
    (loads, coarse), (others, fine) = (errors(n_b) for n_b in (24, 48))
    assert loads[0] < WINDOW[0]
    assert loads[-1] > WINDOW[1]
    there = (others > loads[0]) & (others < 1.6 * CUBE)
    ratios = np.interp(others[there], loads, coarse) / fine[there]
    np.testing.assert_allclose(np.log2(ratios), 2, atol=0.15)
