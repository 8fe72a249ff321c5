"""The pinched flat eight, and the twisted films that lead to it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from eulerplateau.errors import SpecError
from eulerplateau.exact.conformal.branch import go_to_load, resolve
from eulerplateau.exact.conformal.eight import flat_eight
from eulerplateau.exact.conformal.eight_modes import planar_modes, transverse_modes
from eulerplateau.exact.conformal.geometry import waist
from eulerplateau.exact.conformal.held_waist import HeldFilm, hold, sharpen_grid
from eulerplateau.exact.planar import planar_film, thresholds
from tests.helpers.conformal_films import onset, twisted


def test_without_a_film_it_is_eulers_eight() -> None:
    # kappa = 2 k lambda cn(lambda s), lambda = 4 K, and 2 E = K closes the loop.
    m = brentq(lambda m: 2 * ellipe(m) - ellipk(m), 0.5, 0.99, xtol=1e-15)
    assert flat_eight(0.0).energy == pytest.approx(
        64 * ellipk(m) ** 2 * (m - 0.5), rel=1e-11
    )


def test_energy_grows_with_the_load_by_the_area() -> None:
    for load in (300.0, 1700.0, 4000.0):
        h = 5.0
        energy = {k: flat_eight(load + k * h).energy for k in (-2, -1, 1, 2)}
        slope = (8 * (energy[1] - energy[-1]) - (energy[2] - energy[-2])) / (12 * h)
        assert slope == pytest.approx(flat_eight(load).area, rel=1e-9)


def test_multiplier_follows_from_scaling() -> None:
    # E = beta + 3 sigma A, from the derivative of the energy by the loop's length.
    for load in (0.0, 1000.0, 3000.0):
        eight = flat_eight(load)
        assert eight.energy == pytest.approx(eight.beta + 3 * load * eight.area, rel=1e-11)


def test_crossing_closes_where_two_lobes_begin_to_touch_along_a_line() -> None:
    limit = thresholds(2).sigma_line_contact
    loads = limit * (1 - np.array([1e-3, 1e-4, 1e-5]))
    angles = [-flat_eight(float(load)).angle for load in loads]
    assert np.polyfit(np.log(limit - loads), np.log(angles), 1)[0] == pytest.approx(
        1, abs=0.01
    )
    gap = planar_film(2, limit).energy - flat_eight(float(loads[-1])).energy
    assert gap == pytest.approx(planar_film(2, limit).area * (limit - loads[-1]), rel=1e-2)


@pytest.mark.parametrize("load", [0.0, 1000.0, 3000.0, 5000.0])
def test_it_is_stable_in_its_plane_and_across(load: float) -> None:
    eight = flat_eight(load)
    in_plane = planar_modes(eight)
    # Two translations and a rotation cost nothing.
    assert np.abs(in_plane[:3]).max() < 1e-3 * in_plane[3]
    for centre in (1, -1):
        for mirror in (1, -1):
            across = transverse_modes(eight, centre, mirror)
            rigid = 0 if (centre, mirror) == (1, -1) else 1
            assert np.abs(across[:rigid]).sum() < 1e-5 * across[rigid]
            assert across[rigid] > 0


@pytest.mark.parametrize("load", [-1.0, float("nan"), 5128.0])
def test_impossible_loads_are_refused(load: float) -> None:
    with pytest.raises(SpecError) as error:
        flat_eight(load)
    assert error.value.key == "load"


def test_barrier_on_the_way_to_it_becomes_a_helicoids() -> None:
    # Strands at a distance w and an angle omega: sigma w^2 / (2 omega) at the top.
    point, widths, gaps = twisted(1400.0), [], []
    for load in (1200.0, 1100.0, 1000.0):
        point = resolve(go_to_load(point, load, 0.03), 1e-9)
        eight, width = flat_eight(load), waist(point.film)
        helicoid = load * width**2 / (-4 * eight.angle)
        widths.append(width)
        gaps.append(1 - (point.film.energy - eight.energy) / helicoid)
    assert all(gap > 0 for gap in gaps)
    assert np.polyfit(np.log(widths), np.log(gaps), 1)[0] > 1.5


def test_force_that_holds_a_waist_is_the_energys_slope_and_vanishes_in_equilibrium() -> (
    None
):
    film = twisted(1700.0).film
    free = waist(film)
    energies = {}
    for k in (-2, -1, 0, 1, 2):
        found = hold(
            film.basis, film.coefficients, film.beta, 0.0, film.load, free + 1e-3 * k
        )
        assert found is not None
        energies[k] = found
    assert abs(energies[0].force) < 1e-5
    assert energies[0].energy == pytest.approx(film.energy, rel=1e-12)
    for k in (-1, 1):
        slope = (energies[k + 1].energy - energies[k - 1].energy) / 2e-3
        assert slope == pytest.approx(energies[k].force, rel=0.02)
    # The equilibrium is the highest on the way: a barrier.
    assert max(f.energy for f in energies.values()) == energies[0].energy


def test_beyond_the_onset_the_energy_falls_all_the_way_as_the_waist_closes() -> None:
    load, start = onset()[0].load + 20, twisted(1650.0).film
    width = waist(start)
    middle = HeldFilm(start.basis, start.coefficients, start.beta, 0.0, 1650.0, width, 0.0)
    for step in np.linspace(1650.0, load, 12):
        middle = held(middle, float(step), width)
    energies = {width: middle.energy}
    for change in (0.0025, -0.0025):
        last = middle
        while 0.045 < last.width < 0.115:
            last = held(sharpen_grid(last), load, last.width + change)
            energies[last.width] = last.energy
            # The film pulls the strands together.
            assert last.force > 0
    rising = [energies[width] for width in sorted(energies)]
    assert (np.diff(rising) > 0).all()
    assert rising[0] > flat_eight(load).energy


def held(film: HeldFilm, load: float, width: float) -> HeldFilm:
    found = hold(film.basis, film.coefficients, film.beta, film.force, load, width)
    assert found is not None
    return found
