"""Energies of films whose waist is held."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eulerplateau.exact.conformal import (
    PLANAR,
    ConformalFilm,
    disk,
    go_to_load,
    make_basis,
    waist,
)
from eulerplateau.exact.conformal.held_waist import HeldFilm, hold, sharpen_grid
from scripts.studies.true_film.branches import PLANAR_BUCKLING, planar_start


@dataclass(frozen=True)
class Landscape:
    """Energies of films held at waists, twisted and planar ones, at one load."""

    load: float
    waists: list[float]
    energies: list[float]
    planar_waists: list[float]
    planar_energies: list[float]


def landscape(load: float, film: ConformalFilm) -> Landscape:
    """Return energies over the waist at a load, starting from a twisted film."""
    width = waist(film)
    held = HeldFilm(film.basis, film.coefficients, film.beta, 0.0, film.load, width, 0.0)
    for step in np.linspace(film.load, load, 12)[1:]:
        held = held_at(held, float(step), width)
    twisted = [held_at(held, load, width)]
    for change in (0.0025, -0.0025):
        twisted += swept(twisted[0], change, 0.03)
    twisted.sort(key=lambda film: film.width)
    flat = planar_at(load)
    free = HeldFilm(flat.basis, flat.coefficients, flat.beta, 0.0, load, waist(flat), 0.0)
    least = min(twisted[-1].width, 0.8 * free.width)
    planar = swept(held_at(free, load, free.width), -0.005, least)
    return Landscape(
        load,
        [f.width for f in twisted],
        [f.energy for f in twisted],
        [f.width for f in planar],
        [f.energy for f in planar],
    )


def planar_at(load: float) -> ConformalFilm:
    """Return the planar film, the disk below its threshold."""
    if load < PLANAR_BUCKLING:
        return disk(make_basis(64, PLANAR, 0.1), load)
    point = planar_start(64, 0.03)
    return go_to_load(point.reversed() if load < point.load else point, load).film


def held_at(last: HeldFilm, load: float, width: float) -> HeldFilm:
    """Return the held film next to another one."""
    found = hold(last.basis, last.coefficients, last.beta, last.force, load, width)
    if found is None:
        raise ArithmeticError(f"no held film at {load}, waist {width}")
    return found


def swept(film: HeldFilm, change: float, least: float) -> list[HeldFilm]:
    """Return the films after `film` while the waist changes, above `least`.

    Twisted films end where they become planar: Newton's method fails at the pitchfork.
    """
    found: list[HeldFilm] = []
    last: HeldFilm | None = film
    flat = film.basis.family == PLANAR
    while last is not None and last.width > least and (flat or out_of_plane(last)):
        found.append(last)
        last = sharpen_grid(last)
        width = last.width + change
        last = hold(last.basis, last.coefficients, last.beta, last.force, film.load, width)
    return found if flat else found[1:]


def out_of_plane(film: HeldFilm) -> bool:
    """Return whether the film is twisted at all."""
    return float(np.abs(film.basis.curve(film.coefficients).x[:, 2]).max()) > 1e-4
