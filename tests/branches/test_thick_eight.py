"""The twisted eight of a loop with a diameter: forces by energies, stability, limits."""

from __future__ import annotations

import json
from functools import cache
from math import pi

import numpy as np
import pytest
from scipy.optimize import brentq

from eulerplateau.branches.conformal import TouchingFamily, contact_loads, thick_eight
from eulerplateau.branches.conformal.contact_eight import reached, touching
from eulerplateau.branches.conformal.touching import HeldApart, Touching, settled
from eulerplateau.errors import SpecError
from eulerplateau.exact.conformal import (
    GENERAL,
    TWISTED,
    crossing,
    flat_eight,
    go_to_load,
    make_basis,
    nearest_strands,
    waist,
)
from eulerplateau.solvers import stability, tangent_model
from tests.helpers.command import run_here
from tests.helpers.conformal_films import twisted

RNG_SEED = 3


@cache
def touching_at(diameter, load=1700.0, ratio=0.0, link=0.0):
    values = {"load": load, "twist_ratio": ratio, "link": link, "diameter": diameter}
    return touching(values)


def next_to(film, **changed):
    """Return the film at other values, in the same basis: Newton's method alone."""
    family = TouchingFamily(film.basis, {**film.values, **changed})
    found = settled(Touching(family, film.x, film.tensions, 0))
    assert found is not None
    return found


def slope(film, name, h, **fixed):
    """Return dE/dname by differences good to O(h^6)."""
    value = film.values[name]
    energy = {k: next_to(film, **{name: value + k * h}).energy for k in (-3, -2, -1, 1, 2, 3)}
    odd = [energy[k] - energy[-k] for k in (1, 2, 3)]
    return (45 * odd[0] - 9 * odd[1] + odd[2]) / (60 * h)


@pytest.mark.parametrize("rod", [(0.0, 0.0), (2 / 3, 1.0)])
def test_energy_changes_by_force_area_and_moment(rod):
    """dE/dd = F, dE/dsigma = A, dE/dLk = 2 pi M, contact or not."""
    film = touching_at(0.05, 1700.0, *rod)
    c = film.family.unknowns.loop(film.x).coefficients
    area = 0.5 * c @ film.basis.dirichlet @ c
    assert slope(film, "diameter", 2e-4) == pytest.approx(film.force, rel=1e-7)
    assert slope(film, "load", 5.0) == pytest.approx(area, rel=1e-7)
    if rod[0]:
        moment = film.family.twist(1700.0).moment(film.x)
        assert slope(film, "link", 5e-3) == pytest.approx(2 * pi * moment, rel=1e-7)


def test_distance_of_strands_has_the_derivatives_it_says():
    """Both arc lengths eliminated, for displacements of no symmetry: Taylor's slopes."""
    film = touching_at(0.05)
    basis = make_basis(12, GENERAL, film.basis.crowding)
    rng = np.random.default_rng(RNG_SEED)
    c = basis.transfer(film.basis, film.family.unknowns.loop(film.x).coefficients)
    c = c + 1e-3 * rng.standard_normal(basis.size) / basis.wavenumbers**3
    step = rng.standard_normal(basis.size) / basis.wavenumbers**3
    at = crossing(basis, c)
    first, second = at.slope @ step, step @ at.curvature @ step
    sizes, errors = np.array([4e-4, 2e-4, 1e-4]), []
    for h in sizes:
        change = crossing(basis, c + h * step).distance - at.distance
        errors.append(abs(change - h * first - 0.5 * h**2 * second))
    assert np.polyfit(np.log(sizes), np.log(errors), 1)[0] == pytest.approx(3, abs=0.1)
    # No other points are nearer: all pairs of a fine sample of both strands.
    phi = np.linspace(-0.5, 0.5, 2001)
    upper, lower = (basis.at(c, middle + phi).x for middle in (pi / 2, 3 * pi / 2))
    least = min(np.linalg.norm(lower - point, axis=1).min() for point in upper)
    assert at.distance <= least
    assert least == pytest.approx(at.distance, rel=1e-5)


def test_free_film_is_in_contact_without_force():
    """A twisted film is one whose waist is held at its own width."""
    free = twisted(1350.0).film
    film = reached(touching_at(0.05), {**touching_at(0.05).values, "load": 1350.0})
    film = next_to(film, diameter=waist(free))
    assert film.energy == pytest.approx(free.energy, rel=1e-10)
    assert abs(film.force) < 1e-4


def test_eight_opens_where_the_twisted_film_is_as_wide():
    def wider(load):
        return waist(go_to_load(twisted(1350.0), load).film) - 0.05

    opens = brentq(wider, 1345.0, 1375.0, xtol=1e-6)
    assert next_to(touching_at(0.05, 1360.0), load=opens).force == pytest.approx(0, abs=1e-4)
    assert thick_eight(opens - 1.0, 0.05).status == "opens"
    assert thick_eight(opens + 1.0, 0.05).status == "converged"


def test_rod_is_balanced_but_where_strands_touch():
    """F' = -sigma T along the loop, and the resultant jumps by the force where they touch.

    The film's pull, sigma T ds, is summed over a quarter: by symmetry about the axis of
    contact, y, half the jump is what the film pulls one strand with along y.
    """
    film = thick_eight(1700.0, 0.05)
    from eulerplateau.exact.conformal import edge

    frame = edge(film.film)
    n = len(frame.x)
    # All forces on one half of the loop, cut at the tips: there the resultant has a y part.
    pull = 1700.0 * (frame.conormal * frame.weights[:, None])
    print(pull[: n // 2].sum(axis=0), film.contact_force)
