"""Planar films of a loop with a diameter: forces, limits, thresholds, what is refused."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import inf, pi

import numpy as np
import pytest
from scipy.spatial.distance import cdist

from eulerplateau.errors import SpecError
from eulerplateau.exact.planar import (
    LOBES,
    PlanarFilm,
    Regime,
    TooThickError,
    planar_film,
    thresholds,
)
from tests.helpers.marks import quick_with
from tests.helpers.planar_films import fits
from tests.helpers.planar_polygons import HalfLobe, relax_polygon

film_at = cache(planar_film)
FREE = [(2, 1800.0, 0.05), (3, 7000.0, 0.03), (12, 2e5, 0.01)]
POINT = [(2, 2300.0, 0.05), (2, 4000.0, 0.05), (3, 2e4, 0.02), (8, 3e5, 0.008)]
LINE = [(2, 6000.0, 0.05), (2, 1e5, 0.002), (3, 5e4, 0.02), (8, 1.2e6, 0.004)]
in_contact = pytest.mark.parametrize(("n", "load", "diameter"), POINT + LINE)


def slope(energy: Callable[[float], float], at: float) -> float:
    """Return a derivative by differences of fourth order."""
    h = 1e-3 * at
    ends = 8 * (energy(at + h) - energy(at - h))
    return (ends - energy(at + 2 * h) + energy(at - 2 * h)) / (12 * h)


def shear_jumps(film: PlanarFilm) -> float:
    """Return the sum of the point forces that the curve shows, n times those on a strand.

    They are the jumps of 2 kappa' at the contact's ends, or at the middle of two lobes.
    """
    pieces = fits(film, film.curvature)
    last = pieces[0].domain[1]
    jump = 2 * float(pieces[0].deriv()(last))
    if film.lobes > 2:
        first = pieces[-1].domain[0]
        jump -= 2 * float(pieces[-1].deriv()(first))
    return film.lobes * jump


def nearest(film: PlanarFilm) -> float:
    """Return the least distance of two points of the loop, one of them on the first lobe.

    Left out are those nearer along the loop than half a circle of diameter d is long.
    """
    t = np.arange(240 * film.lobes) / (240 * film.lobes)
    x = film.positions(t)
    apart = np.abs(t[:240, None] - t)
    near = np.minimum(apart, 1 - apart) <= pi * film.diameter / 2
    return float(np.where(near, inf, cdist(x[:240], x)).min())


@in_contact
def test_contact_force_is_the_energys_slope_in_the_diameter(
    n: int, load: float, diameter: float
) -> None:
    film = film_at(n, load, diameter)
    found = slope(lambda d: film_at(n, load, d).energy, diameter)
    assert film.contact_force > 0
    assert film.contact_force == pytest.approx(found, rel=1e-8)


@pytest.mark.parametrize(("n", "load", "diameter"), FREE + POINT + LINE)
def test_area_is_the_energys_slope_in_the_load(
    n: int, load: float, diameter: float
) -> None:
    film = film_at(n, load, diameter)
    found = slope(lambda sigma: film_at(n, sigma, diameter).energy, load)
    assert film.area == pytest.approx(found, rel=1e-9)


@pytest.mark.parametrize(("n", "load", "diameter"), FREE)
def test_a_loop_that_does_not_touch_itself_is_the_one_without_thickness(
    n: int, load: float, diameter: float
) -> None:
    film, thin = film_at(n, load, diameter), film_at(n, load)
    assert film.regime.contact == "free"
    assert (film.energy, film.area) == (thin.energy, thin.area)
    assert (film.contact_force, film.contact_length) == (0, 0)


@in_contact
def test_forces_on_half_a_lobe_balance(n: int, load: float, diameter: float) -> None:
    """(beta - kappa^2) t pulls at the ends, the film along it, the contact upward."""
    film = film_at(n, load, diameter)
    ends = film.points(np.array([0.0, 1 / (2 * n)]))
    tangent = np.stack([np.cos(ends.angle), np.sin(ends.angle)], -1)
    pull = (film.beta_hat - ends.kappa**2)[:, None] * tangent
    along = load * (ends.x[1] - ends.x[0])
    total = pull[1] - pull[0] + [-along[1], along[0] + film.contact_force / n]
    assert np.abs(total).max() <= 1e-11 * np.abs(pull).max()


@in_contact
def test_force_is_pressure_along_a_line_and_positive_jumps_of_the_shear_force(
    n: int, load: float, diameter: float
) -> None:
    film = film_at(n, load, diameter)
    jumps = shear_jumps(film)
    assert jumps > 0
    # On a straight strand, which the film pulls at with sigma, nothing else holds it.
    pressure = load * film.contact_length * n
    assert film.contact_force == pytest.approx(jumps + pressure, rel=1e-9)


@pytest.mark.parametrize(("n", "load", "diameter"), LINE)
def test_a_line_of_contact_is_straight_and_ends_without_a_jump_of_curvature(
    n: int, load: float, diameter: float
) -> None:
    film = film_at(n, load, diameter)
    assert film.regime is Regime.LINE_CONTACT
    assert film.beta_hat == pytest.approx(-load * diameter / 2, rel=1e-14)
    line = np.linspace(*film.half_lobe.ends[1:3], 9)
    np.testing.assert_allclose(film.positions(line)[:, 1], diameter / 2, rtol=1e-12)
    assert not film.curvature(line[1:-1]).any()
    for piece in fits(film, film.curvature):
        for end in set(piece.domain) & {line[0], line[-1]}:
            assert float(piece(end)) == pytest.approx(0, abs=1e-11 * film.kappa_max)


@pytest.mark.parametrize(
    ("n", "diameter"),
    quick_with(
        [(2, 0.09), (2, 0.05), (2, 1e-4), (3, 0.03)],
        [(2, 0.09), (2, 0.05), (2, 1e-4), (3, 0.03), (7, 0.01), (12, 0.004)],
    ),
)
def test_force_and_line_grow_from_zero_where_the_regime_changes(
    n: int, diameter: float
) -> None:
    limits = thresholds(n, diameter)
    onset, opening = limits.sigma_contact, limits.sigma_line_contact
    closed, near, far = (film_at(n, onset * (1 + e), diameter) for e in (-1e-9, 1e-7, 1e-6))
    assert (closed.regime.contact, near.regime.contact) == ("free", "point")
    assert near.energy == pytest.approx(closed.energy, rel=1e-6)
    assert near.area == pytest.approx(closed.area, rel=1e-6)
    assert far.contact_force / near.contact_force == pytest.approx(10, rel=1e-3)
    point, first, line = (
        film_at(n, opening * (1 + e), diameter) for e in (-1e-9, 1e-7, 1e-6)
    )
    assert (point.regime.contact, first.regime.contact) == ("point", "line")
    assert line.contact_length / first.contact_length == pytest.approx(10, rel=1e-3)
    for name in ("energy", "area", "contact_force", "kappa_max", "beta_hat"):
        assert getattr(first, name) == pytest.approx(getattr(point, name), rel=1e-6)


@pytest.mark.parametrize("n", quick_with([2, 3, 4, 5, 12], LOBES))
def test_without_thickness_the_thresholds_are_the_limit_of_those_with(n: int) -> None:
    thin, thick = thresholds(n), thresholds(n, 1e-13)
    assert thick.sigma_contact == pytest.approx(thin.sigma_contact, rel=1e-10)
    assert thick.sigma_line_contact == pytest.approx(thin.sigma_line_contact, rel=1e-10)


@pytest.mark.parametrize(("n", "load"), [(2, 4e3), (2, 2e4), (3, 2e4), (5, 3e5)])
def test_energy_near_no_thickness_is_linear_with_the_thin_films_force(
    n: int, load: float
) -> None:
    thin, diameters = film_at(n, load), np.array([4e-4, 2e-4, 1e-4])
    errors = [film_at(n, load, d).energy - thin.energy for d in diameters]
    errors -= thin.contact_force * diameters
    order = np.polyfit(np.log(diameters), np.log(np.abs(errors)), 1)[0]
    assert order == pytest.approx(2, abs=0.02)


@pytest.mark.parametrize(
    ("n", "load", "diameter"), [*FREE, *POINT, *LINE, (12, 1e6, 0.005), (2, 1700.0, 0.1)]
)
def test_no_two_strands_are_nearer_than_the_diameter(
    n: int, load: float, diameter: float
) -> None:
    assert nearest(film_at(n, load, diameter)) >= diameter * (1 - 1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("n", LOBES)
def test_no_two_strands_are_nearer_than_the_diameter_up_to_the_thickest_loops(
    n: int,
) -> None:
    limits = thresholds(n)
    loads = np.geomspace(limits.sigma_buckling, 8 * limits.sigma_line_contact, 15)
    seen = set()
    for diameter in (0.1, 0.05, 0.02, 0.015, 0.01, 0.003):
        for load in loads:
            try:
                film = planar_film(n, load, diameter)
            except TooThickError:
                continue
            seen.add(film.regime.contact)
            assert nearest(film) >= diameter * (1 - 1e-12)
    assert seen == {"free", "point", "line"}


@pytest.mark.parametrize(
    ("n", "load", "diameter"),
    quick_with(
        [(2, 3000.0, 0.05)],
        [(2, 1800.0, 0.05), (2, 3000.0, 0.05), (2, 8000.0, 0.02), (3, 6e4, 0.015)],
    ),
)
def test_polygons_of_least_energy_that_may_not_overlap_converge_to_the_films(
    n: int, load: float, diameter: float
) -> None:
    film = film_at(n, load, diameter)
    coarse, fine = (relax_polygon(HalfLobe(n, load, diameter, edges)) for edges in (25, 50))
    errors = [polygon.energy - film.energy for polygon in (coarse, fine)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.02)
    for polygon, edge in ((coarse, 1 / (50 * n)), (fine, 1 / (100 * n))):
        assert polygon.misfit <= 1e-6 * load
        assert (polygon.forces >= 0).all()
        # As the vertices are spaced, so exactly can the contact's end be known.
        in_touch = len(polygon.forces) * edge
        reach = 2 if film.regime.contact != "free" else 0
        assert 0 <= in_touch - film.contact_length <= reach * edge
    force = (4 * fine.forces.sum() - coarse.forces.sum()) / 3
    assert force == pytest.approx(film.contact_force, rel=2e-4)


@pytest.mark.parametrize("diameter", [0.0, -0.01, 0.1000001, inf, float("nan"), "thick"])
def test_impossible_diameters_are_refused(diameter: float) -> None:
    for ask in (lambda: planar_film(2, 2000.0, diameter), lambda: thresholds(2, diameter)):
        with pytest.raises(
            SpecError, match=r"^diameter: found .*; should be above 0 and at"
        ):
            ask()


@pytest.mark.parametrize(
    ("n", "load", "contact"),
    [
        (2, 1e5, "line"),
        (8, 4e4, "free"),
        pytest.param(3, 6000.0, "free", marks=pytest.mark.slow),
        pytest.param(3, 1e4, "point", marks=pytest.mark.slow),
        pytest.param(8, 4e5, "point", marks=pytest.mark.slow),
        (12, 4e6, "line"),
    ],
)
def test_a_loop_is_too_thick_beyond_the_diameter_at_which_it_bends_to_two_over_d(
    n: int, load: float, contact: str
) -> None:
    low, high = 1e-3, 0.1
    while high / low - 1 > 1e-4:
        diameter = (low * high) ** 0.5
        try:
            film = planar_film(n, load, diameter)
        except TooThickError:
            high = diameter
        else:
            low = diameter
    with pytest.raises(TooThickError, match=r"^too_thick: .* 2/d = "):
        planar_film(n, load, high)
    assert film.regime.contact == contact
    assert max(film.kappa_max, -film.kappa_min) * low == pytest.approx(2, rel=2e-4)


@pytest.mark.parametrize(
    ("n", "diameter"),
    quick_with([(2, 0.09), (3, 0.06)], [(2, 0.09), (3, 0.06), (8, 0.018)]),
)
def test_contacts_begin_at_a_threshold_or_are_not_there_at_all(
    n: int, diameter: float
) -> None:
    limits, seen = thresholds(n, diameter), set()
    for load in np.geomspace(limits.sigma_buckling, 30 * limits.sigma_buckling, 12):
        try:
            seen.add(planar_film(n, load, diameter).regime.contact)
        except TooThickError:
            continue
    onsets = {"point": limits.sigma_contact, "line": limits.sigma_line_contact}
    assert seen == {"free", *(name for name, load in onsets.items() if load < inf)}


@pytest.mark.parametrize("n", quick_with([2, 3], [2, 3, 7, 12]))
def test_thresholds_fall_with_the_diameter_until_the_loop_is_too_thick(n: int) -> None:
    rows = [thresholds(n, d) for d in (1e-3, 3e-3, 0.01, 0.03, 0.1)]
    for name in ("sigma_contact", "sigma_line_contact"):
        loads = np.array([getattr(row, name) for row in rows])
        there = np.isfinite(loads)
        assert (np.diff(there.astype(int)) <= 0).all()
        assert (np.diff(loads[there]) < 0).all()
        for row, load in zip(rows, loads, strict=True):
            assert row.sigma_buckling < load
