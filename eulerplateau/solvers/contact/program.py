"""A step on which no near strands overlap, to first order: a quadratic program.

Of all displacements p that keep the loop's lengths, by m coordinates,

    minimise g.p + p.H p / 2   subject to   w + J p >= 0,  |p| <= radius,

w being the widths of k near gaps, closed or not, and H the Lagrangian's Hessian with the
forces of those that are closed. Which of them the step closes the forces of its dual say,

    minimise f.G f / 2 + f.(w - J H^-1 g)  subject to  f >= 0,   G = J H^-1 J^T,

k numbers only (Nocedal and Wright 2006, 16.8).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve

from eulerplateau.arrays import BoolArray, FloatArray

# By which parts of the largest entry of H, over that of J^T J, closed gaps are stiffened,
# one after another, where H is not definite without that.
_STIFFENED = (1e-6, 1e-4, 1e-2)
# A gap, in units of L, that is closed.
CLOSED = 1e-10
# A step is not made to fit its radius better than this.
_FITS = 0.5
# A gap, in units of L, that is not closed for less.
_OPEN = 1e-12
_SHIFTS = 40


@dataclass(frozen=True)
class Program:
    """A quadratic program.

    Attributes
    ----------
    gradient, hessian : (m,) and (m, m) float
    widths : (k,) float
    rows : (k, m) float, J
    closed : (k,) bool, which gaps are closed already
    """

    gradient: FloatArray
    hessian: FloatArray
    widths: FloatArray
    rows: FloatArray
    closed: BoolArray

    def step(self, radius: float) -> tuple[FloatArray, BoolArray] | None:
        """Return the step (m,), and which gaps (k,) it closes; None if none is found.

        Where H is not definite, or the step too long, H is shifted until it fits.
        """
        hessian, lowest = self._convex
        if lowest == 0.0:
            found = self._least(hessian, 0.0)
            if found is not None and float(np.linalg.norm(found[0])) <= radius:
                return found
        # Unknown is by how much more H is shifted than it must be (trust_region.py).
        least = np.finfo(np.float64).eps * float(np.abs(hessian).max())
        most = float(np.linalg.norm(self.gradient)) / radius + least
        fits = None
        for _ in range(_SHIFTS):
            more = np.sqrt(least * most) if fits is not None else most
            found = self._least(hessian, more - lowest)
            size = np.inf if found is None else float(np.linalg.norm(found[0]))
            if size > radius:
                least, most = more, most if fits is not None else 10 * most
                continue
            fits, most = found, more
            if size >= _FITS * radius or most < 2 * least:
                break
        return fits

    @cached_property
    def _convex(self) -> tuple[FloatArray, float]:
        """H, stiffened where gaps are closed if need be; its least eigenvalue, 0 if > 0."""
        hessian = self.hessian
        if _definite(hessian):
            return hessian, 0.0
        rows = self.rows[self.closed]
        stiff = rows.T @ rows
        if len(rows):
            unit = float(np.abs(hessian).max() / np.abs(stiff).max())
            for part in _STIFFENED:
                stiffened: FloatArray = hessian + part * unit * stiff
                if _definite(stiffened):
                    return stiffened, 0.0
            hessian = hessian + _STIFFENED[-1] * unit * stiff
        return hessian, min(float(np.linalg.eigvalsh(hessian)[0]), 0.0)

    def _least(
        self, hessian: FloatArray, shift: float
    ) -> tuple[FloatArray, BoolArray] | None:
        try:
            factor = cho_factor(hessian + shift * np.eye(len(hessian)))
            free = -cho_solve(factor, self.gradient)
            moved = cho_solve(factor, self.rows.T)
            forces = least_forces(self.rows @ moved, self.widths + self.rows @ free)
        except LinAlgError:
            return None
        return free + moved @ forces, forces > 0.0


def least_forces(gram: FloatArray, widths: FloatArray) -> FloatArray:
    """Return the forces f (k,) >= 0 that make f.G f / 2 + f.w least, no gap w + G f < 0.

    The active set of Lawson and Hanson (1974, chapter 23), on G (k, k) itself: gaps of near
    places hang together, and what is closed but for rounding is not closed as well. Raises
    LinAlgError if that comes to no end.
    """
    k = len(widths)
    forces, active, asked = np.zeros(k), np.zeros(k, dtype=bool), np.ones(k, dtype=bool)
    for _ in range(3 * k + 10):
        left = np.where(active | ~asked, 0.0, widths + gram @ forces)
        if left.min(initial=0.0) >= -_OPEN:
            return forces
        lowest = left.argmin()
        active[lowest] = True
        forces, active = _balanced(gram, widths, forces, active)
        # What rounding lets go of at once would be closed again and again.
        asked[lowest] = active[lowest]
    raise LinAlgError("no forces are found that push")


def _balanced(
    gram: FloatArray, widths: FloatArray, forces: FloatArray, active: BoolArray
) -> tuple[FloatArray, BoolArray]:
    """Return forces that close the active gaps, and which: those that pull are let go."""
    while active.any():
        wanted = np.zeros_like(forces)
        factor = cho_factor(gram[np.ix_(active, active)])
        wanted[active] = -cho_solve(factor, widths[active])
        pulls = active & (wanted <= 0.0)
        if not pulls.any():
            return wanted, active
        parts = np.full_like(forces, np.inf)
        span = np.maximum(forces[pulls] - wanted[pulls], np.finfo(np.float64).tiny)
        parts[pulls] = forces[pulls] / span
        forces = forces + float(parts.min()) * (wanted - forces)
        active = active & (parts > parts.min())
        forces[~active] = 0.0
    return forces, active


def _definite(matrix: FloatArray) -> bool:
    try:
        cho_factor(matrix)
    except LinAlgError:
        return False
    return True
