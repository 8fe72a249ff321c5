"""Branch points of the true film that several tests start from."""

from __future__ import annotations

from functools import cache
from math import pi

from eulerplateau.exact.conformal.basis import make_basis
from eulerplateau.exact.conformal.branch import (
    BranchPoint,
    change_basis,
    go_to_load,
    locate,
    resolve,
    switch,
)
from eulerplateau.exact.conformal.equilibrium import ConformalFilm, disk
from eulerplateau.exact.conformal.families import PLANAR, TWISTED
from eulerplateau.exact.conformal.lobes import first_lobes
from eulerplateau.exact.conformal.second_variation import Mode, modes

BUCKLING, SADDLE = 48 * pi**3, 96 * pi**3


@cache
def _planar_at_1600() -> BranchPoint:
    return first_lobes(make_basis(48, PLANAR, 0.1))


@cache
def planar(load: float, harmonics: int = 48, crowding: float = 0.02) -> BranchPoint:
    """Return the planar film with two lobes along x, above 1489."""
    point = change_basis(_planar_at_1600(), harmonics, crowding)
    assert point is not None
    return go_to_load(point if load > 1600 else point.reversed(), load)


@cache
def onset(harmonics: int = 48, crowding: float = 0.02) -> tuple[ConformalFilm, Mode]:
    """Return the planar film that loses stability to twist, and its mode."""
    before = planar(1850.0, harmonics, crowding)
    return locate(before, go_to_load(before, 1860.0), TWISTED)


@cache
def twisted(load: float) -> BranchPoint:
    """Return the twisted film, which exists below the onset, refined on the way."""
    above = load + 150
    point = switch(*onset(), 0.01) if above > 1850 else twisted(above)
    return resolve(go_to_load(point, load, 0.03), 1e-11)


@cache
def saddle(amplitude: float) -> BranchPoint:
    """Return the saddle that leaves the disk at 96 pi^3, at a distance from it."""
    round_film = disk(make_basis(32, TWISTED), SADDLE)
    mode = min(modes(round_film, TWISTED), key=lambda m: abs(m.eigenvalue))
    return switch(round_film, mode, amplitude)
