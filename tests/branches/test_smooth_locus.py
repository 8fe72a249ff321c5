"""Curves of special points of films without a mesh, with a rod that resists twist."""

from __future__ import annotations

from math import inf, pi

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.branches import (
    BIFURCATION,
    LocusPoint,
    Resolution,
    Special,
    StepControl,
    follow_locus,
    locus_start,
    special_at,
)
from eulerplateau.branches.conformal import (
    CurvedFamily,
    Harmonics,
    SmoothFamily,
    critical_moment,
    films_by_writhe,
    in_basis,
    smooth_family,
    stiffness,
    tail,
)
from eulerplateau.branches.conformal.by_writhe import CONTROL, lobes_at
from eulerplateau.exact.conformal import TWISTED, disk, make_basis
from eulerplateau.threads import one_thread
from tests.helpers.marks import quick_with


def followed(
    family: SmoothFamily,
    flat: FloatArray,
    near: tuple[float, str, float],
    *windows: tuple[float, float],
    largest: float = 0.1,
    resolution: Resolution | None = None,
) -> list[LocusPoint]:
    """The curve through a bifurcation near a value of the family's parameter."""
    value, second, other = near
    least = -inf if second == "link" else 0.0
    controls = tuple(
        StepControl(window, max(np.abs(window)), largest_step=largest, least=least)
        for window, least in zip(windows, (-inf, least), strict=True)
    )
    with one_thread():
        special = special_at(family, flat, value, BIFURCATION)
        start = locus_start(special, second, other, controls)  # type: ignore[arg-type]
        return list(follow_locus(start, resolution=resolution or Resolution()))


def of_disk(
    load: float, ratio: float, second: str, window: tuple[float, float]
) -> list[LocusPoint]:
    basis = make_basis(6, TWISTED)
    values = {"load": load, "twist_ratio": ratio, "link": 0.0}
    family = SmoothFamily(basis, values, "link")
    flat = family.unknowns.x(disk(basis, load).coefficients)
    near = critical_link(load, ratio), second, values[second]
    return followed(family, flat, near, (-0.1, 4.0), window)


def critical_link(load: float, ratio: float) -> float:
    return critical_moment(load) / (4 * pi * ratio)


@pytest.mark.slow
def test_the_disk_is_lost_where_the_theory_says_all_along_a_curve() -> None:
    """Phi_2 = 2 pi (B/C) sqrt((3 - nu)(1 - nu / 6)), to 1e-10; and left-handed beyond."""
    ratio = 0.8
    points = of_disk(500.0, ratio, "load", (20.0, 1500.0))
    links, loads = np.transpose([point.values for point in points])
    assert loads.min() < 20
    nu = loads / (16 * pi**3)
    exact = (3 - nu) * (1 - nu / 6) / ratio**2
    np.testing.assert_allclose(links**2, exact, rtol=2e-10, atol=1e-12)
    assert all(point.n_unstable == 0 for point in points)
    (turn,) = (point for point in points if point.special == Special.TURN)
    assert turn.values[1] == pytest.approx(48 * pi**3, rel=1e-12)
    assert turn.values[0] == pytest.approx(0, abs=1e-9)


@pytest.mark.slow
def test_the_disk_s_threshold_over_the_natural_curvature_of_its_rod() -> None:
    """sigma_2(q) = 96 pi^3 [1 - q (q + g) / (q + 4 g)], to 1e-10."""
    g, q = 0.75, 0.5
    basis = make_basis(6, TWISTED)
    near = 96 * pi**3 * (1 - q * (q + g) / (q + 4 * g))
    values = {"load": near, "twist_ratio": g, "link": 0.0, "rest_curvature": q}
    family = CurvedFamily(basis, values, "load")
    flat = family.unknowns.x(disk(basis, near).coefficients)
    points = followed(
        family, flat, (near, "rest_curvature", q), (1000.0, 3000.0), (0.1, 1.2)
    )
    loads, curvatures = np.transpose([point.values for point in points])
    assert curvatures.min() < 0.1
    assert curvatures.max() > 1.2
    exact = 96 * pi**3 * (1 - curvatures * (curvatures + g) / (curvatures + 4 * g))
    np.testing.assert_allclose(loads, exact, rtol=1e-10)
    assert all(point.course.symmetric for point in points)


@pytest.mark.parametrize("load", quick_with([500.0], [50.0, 100.0, 500.0, 1000.0]))
def test_the_disk_s_bifurcation_changes_its_nature_where_films_of_given_writhe_say(
    load: float,
) -> None:
    """At C/B = -E_0''(0+) / 8 pi^2: by the cubic coefficient, and by films off the disk."""
    at = {50.0: 1.3, 100.0: 1.3, 500.0: 1.1, 1000.0: 0.7}[load]
    points = of_disk(load, at, "twist_ratio", (at - 0.05, at + 0.1))
    (found,) = (p for p in points if p.special == Special.NATURE)
    writhes, ratios = [], []
    for point in films_by_writhe(load):
        writhes.append(smooth_family(point).twist(point.value).writhe(point.x))
        ratios.append(-stiffness(point) / (8 * pi**2))
        if len(writhes) == 6:
            break
    # Beside the disk, to no writhe.
    expected = np.polyfit(writhes, ratios, 4)[-1]
    assert found.values[1] == pytest.approx(expected, abs=1e-6)
    for point in points:  # supercritical above
        above = point.values[1] - found.values[1]
        assert point.special or point.coefficient * above > 0


@pytest.mark.slow
def test_the_disk_s_nature_without_film_is_that_of_rings_of_dna() -> None:
    """11/8 at no load, where a film without a mesh is free to slide; linear next to it."""
    found = []
    for load in (2.0, 4.0):
        points = of_disk(load, 1.36, "twist_ratio", (1.35, 1.4))
        found += [p.values[1] for p in points if p.special == Special.NATURE]
    nearer, farther = found
    assert 2 * nearer - farther == pytest.approx(11 / 8, abs=2e-6)


def of_lobes(
    load: float, second: str, window: tuple[float, float], largest: float
) -> tuple[SmoothFamily, list[LocusPoint]]:
    """The curve through where flat lobes twist, at the C/B that E_0'' asks for."""
    flat = lobes_at(load)
    ratio = -stiffness(flat) / (8 * pi**2)
    values = {"load": load, "twist_ratio": ratio, "link": 0.0}
    family = SmoothFamily(smooth_family(flat).basis, values, "load")
    near = load, second, values[second]
    points = followed(family, flat.x, near, (1850.0, 2090.0), window, largest=largest)
    return family, points


@pytest.mark.slow
def test_harmonics_are_added_where_a_curve_asks_for_them() -> None:
    """From too few, flat lobes twist at the C/B that E_0'' of better films asks for."""
    fine = lobes_at(1900.0)
    crowding = smooth_family(fine).basis.crowding
    coarse = in_basis(fine, make_basis(48, TWISTED, crowding), CONTROL)
    assert coarse is not None
    assert tail(coarse) > 1e-10
    ratio = -stiffness(coarse) / (8 * pi**2)
    values = {"load": 1900.0, "twist_ratio": ratio, "link": 0.0}
    family = SmoothFamily(smooth_family(coarse).basis, values, "load")
    near, windows = (1900.0, "twist_ratio", ratio), ((1890.0, 2050.0), (0.0, 1.0))
    points = followed(
        family, coarse.x, near, *windows, largest=0.03, resolution=Harmonics()
    )
    *_, last = (point for point in points if point.arclength > 0)
    assert len(last.model.x) > len(points[0].model.x) > len(coarse.x)
    for point in (points[0], last):
        load, ratio = (float(value) for value in point.values)
        expected = -stiffness(lobes_at(load)) / (8 * pi**2)
        assert ratio == pytest.approx(expected, rel=1e-8)


@pytest.mark.slow
def test_flat_lobes_twist_where_their_least_energy_of_given_writhe_says() -> None:
    """Where E_0''(0) + 8 pi^2 C/B = 0, by another solver; 1855.67727 at no C/B."""
    family, points = of_lobes(1900.0, "twist_ratio", (0.0, 1.0), 0.03)
    assert all(point.course.symmetric for point in points)
    loads, ratios = np.transpose([point.values for point in points])
    ends = np.argsort(ratios)[:2]
    assert ratios[ends[0]] < 1e-4
    slope = np.diff(loads[ends])[0] / np.diff(ratios[ends])[0]
    at_none = loads[ends[0]] - slope * ratios[ends[0]]
    assert at_none == pytest.approx(1855.67727, abs=1e-4)
    resolved = [
        point
        for point in points
        if family.basis.tail(family.unknowns.loop(point.model.x).coefficients) < 1e-8
    ]
    assert max(point.values[0] for point in resolved) > 1950
    for point in resolved[::3]:
        load, ratio = (float(value) for value in point.values)
        expected = -stiffness(lobes_at(load)) / (8 * pi**2)
        assert ratio == pytest.approx(expected, abs=1e-6)
    # It never turns back, and its pitchfork is subcritical below some load, not above:
    # harmonics that are enough up to 1960 say where to no more than that.
    assert {point.special for point in points} == {"", "start", Special.NATURE}
    (change,) = (point for point in points if point.special == Special.NATURE)
    assert all(
        point.special or (point.coefficient > 0) == (point.values[0] > change.values[0])
        for point in points
    )


@pytest.mark.slow
def test_a_link_leaves_two_folds_of_the_lobes_bifurcation_that_meet_in_its_cusp() -> None:
    _, points = of_lobes(1900.0, "link", (-2e-3, 2e-3), 0.01)
    assert not any(point.course.symmetric for point in points)
    assert points[0].special == Special.CUSP
    # What a link takes from flat lobes, whose half turns it leaves.
    mirrors = {f"mirror across {axis} axis" for axis in ("long", "middle", "short")}
    assert set(points[0].course.breaks) == mirrors | {"inversion"}
    loads, links = np.transpose([point.values for point in points])
    assert links[0] == pytest.approx(0, abs=1e-9)
    assert links.min() < -2e-3
    assert links.max() > 2e-3
    # Mirror images of each other; a cusp is |Lk|^(2/3) wide.
    near = (np.abs(links) > 1e-5) & (np.abs(links) < 1e-3)
    away = np.log(np.abs(loads[near] - loads[0])), np.log(np.abs(links[near]))
    assert np.polyfit(away[1], away[0], 1)[0] == pytest.approx(2 / 3, abs=0.02)
    right, left = ((links * way > 0) & near for way in (1, -1))
    order = np.argsort(np.abs(links[left]))
    there = np.interp(np.abs(links[right]), np.abs(links[left])[order], loads[left][order])
    np.testing.assert_allclose(there - loads[0], loads[right] - loads[0], rtol=0.2)
