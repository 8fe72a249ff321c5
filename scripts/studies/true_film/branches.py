"""The true film's branches: two lobes, twisted films, saddles."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from eulerplateau.exact.conformal import (
    PLANAR,
    TWISTED,
    BranchPoint,
    ConformalFilm,
    Mode,
    change_basis,
    disk,
    edge,
    first_lobes,
    go_to_load,
    locate,
    make_basis,
    modes,
    morse_index,
    resolve,
    switch,
    waist,
)
from eulerplateau.exact.conformal.families import ABOUT_Z

# Films are refined until the last tenth of their harmonics is this small.
TAIL = 1e-10
PLANAR_BUCKLING, SADDLE = 48 * pi**3, 96 * pi**3
PLANAR_LOADS = (1500.0, 1600.0, 1700.0, 1800.0, 1900.0, 2000.0, 2100.0)
TWISTED_LOADS = (1850.0, *np.arange(1800.0, 690.0, -50.0).tolist())
SADDLE_LOADS = (2980.0, 3000.0, *np.arange(3200.0, 7001.0, 200.0).tolist())


@dataclass(frozen=True)
class Row:
    """One film of a branch; `index` is Morse's, `balance` max |F' + sigma T| / sigma."""

    branch: str
    sigma_hat: float
    energy: float
    area: float
    waist: float
    abs_kappa_n: float
    gauss: float
    index: int
    lowest: float
    lowest_other: float
    balance: float
    tail: float
    harmonics: int
    crowding: float


def planar_start(harmonics: int, crowding: float) -> BranchPoint:
    """Return the planar two-lobed film at 1600, from the disk's bifurcation at 48 pi^3."""
    film = first_lobes(make_basis(harmonics, PLANAR, 0.1))
    finer = change_basis(film, harmonics, crowding)
    if finer is None:
        raise ArithmeticError(f"{harmonics} harmonics do not resolve the film at 1600")
    return finer


def planar_branch() -> tuple[list[ConformalFilm], ConformalFilm, Mode]:
    """Return planar films, and the one that loses stability, with its mode."""
    point, films = planar_start(64, 0.1), []
    backwards = point.reversed()
    films.append(go_to_load(backwards, PLANAR_LOADS[0]).film)
    onset = None
    for load in PLANAR_LOADS[1:]:
        before, point = point, resolve(go_to_load(point, load), TAIL)
        films.append(point.film)
        if before.load < 1850 < point.load:
            near = resolve(go_to_load(before, 1845.0), TAIL)
            onset = locate(near, go_to_load(near, 1865.0), TWISTED)
    if onset is None:
        raise ArithmeticError("the planar film stays stable")
    return films, *onset


def twisted_branch(film: ConformalFilm, mode: Mode) -> list[ConformalFilm]:
    """Return the films that leave the plane, down to the narrowest waist resolved."""
    point, films = switch(film, mode, 0.01), []
    for load in TWISTED_LOADS:
        point = resolve(go_to_load(point, load, 0.03), TAIL)
        films.append(point.film)
    return films


def saddle_branch() -> list[ConformalFilm]:
    """Return the saddles that leave the disk at 96 pi^3."""
    point, films = saddle_start(0.02), []
    for load in SADDLE_LOADS:
        if load > point.load:
            point = resolve(go_to_load(point, load), TAIL)
            films.append(point.film)
    return films


def saddle_start(amplitude: float) -> BranchPoint:
    """Return the saddle at a distance from the disk at 96 pi^3."""
    round_film = disk(make_basis(64, TWISTED), SADDLE)
    mode = min(modes(round_film, TWISTED), key=lambda m: abs(m.eigenvalue))
    return switch(round_film, mode, amplitude)


def row_of(branch: str, film: ConformalFilm) -> Row:
    """Return what is recorded of a film; `lowest_other` is of modes not on its branch."""
    frame = edge(film)
    others = [m.eigenvalue for m in modes(film, ABOUT_Z) if m.transverse > 0.01]
    return Row(
        branch=branch,
        sigma_hat=film.load,
        energy=film.energy,
        area=film.area,
        waist=waist(film),
        abs_kappa_n=frame.abs_kappa_n,
        gauss=frame.total_gauss_curvature,
        index=morse_index(film),
        lowest=modes(film, TWISTED)[0].eigenvalue,
        lowest_other=min(others),
        balance=frame.force_balance(film.load, film.beta),
        tail=film.tail,
        harmonics=film.basis.harmonics,
        crowding=film.basis.crowding,
    )
