"""The energy of a loop that is a trigonometric polynomial, as a sum of terms.

A loop is the column (size, 1) of its coefficients over 1 / (k sqrt(1 + k^2)): bending grows
as k^4. Its film is the harmonic extension (exact/conformal). The loop is held to its whole
length only: pieces of it may slide along it, which changes nothing. Energies are in units
of alpha / L.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.conformal import (
    Basis,
    Blocks,
    Crossing,
    Curve,
    bending_blocks,
    bending_gradient,
    bending_hessian,
    crossing,
    length_gradient,
    length_hessian,
    loop_length,
    precondition,
    smooth_writhe,
    writhe_blocks,
    writhe_gradient,
    writhe_hessian,
)
from eulerplateau.loop import EdgeTurns, EvenTwist, Term

# Loops that are kept: where a step begins, and where it may end.
_KEPT = 4


@dataclass(frozen=True)
class SmoothLoop:
    """A loop, and what several terms ask of it."""

    basis: Basis
    coefficients: FloatArray

    @cached_property
    def curve(self) -> Curve:
        """The loop at the basis's grid."""
        return self.basis.curve(self.coefficients)

    @cached_property
    def writhe(self) -> float:
        """Wr."""
        return smooth_writhe(self.curve)

    @cached_property
    def crossing(self) -> Crossing:
        """Where the strands of its waist are nearest."""
        return crossing(self.basis, self.coefficients)

    @cached_property
    def writhe_gradient(self) -> FloatArray:
        """Its gradient (size,)."""
        return writhe_gradient(self.basis, self.curve)


@dataclass(frozen=True)
class LoopBeside(SmoothLoop):
    """A loop as displacements of another symmetry than its own find it.

    `basis` is theirs, and all coefficients there are 0.
    """

    itself: SmoothLoop

    @cached_property
    def curve(self) -> Curve:
        """The loop at the grid."""
        return self.itself.curve

    @cached_property
    def writhe(self) -> float:
        """Wr."""
        return self.itself.writhe


@dataclass(frozen=True)
class Unknowns:
    """What stands for a loop of a basis, and for a frame along it if that is asked for.

    Attributes
    ----------
    scale : (size,) float, coefficients of the loop per unknown
    frame_scale : (m,) float, those of the frame; none of a rod that is straight by nature
    """

    basis: Basis
    scale: FloatArray
    frame_scale: FloatArray
    _known: dict[bytes, SmoothLoop] = field(default_factory=dict, repr=False)

    @classmethod
    def of(cls, basis: Basis, frame_waves: FloatArray) -> Unknowns:
        """Return those in which every harmonic is about as stiff as every other.

        frame_waves : (m,) float, the wavenumbers of the frame
        """
        return cls(basis, precondition(basis), 1 / np.sqrt(1 + frame_waves**2))

    @classmethod
    def beside(cls, basis: Basis, loop: SmoothLoop) -> Unknowns:
        """Return those of displacements of another symmetry from a loop: it is at x = 0."""
        found, still = cls.of(basis, np.zeros(0)), np.zeros((basis.size, 1))
        found._known[still.tobytes()] = LoopBeside(basis, still[:, 0], loop)
        return found

    @property
    def scales(self) -> FloatArray:
        """Coefficients of loop and frame per unknown."""
        return np.concatenate([self.scale, self.frame_scale])

    @property
    def weights(self) -> FloatArray:
        """The norm's: of the loop's tangents by the angle, and of the frame's angles."""
        tangents = (self.basis.wavenumbers * self.scale) ** 2
        return np.concatenate([tangents, self.frame_scale**2])

    def loop(self, x: FloatArray) -> SmoothLoop:
        """Return the loop of x (size + m, 1)."""
        place = x.tobytes()
        found = self._known.get(place)
        if found is None:
            while len(self._known) >= _KEPT:
                del self._known[next(iter(self._known))]
            found = SmoothLoop(self.basis, self.scale * x[: self.basis.size, 0])
            self._known[place] = found
        return found

    def others(self, x: FloatArray) -> FloatArray:
        """Return the coefficients (m,) of the frame."""
        found: FloatArray = self.frame_scale * x[self.basis.size :, 0]
        return found

    def x(self, coefficients: FloatArray, frame: FloatArray | None = None) -> FloatArray:
        """Return x (size + m, 1) of coefficients (size,), and of the frame's or none."""
        angles = np.zeros(len(self.frame_scale)) if frame is None else frame
        return (np.concatenate([coefficients, angles]) / self.scales)[:, None]

    def slope(self, gradient: FloatArray) -> FloatArray:
        """Return the derivative (size + m, 1) by x of a gradient (size,) by the loop's."""
        return np.concatenate([self.scale * gradient, 0 * self.frame_scale])[:, None]

    def product(self, blocks: Blocks, step: FloatArray) -> FloatArray:
        """Return a second derivative times a step (size + m, 1)."""
        return self.slope(
            blocks.product(self.basis, self.scale * step[: self.basis.size, 0])
        )

    def curvature(self, hessian: FloatArray) -> FloatArray:
        """Return the second derivative by x of that (size, size) by coefficients."""
        m = len(self.frame_scale)
        curved: FloatArray = self.scale[:, None] * hessian * self.scale
        return np.pad(curved, (0, m)) if m else curved


@dataclass(frozen=True)
class SmoothBending(Term):
    """The bending energy, oint kappa^2 ds."""

    unknowns: Unknowns

    def force(self, x: FloatArray) -> FloatArray:
        """Return the gradient (size, 1)."""
        u = self.unknowns
        return u.slope(bending_gradient(u.basis, u.loop(x).curve))

    def hessian(self, x: FloatArray) -> FloatArray:
        """Return the second derivative (size, size)."""
        u = self.unknowns
        return u.curvature(bending_hessian(u.basis, u.loop(x).curve))

    def product(self, x: FloatArray, step: FloatArray) -> FloatArray:
        """Return the second derivative times a step (size, 1)."""
        u = self.unknowns
        return u.product(bending_blocks(u.basis, u.loop(x).curve), step)


@dataclass(frozen=True)
class SmoothFilm(Term):
    """The film's energy, load times area: the Dirichlet energy of the extension."""

    unknowns: Unknowns
    load: float

    def force(self, x: FloatArray) -> FloatArray:
        """Return the gradient (size, 1)."""
        return self.load * self._pull(x)

    def hessian(self, x: FloatArray) -> FloatArray:
        """Return the second derivative (size, size)."""
        return self.load * self.unknowns.curvature(self.unknowns.basis.dirichlet)

    def rate(self, parameter: str, x: FloatArray) -> FloatArray | None:
        """Return the derivative of the force by "load"."""
        return self._pull(x) if parameter == "load" else None

    def _pull(self, x: FloatArray) -> FloatArray:
        u = self.unknowns
        return u.slope(u.basis.dirichlet @ u.loop(x).coefficients)


@dataclass(frozen=True)
class SmoothTwist(EvenTwist):
    """The twisting energy of a welded loop: see loop/twist.py, which has its formulas.

    Attributes
    ----------
    ratio : float, C / B
    link : float, Lk, in turns
    """

    unknowns: Unknowns
    ratio: float
    link: float

    def twist_energy(self, x: FloatArray) -> float:
        """Return the twisting energy: all of it."""
        return self.energy(x)

    def writhe(self, x: FloatArray) -> float:
        """Return Wr."""
        return self.unknowns.loop(x).writhe

    def hessian(self, x: FloatArray) -> FloatArray:
        """Return -2 pi M d2Wr/dx2 + 4 pi^2 gamma dWr/dx dWr/dx (size, size)."""
        u, slope = self.unknowns, self.slope(x)
        second = u.curvature(writhe_hessian(u.basis, u.loop(x).curve))
        stiff: FloatArray = 4 * math.pi**2 * self.gamma * slope @ slope.T
        return stiff - 2 * math.pi * self.moment(x) * second

    def product(self, x: FloatArray, step: FloatArray) -> FloatArray:
        """Return the second derivative times a step (size, 1)."""
        u, slope = self.unknowns, self.slope(x)
        bent = u.product(writhe_blocks(u.basis, u.loop(x).curve), step)
        stiff = 4 * math.pi**2 * self.gamma * float(np.vdot(slope, step)) * slope
        return stiff - 2 * math.pi * self.moment(x) * bent

    def slope(self, x: FloatArray) -> FloatArray:
        """Return dWr/dx (size, 1)."""
        u = self.unknowns
        return u.slope(u.loop(x).writhe_gradient)


@dataclass(frozen=True)
class WholeLength:
    """The constraint that a loop is as long as it was: length - 1 = 0."""

    unknowns: Unknowns

    def jacobian(self, x: FloatArray) -> FloatArray:
        """Return the derivative of the length (1, size)."""
        u = self.unknowns
        return u.slope(length_gradient(u.basis, u.loop(x).curve)).T

    def force(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return the multiplier times that (size, 1)."""
        return self.jacobian(x).T * tensions

    def stiffness(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return the multiplier times the second derivative (size, size)."""
        u = self.unknowns
        second = u.curvature(length_hessian(u.basis, u.loop(x).curve))
        return float(tensions[0]) * second

    def project(self, x: FloatArray) -> FloatArray | None:
        """Return the loop of that length and the same shape, with the same frame."""
        found = x.copy()
        found[: self.unknowns.basis.size] /= loop_length(self.unknowns.loop(x).curve)
        return found

    def turns(self, x: FloatArray) -> EdgeTurns | None:
        """Return None: there are no edges."""
        return None

    def split_stiffness(
        self, x: FloatArray, tensions: FloatArray
    ) -> tuple[FloatArray | None, FloatArray]:
        """Return nothing: there are no edges."""
        return None, np.zeros(0)
