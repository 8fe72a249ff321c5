"""Films of true area at given writhe: a curve without folds, from flat to pinched.

A rod that resists twist without limit writhes by what it was turned. Its films are those of
every other rod too, at another link: the moment M that holds a film at its writhe is

    2 pi M = E_0'(Wr),     Lk = Wr + M / (2 pi gamma),     gamma = 2 C / B,

E_0 being the least energy of film and bending at that writhe. A film that is stable at its
writhe is stable with a rod where E_0'' + 8 pi^2 C/B > 0.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import cast

import numpy as np

from eulerplateau.branches.conformal.family import SmoothFamily, smooth_family
from eulerplateau.branches.conformal.resolution import resolved
from eulerplateau.branches.conformal.terms import SmoothTwist
from eulerplateau.branches.continuation import Place, next_place
from eulerplateau.branches.control import StepControl
from eulerplateau.branches.point import BranchPoint, first_point, point_near
from eulerplateau.exact.conformal import (
    BUCKLING,
    TWISTED,
    Basis,
    BranchError,
    ConformalFilm,
    disk,
    make_basis,
    two_lobes,
    waist,
)
from eulerplateau.solvers import tangent_model

# Is told how far a film has been followed.
Tell = Callable[[str], None]
# C / B of a rod that takes up next to no twist.
RIGID = 1e3
# Steps are measured by the writhe, and are this long at most.
CONTROL = StepControl(
    window=(-1.0, 2.0),
    unit=0.01,
    first_step=3.0,
    largest_step=4.0,
    smallest_step=1e-4,
    max_points=300,
    least=-math.inf,
)
# Waist, in L, down to which films are followed.
NARROWEST = 5e-3
_ROUND_HARMONICS = 32
# Size of the disk's critical mode, in its tangent, at which films that leave it begin.
_AWAY = 0.02


def films_by_writhe(
    load: float,
    narrowest: float = NARROWEST,
    step: float = CONTROL.first_step,
    tell: Tell = lambda where: None,
) -> Iterator[BranchPoint]:
    """Yield films of rising writhe at a load, right-handed, of a rod of twist ratio RIGID.

    The first step is `step` hundredths of a turn long, and so are most.

    They begin with the flat film of two lobes or, up to 48 pi^3, next to the disk, and end
    before the waist is narrower than `narrowest`, in L, or where harmonics do not resolve
    it any more. Each is of TWISTED, its lobes along x. `tell` is told the writhe of each.
    """
    point = lobes_at(load) if load > BUCKLING else _beside_disk(load)
    place: Place | None = Place(point, step, CONTROL.max_points)
    while place is not None and waist(film_of(place.point)) > narrowest:
        writhe = smooth_family(place.point).twist(place.point.value).writhe(place.point.x)
        tell(f"writhe {writhe:.3f}")
        yield place.point
        place = next_place(place, CONTROL)
        if place is not None:
            place = replace(place, point=resolved(place.point, CONTROL))


def lobes_at(load: float) -> BranchPoint:
    """Return the flat film of two lobes, at no writhe."""
    flat = two_lobes(load)
    basis = make_basis(flat.basis.harmonics, TWISTED, flat.basis.crowding)
    family = family_at(load, basis)
    start = family.unknowns.x(basis.embed(flat.basis, flat.coefficients))
    return first_point(family, start, 0.0, CONTROL)


def film_of(point: BranchPoint) -> ConformalFilm:
    """Return the film of a point."""
    return smooth_family(point).film(point)


def stiffness(point: BranchPoint) -> float:
    """Return E_0'', the second derivative by the writhe of the energy without twist."""
    twist = cast(SmoothTwist, smooth_family(point).twist(point.value))
    model = point.model
    slope = model.slope(twist.slope(point.x))
    whole = 1 / float(slope @ np.linalg.solve(model.hessian, slope))
    return whole - 4 * math.pi**2 * twist.gamma


def family_at(load: float, basis: Basis) -> SmoothFamily:
    """Return the films of a rod of twist ratio RIGID at a load, by their link."""
    values = {"load": load, "twist_ratio": RIGID, "link": 0.0}
    return SmoothFamily(basis, values, "link")


def critical_moment(load: float, mode: int = 2) -> float:
    """Return the twisting moment at which the flat disk yields to a mode, up to n^2 - 1.

    M = 4 pi sqrt((n^2 - 1 - nu)(1 - nu / (n (n + 1)))), nu = sigma_hat / 16 pi^3.
    """
    nu = load / (16 * math.pi**3)
    room = (mode**2 - 1 - nu) * (1 - nu / (mode * (mode + 1)))
    return 4 * math.pi * math.sqrt(room)


def _beside_disk(load: float) -> BranchPoint:
    """Return a film next to where the disk yields to its moment, writhing a little."""
    basis = make_basis(_ROUND_HARMONICS, TWISTED)
    family = family_at(load, basis)
    moment = critical_moment(load)
    flat = family.unknowns.x(disk(basis, load).coefficients)
    held = moment / (4 * math.pi * RIGID)
    model = tangent_model(family.energy(held), flat)
    values, vectors = model.eigen
    mode = model.displacement(vectors[:, np.abs(values).argmin()])
    # The lobes lie along x: the tip at phi = 0 moves outwards.
    mode *= np.copysign(_AWAY, family.positions(mode)[0, 0])
    beside = flat + mode
    found = point_near(family, beside, family.twist(held).writhe(beside) + held)
    if found is None:
        raise BranchError(f"no film leaves the disk at sigma_hat = {load:g}")
    return first_point(family, found.x, found.value, CONTROL)
