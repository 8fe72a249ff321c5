"""Exact planar films: the equations they solve, their energies, limits and regimes."""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from math import isclose, pi

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError
from eulerplateau.exact.planar import LOBES, Regime, planar_film, thresholds
from eulerplateau.exact.planar.elastica import Elastica
from tests.helpers.marks import quick_with
from tests.helpers.planar_films import fits, inside, integral

# Paper, tab:contact.
TABLE = {
    2: (2603.0, 5127.7),
    3: (10740.6, 40584.9),
    4: (25719.8, 102795.4),
    5: (48535.5, 203145.1),
    6: (79910.4, 349245.2),
}
EXTREMES = (1e-9, 1e-6, 1e-3)


def between(low: float, high: float) -> tuple[float, ...]:
    return tuple(low + part * (high - low) for part in (0.1, 0.5, 0.9))


def loads(n: int) -> tuple[float, ...]:
    """Return loads in every regime, the ends of the promised range among them."""
    limits = thresholds(n)
    start, contact, line = (
        limits.sigma_buckling,
        limits.sigma_contact,
        limits.sigma_line_contact,
    )
    return (
        0.5 * start,
        *(start * (1 + excess) for excess in EXTREMES),
        *between(start, contact),
        *between(contact, line),
        2 * line,
        1e8,
    )


# One film for all that is asked of it.
film_at = cache(planar_film)
CASES = [(n, load, None) for n in (2, 3, 4, 8, 12) for load in loads(n)]
# Free, in point contact and in line contact.
THICK = [(2, 2000.0, 0.05), (2, 3000.0, 0.05), (2, 6000.0, 0.05), (2, 1e5, 0.002)]
THICK += [(3, 20000.0, 0.02), (3, 5e4, 0.02), (8, 3e5, 0.008), (8, 1.2e6, 0.004)]
every_film = pytest.mark.parametrize(("n", "load", "diameter"), CASES + THICK)


@every_film
def test_curvature_solves_the_shape_equation_off_the_contact(
    n: int, load: float, diameter: float | None
) -> None:
    film = film_at(n, load, diameter)
    for kappa in fits(film, film.curvature):
        low, high = kappa.domain
        if film.contact_length and isclose(high - low, film.contact_length):
            continue
        t = inside(kappa)
        terms = [2 * kappa.deriv(2)(t), kappa(t) ** 3, -film.beta_hat * kappa(t), -load]
        size = max(np.abs(term).max() for term in terms)
        assert np.abs(sum(terms)).max() <= 1e-9 * size


@every_film
def test_angle_and_positions_are_those_of_the_curvature(
    n: int, load: float, diameter: float | None
) -> None:
    film = film_at(n, load, diameter)
    steepest = max(film.kappa_max, -film.kappa_min)
    along = zip(
        fits(film, film.curvature),
        fits(film, film.tangent_angle),
        fits(film, lambda t: film.positions(t)[:, 0]),
        fits(film, lambda t: film.positions(t)[:, 1]),
        strict=True,
    )
    for kappa, angle, x, y in along:
        t = inside(kappa)
        np.testing.assert_allclose(angle.deriv()(t), kappa(t), atol=1e-11 * steepest)
        np.testing.assert_allclose(x.deriv()(t), np.cos(angle(t)), atol=1e-11)
        np.testing.assert_allclose(y.deriv()(t), np.sin(angle(t)), atol=1e-11)


@every_film
def test_loop_is_closed_without_gaps_and_turns_once(
    n: int, load: float, diameter: float | None
) -> None:
    film = film_at(n, load, diameter)
    np.testing.assert_allclose(film.positions(1.0), film.positions(0.0), atol=1e-14)
    assert film.half_lobe.ends[-1] == pytest.approx(1 / (2 * n), rel=1e-14)
    assert float(film.tangent_angle(1.0) - film.tangent_angle(0.0)) == pytest.approx(2 * pi)
    seams = np.unique([(k / n) + end for k in range(n) for end in film.half_lobe.ends])
    gap = 1e-9
    before, after = film.points(seams - gap), film.points(seams + gap)
    steps = np.linalg.norm(after.x - before.x, axis=1)
    np.testing.assert_allclose(steps, 2 * gap, atol=1e-13)
    turns = np.abs(after.angle - before.angle)
    assert turns.max() <= 2.01 * gap * max(film.kappa_max, -film.kappa_min) + 1e-12


@every_film
def test_half_lobe_keeps_to_its_sector_so_no_two_parts_cross(
    n: int, load: float, diameter: float | None
) -> None:
    film = film_at(n, load, diameter)
    x, y = film.positions(np.linspace(0, 1 / (2 * n), 2001)).T
    assert y.min() >= -1e-14
    assert (x * np.sin(pi / n) - y * np.cos(pi / n)).min() >= -1e-14


@every_film
def test_film_has_n_fold_and_mirror_symmetry(
    n: int, load: float, diameter: float | None
) -> None:
    film = film_at(n, load, diameter)
    t = np.linspace(-0.5, 0.5, 101) / n
    x, y = film.positions(t).T
    c, s = np.cos(2 * pi / n), np.sin(2 * pi / n)
    turned = np.stack([c * x - s * y, s * x + c * y], -1)
    np.testing.assert_allclose(film.positions(t + 1 / n), turned, atol=1e-13)
    mirrored = np.stack([x, -y], -1)[::-1]
    np.testing.assert_allclose(film.positions(t), mirrored, atol=1e-13)


@every_film
def test_energy_area_and_extremes_are_those_of_the_curve(
    n: int, load: float, diameter: float | None
) -> None:
    film = film_at(n, load, diameter)

    def sector(t: FloatArray) -> FloatArray:
        points = film.points(t)
        x, y = points.x.T
        return (x * np.sin(points.angle) - y * np.cos(points.angle)) / 2

    area = integral(film, sector)
    bending = integral(film, lambda t: film.curvature(t) ** 2)
    assert film.area == pytest.approx(area, rel=1e-11, abs=1e-15)
    assert film.energy == pytest.approx(load * film.area + bending, rel=1e-12)
    kappa = film.curvature(np.linspace(0, 1 / (2 * n), 20001))
    assert film.kappa_max == pytest.approx(kappa.max(), rel=1e-13)
    assert film.kappa_min == pytest.approx(kappa.min(), abs=1e-7 * film.kappa_max)


@pytest.mark.parametrize("n", quick_with([2, 3, 4, 7, 12], LOBES))
def test_energy_grows_with_the_load_by_the_area_in_every_regime(n: int) -> None:
    for load in loads(n)[3:]:
        h = 2e-4 * load
        energy = {k: planar_film(n, load + k * h).energy for k in (-2, -1, 1, 2)}
        slope = (8 * (energy[1] - energy[-1]) - (energy[2] - energy[-2])) / (12 * h)
        assert slope == pytest.approx(planar_film(n, load).area, rel=2e-10)


@pytest.mark.parametrize("n", LOBES)
def test_energy_and_area_are_continuous_where_the_regime_changes(n: int) -> None:
    limits = thresholds(n)
    regimes = list(Regime)
    changes = (limits.sigma_buckling, limits.sigma_contact, limits.sigma_line_contact)
    for number, load in enumerate(changes):
        below, above = (
            planar_film(n, load * (1 - 1e-11)),
            planar_film(n, load * (1 + 1e-11)),
        )
        assert (below.regime, above.regime) == (regimes[number], regimes[number + 1])
        assert above.energy == pytest.approx(below.energy, rel=1e-10)
        assert above.area == pytest.approx(below.area, rel=1e-9)
        assert above.kappa_max == pytest.approx(below.kappa_max, rel=1e-4)


@pytest.mark.parametrize("n", [2, 3, 7, 12])
def test_energy_rises_and_area_shrinks_with_the_load_and_both_stay_below_the_disk(
    n: int,
) -> None:
    start = thresholds(n).sigma_buckling
    films = [planar_film(n, load) for load in start * np.geomspace(1.0001, 3000, 24)]
    assert all(a.energy < b.energy and a.area > b.area for a, b in pairwise(films))
    assert all(f.energy < f.tension / (4 * pi) + 4 * pi**2 for f in films)


@pytest.mark.parametrize("n", LOBES)
def test_polar_parametrisation_of_films_without_contact(n: int) -> None:
    limits = thresholds(n)
    for load in between(limits.sigma_buckling, limits.sigma_contact):
        film = planar_film(n, load)
        top, beta = film.kappa_max, film.beta_hat
        constant = top**4 / 4 - beta * top**2 / 2 - load * top
        points = film.points(np.linspace(0, 1, 301))
        radius2 = (4 * constant + beta**2) / load**2 + 4 * points.kappa / load
        np.testing.assert_allclose((points.x**2).sum(axis=1), radius2, atol=1e-14)


@pytest.mark.parametrize("n", LOBES)
def test_amplitude_grows_as_the_root_of_the_excess_with_the_derived_coefficient(
    n: int,
) -> None:
    excess = np.array([1e-3, 1e-4, 1e-5, 1e-6])
    errors = []
    for above in excess:
        film = planar_film(n, thresholds(n).sigma_buckling * (1 + above))
        amplitude = (film.kappa_max - film.kappa_min) / (film.kappa_max + film.kappa_min)
        # docs/planar.md: sigma / sigma_b - 1 = 3 amplitude^2 / (8 n^2) + O(amplitude^4).
        errors.append(abs(3 * amplitude**2 / (8 * n**2 * above) - 1))
    order = np.polyfit(np.log(excess), np.log(errors), 1)[0]
    assert order == pytest.approx(1, abs=0.02)
    film = planar_film(n, thresholds(n).sigma_buckling * (1 + 1e-9))
    amplitude = (film.kappa_max - film.kappa_min) / (4 * pi)
    assert amplitude == pytest.approx(n * np.sqrt(8e-9 / 3), rel=1e-6)


@pytest.mark.parametrize("n", TABLE)
def test_contact_thresholds_are_the_papers_to_its_accuracy(n: int) -> None:
    limits = thresholds(n)
    assert limits.sigma_buckling == pytest.approx(16 * pi**3 * (n**2 - 1), rel=1e-15)
    found = (limits.sigma_contact, limits.sigma_line_contact)
    assert found == pytest.approx(TABLE[n], abs=0.25)


def test_two_lobes_first_touch_with_the_circles_curvature_and_beta_of_opposite_sign() -> (
    None
):
    film = planar_film(2, thresholds(2).sigma_contact)
    assert film.kappa_min == pytest.approx(-2 * pi, rel=1e-13)
    assert film.beta_hat == pytest.approx(4 * pi**2, rel=1e-13)
    # The paper's kappa_0 at the onset of line contact.
    tip = planar_film(2, thresholds(2).sigma_line_contact).kappa_max
    assert tip == pytest.approx(28.8164, abs=1e-4)


@pytest.mark.parametrize("n", LOBES)
def test_line_contact_is_the_onset_made_smaller_and_collapses_to_a_star(n: int) -> None:
    onset = planar_film(n, thresholds(n).sigma_line_contact)
    for load in (3 * onset.tension, 1e8, 1e12):
        film, size = planar_film(n, load), (onset.tension / load) ** (1 / 3)
        assert film.energy == pytest.approx(onset.energy / size, rel=1e-12)
        assert film.area == pytest.approx(onset.area * size**2, rel=1e-12)
        assert film.kappa_max == pytest.approx(onset.kappa_max / size, rel=1e-12)
        assert film.contact_length == pytest.approx((1 - size) / (2 * n), rel=1e-12)
        assert abs(float(film.positions(0.0)[0]) - 1 / (2 * n)) <= 0.6 * size / (2 * n)
        middle = film.half_lobe.ends[1] + film.contact_length / 2
        assert film.curvature(middle) == 0
        assert film.positions(middle)[1] == pytest.approx(0, abs=1e-15)


@pytest.mark.parametrize("n", [0, 1, 13, -2, 2.5, True, "3", None])
def test_impossible_numbers_of_lobes_are_refused(n: int) -> None:
    with pytest.raises(SpecError) as error:
        planar_film(n, 1000.0)
    assert error.value.key == "lobes"


@pytest.mark.parametrize("load", [-1.0, float("nan"), float("inf")])
def test_impossible_loads_are_refused(load: float) -> None:
    with pytest.raises(SpecError) as error:
        planar_film(2, load)
    assert error.value.key == "tension"


@pytest.mark.parametrize("lobes", [2, 3, 12])
def test_a_film_in_line_contact_is_one_shape_of_every_size(lobes):
    """Its energy grows as the cube root of the tension, at tensions of any size."""
    first = planar_film(lobes, 1e10)
    for tension in (1e15, 1e100, 1e250, 1e300, 1e307):
        film = planar_film(lobes, tension)
        growth = (tension / 1e10) ** (1 / 3)
        assert film.energy == pytest.approx(first.energy * growth, rel=1e-12)
        assert film.area == pytest.approx(film.energy / (3 * tension), rel=1e-14)


@pytest.mark.parametrize("amplitude", [1e-3, 1e-6, 1e-9, 1e-12])
def test_modulus_of_a_small_wave_keeps_its_digits(amplitude: float) -> None:
    """m = a^2 I / (4 mean^2 + I)^2 to leading order in the amplitude a, I = imaginary2."""
    wave = Elastica(mean=1.3, amplitude=amplitude, imaginary2=0.7)
    leading = amplitude**2 * 0.7 / (4 * 1.3**2 + 0.7) ** 2
    assert wave.m == pytest.approx(leading, rel=10 * amplitude**2 + 1e-14, abs=0.0)
