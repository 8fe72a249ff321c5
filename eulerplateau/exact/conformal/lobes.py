"""Planar films of two lobes along x, as conformal films: from the disk's bifurcation."""

from __future__ import annotations

from functools import lru_cache
from math import copysign, pi

import numpy as np

from eulerplateau.errors import SpecError
from eulerplateau.exact.checks import finite
from eulerplateau.exact.conformal.basis import Basis, make_basis
from eulerplateau.exact.conformal.branch import (
    BranchError,
    BranchPoint,
    go_to_load,
    locate,
    resolve,
    switch,
)
from eulerplateau.exact.conformal.equilibrium import ConformalFilm, disk
from eulerplateau.exact.conformal.families import PLANAR, TWISTED
from eulerplateau.exact.conformal.second_variation import modes
from eulerplateau.exact.planar import thresholds

BUCKLING = 48 * pi**3
_HARMONICS, _CROWDING = 64, 0.05
_FIRST = 1600.0
# Part of the way to the lobes' contact that one stage is long: waists close like it.
_PARTS = 15
_SWITCHED = 0.02
_TAIL, _RESOLVED = 1e-11, 1e-8
# Loads of stable and of unstable lobes, close enough for one step of a branch.
_STABLE, _UNSTABLE = 1820.0, 1890.0


def two_lobes(load: float) -> ConformalFilm:
    """Return the planar film of two lobes at sigma_hat = load, refined to a tail of 1e-11.

    Raises SpecError unless the load lies between 48 pi^3, where the disk buckles, and
    2602.98, where the lobes touch; BranchError close to that.
    """
    touching = thresholds(2).sigma_contact
    if not BUCKLING < finite("load", load) < touching:
        problem = f"found {load:g}; lobes exist between {BUCKLING:.6g} and {touching:.6g}"
        raise SpecError("load", problem)
    point = _first()
    way = point if load > point.load else point.reversed()
    while way.load != load:
        room = (touching - way.load) / _PARTS
        target = way.load + float(np.clip(load - way.load, -room, room))
        way = resolve(go_to_load(way, target), _TAIL)
    if way.film.tail > _RESOLVED:
        problem = f"sigma_hat = {load:g} takes too many harmonics: waist too narrow"
        raise BranchError(problem, "unresolved")
    return way.film


@lru_cache(maxsize=1)
def lobes_twist() -> float:
    """Return the sigma_hat at which flat lobes give way to twist that costs nothing."""
    stable = resolve(go_to_load(_first(), _STABLE), _TAIL)
    film, _ = locate(stable, go_to_load(stable, _UNSTABLE), TWISTED)
    return film.load


@lru_cache(maxsize=1)
def _first() -> BranchPoint:
    """Return the film at the first load, refined."""
    return resolve(first_lobes(make_basis(_HARMONICS, PLANAR, _CROWDING)), _TAIL)


def first_lobes(basis: Basis) -> BranchPoint:
    """Return the film of two lobes at 1600 in a basis of PLANAR, from the disk."""
    flat = disk(basis, BUCKLING)
    lowest = modes(flat, PLANAR)[0]
    # The lobes lie along x: the tip at phi = 0 moves outwards.
    tip = lowest.basis.curve(lowest.coefficients).x[0, 0]
    leaving = switch(flat, lowest, copysign(_SWITCHED, tip))
    return go_to_load(leaving, _FIRST)
