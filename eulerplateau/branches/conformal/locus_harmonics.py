"""Curves of special points of films without a mesh, with the harmonics that they need."""

from __future__ import annotations

from dataclasses import replace
from typing import cast

import numpy as np

from eulerplateau.branches.conformal.family import SmoothFamily
from eulerplateau.branches.conformal.resolution import TAIL
from eulerplateau.branches.control import Motion
from eulerplateau.branches.locus_between import Resolution
from eulerplateau.branches.locus_point import LocusPoint, correct
from eulerplateau.exact.conformal import BETTER, Basis, finer_bases


class Harmonics(Resolution):
    """The harmonics of a curve of special points: more of them where its tail asks."""

    def resolved(self, point: LocusPoint) -> LocusPoint:
        """Return the same point with a tail of at most TAIL, or the least there is."""
        off = _family(point).tail(point.model.x)
        for basis in finer_bases(_family(point).basis) if off > TAIL else ():
            found = self._in_basis(point, basis)
            if found is not None and _family(found).tail(found.model.x) < BETTER * off:
                return self.resolved(found)
        return point

    def carried(self, motion: Motion, old: LocusPoint, new: LocusPoint) -> Motion:
        """Return what a motion in the unknowns of one point is in those of another."""
        moved = _family(new).transferred(_family(old), motion.displacement)
        return Motion(moved, motion.rates)

    def _in_basis(self, point: LocusPoint, basis: Basis) -> LocusPoint | None:
        new = replace(point, family=replace(_family(point), basis=basis))
        place, way, steep = (
            self.carried(motion, point, new)
            for motion in (point.place, point.direction, point.steepness)
        )
        still = np.zeros(2)
        lost = (Motion(point.model.displacement(m), still) for m in point.modes.T)
        modes = [self.carried(mode, point, new).displacement for mode in lost]
        found = correct(point.course, new.family, place, way, modes, steep)
        if found is None:
            return None
        return replace(found, arclength=point.arclength, special=point.special)


def _family(point: LocusPoint) -> SmoothFamily:
    return cast(SmoothFamily, point.family)
