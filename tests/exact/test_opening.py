"""The twisted film of given waist, where an eight in contact opens."""

from __future__ import annotations

from math import cbrt, log

import numpy as np
import pytest

from eulerplateau.errors import SpecError
from eulerplateau.exact.conformal import (
    TWISTED,
    flat_eight,
    morse_index,
    quick_opening_load,
    quick_opening_load_by_width,
    twisted_film,
    twisted_films,
    waist,
)
from tests.helpers.conformal_films import twisted


def test_twisted_film_is_the_one_that_leaves_the_flat_lobes() -> None:
    """Followed in the waist, or in the load from where the flat ones give way."""
    by_load = twisted(1700.0).film
    by_waist = twisted_film(waist(by_load))
    assert by_waist.load == pytest.approx(1700.0, rel=1e-8)
    assert by_waist.energy == pytest.approx(by_load.energy, rel=1e-10)
    assert by_waist.basis.family is TWISTED
    assert morse_index(by_waist) == 1


def test_energy_of_twisted_films_changes_by_their_area() -> None:
    """dE/dsigma = A along the branch, whatever it is followed in: from film to film."""
    films = list(twisted_films(0.08))
    loads, energies, areas = (
        np.array([getattr(film, name) for film in films])
        for name in ("load", "energy", "area")
    )
    # The trapezoidal rule errs by the third power of the step.
    change = 0.5 * (areas[1:] + areas[:-1]) * np.diff(loads)
    bent = np.abs(np.diff(areas) * np.diff(loads)).max() / 6
    assert np.abs(np.diff(energies) - change).max() < bent
    assert (np.diff(loads) < 0).all()


def test_thinner_lines_open_at_lower_loads() -> None:
    thickness = np.geomspace(5e-4, 0.1, 200)
    loads = np.array([quick_opening_load(d) for d in thickness])
    assert (np.diff(loads) > 0).all()
    assert quick_opening_load(0.1) == pytest.approx(twisted_film(0.1).load, abs=1e-4)
    for wrong in (4e-4, 0.11):
        with pytest.raises(SpecError, match="diameter"):
            quick_opening_load(wrong)


def test_a_line_opens_at_the_load_of_its_diameter_there() -> None:
    """In units of (alpha / sigma)^(1/3), as a line has it in loops of all lengths."""
    load = quick_opening_load_by_width(0.02)
    assert quick_opening_load(0.02 / cbrt(load)) == pytest.approx(load, rel=1e-9)
    for beyond in (0.0, 1e-3, 2.0):
        assert np.isnan(quick_opening_load_by_width(beyond))


@pytest.mark.slow
def test_load_that_is_known_at_once_is_that_of_the_film() -> None:
    rng = np.random.default_rng(5)
    for d in np.exp(rng.uniform(log(5e-4), log(0.1), 6)):
        assert quick_opening_load(d) == pytest.approx(twisted_film(d).load, abs=1e-4)


@pytest.mark.slow
def test_narrow_waists_cost_half_of_what_they_pull() -> None:
    """At the barrier of E8 + (sigma/omega) w^2 log(C/w) they cost sigma w^2 / 2 omega."""
    off = []
    for width in (0.01, 0.003, 0.001):
        film = twisted_film(width)
        flat = flat_eight(film.load)
        helicoid = film.load * width**2 / (-4 * flat.angle)
        off.append(abs((film.energy - flat.energy) / helicoid - 1))
    assert off[0] > off[1] > off[2]
    assert off[2] < 1e-3
