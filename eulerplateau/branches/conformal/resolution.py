"""The same film by more harmonics, or on a grid that resolves a narrower waist."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from eulerplateau.branches.conformal.family import smooth_family
from eulerplateau.branches.control import Direction, StepControl
from eulerplateau.branches.point import BranchPoint, correct, point_near
from eulerplateau.exact.conformal import BETTER, Basis, finer_bases

# Films are refined until the last tenth of their harmonics is this small.
TAIL = 1e-10


def tail(point: BranchPoint) -> float:
    """Return the relative error of truncation, roughly."""
    return smooth_family(point).tail(point.x)


def resolved(point: BranchPoint, control: StepControl, within: float = TAIL) -> BranchPoint:
    """Return the same film with a tail of at most `within`, or the least there is."""
    while tail(point) > within:
        finer = next(_finer(point, control), None)
        if finer is None:
            return point
        point = finer
    return point


def in_basis(point: BranchPoint, basis: Basis, control: StepControl) -> BranchPoint | None:
    """Return the same film in another basis of its symmetry; None if it is not found."""
    old = smooth_family(point)
    family = replace(old, basis=basis)
    found = point_near(family, family.transferred(old, point.x), point.value, control.least)
    if found is None:
        return None
    ahead = family.transferred(old, point.direction.displacement)
    way = Direction(ahead, point.direction.rate)
    found = correct(family, found.x, found.value, way, control)
    return None if found is None else replace(found, arclength=point.arclength)


def _finer(point: BranchPoint, control: StepControl) -> Iterator[BranchPoint]:
    """Yield the film in bases that resolve it better."""
    for basis in finer_bases(smooth_family(point).basis):
        found = in_basis(point, basis, control)
        if found is not None and tail(found) < BETTER * tail(point):
            yield found
