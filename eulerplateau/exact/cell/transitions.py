"""Where a regular cell changes: inflection, folds, their meeting; located, not scanned.

Without line tension all cells with N adhesions are one curve of shapes over c, the
curvature in mid-side, in units of xi = (alpha / sigma)^(1/3) (tethered.py). With adhesions
at y = sigma_hat^(1/3) in those units, a shape of radius rho and force f belongs to

    ks_hat = f y^3 / (2 (y - rho)).

    inflection sigma_1*   c = 0, a zero of the curvature and no bifurcation
    fold                  dks_hat/dc = 0:  y = rho - f rho'/f'
    least ks_hat          dks_hat/dy = 0 besides:  y = 3 rho / 2, the adhesions extended by
                          a third of R_0
    rigid limit           ks_hat infinite on the fold: rho' = 0, y = rho

At given sigma_hat the smooth cell exists up to the fold's ks_hat, at given ks_hat outside
of an interval of sigma_hat. Where it shrinks to a point two branches reconnect.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.optimize import brentq

from eulerplateau.errors import SpecError
from eulerplateau.exact.cell.regular import CellStatus, RegularCell
from eulerplateau.exact.cell.side import HalfSide
from eulerplateau.exact.cell.tethered import ShapeCurve, Tethered
from eulerplateau.exact.checks import finite, whole_number

# c of the circle is 1; folds lie where it is lower, and never as low as this.
_ROUND, _LOWEST = 1.0, -1.0
# How far from the shape of a rigid substrate, where ks_hat is infinite, a stretch ends.
_NEXT_TO_RIGID = 1e-6


@dataclass(frozen=True)
class Transition:
    """A located point of the plane of contractility and stiffness, and the cell there.

    Attributes
    ----------
    sigma_hat, ks_hat : float; ks_hat is infinite in the rigid limit
    cell : the shape there, of a substrate with adhesions at R_0 = 1
    """

    sigma_hat: float
    ks_hat: float
    cell: RegularCell


@lru_cache(maxsize=16)
def _curve(adhesions: int) -> ShapeCurve:
    return ShapeCurve(adhesions)


@lru_cache(maxsize=16)
def _ends_of_folds(adhesions: int) -> tuple[float, float]:
    """Return c of the rigid limit and c of the strongest pull, between which folds lie."""
    rigid = _root(adhesions, lambda shape: shape.slope[2], _LOWEST, 0.3)
    strongest = _root(adhesions, lambda shape: shape.slope[1], rigid, _ROUND)
    return rigid, strongest


def inflections(adhesions: int, ks_hat: float) -> tuple[Transition, ...]:
    """Return where the middle of the sides is straight: two loads, or none.

    Between the two, sigma_1* and the other, a cell is inflected; the second may be one of
    an unstable cell, as with two adhesions on a stiff substrate. Both solve the cubic
    f y^3 = 2 ks_hat (y - rho), with force and radius of the shape with c = 0.
    """
    n, k = whole_number("adhesions", adhesions, 2), _positive("ks_hat", ks_hat)
    flat = _shape(n, 0.0)
    roots = np.roots([flat.force, 0.0, -2 * k, 2 * k * flat.radius])
    real = np.sort(roots[np.abs(roots.imag) < 1e-9 * np.abs(roots)].real)
    return tuple(_transition(flat, float(y)) for y in real[real > flat.radius])


def inflection_onset(adhesions: int) -> Transition:
    """Return the softest substrate on which a cell is ever straight in mid-side."""
    flat = _shape(whole_number("adhesions", adhesions, 2), 0.0)
    return _transition(flat, 1.5 * flat.radius)


def inflection_stiffness(adhesions: int, sigma_hat: float) -> Transition | None:
    """Return the stiffness at which sides are straight in the middle, if they ever are."""
    flat = _shape(whole_number("adhesions", adhesions, 2), 0.0)
    y = float(np.cbrt(finite("sigma_hat", sigma_hat)))
    return _transition(flat, y) if y > flat.radius else None


def fold_stiffness(adhesions: int, sigma_hat: float) -> Transition | None:
    """Return the stiffest substrate with a smooth cell at a contractility.

    None where smooth cells exist on every substrate: below that of `rigid_fold`.
    """
    n = whole_number("adhesions", adhesions, 2)
    y = float(np.cbrt(finite("sigma_hat", sigma_hat)))
    rigid, strongest = _ends_of_folds(n)
    if y <= _shape(n, rigid).radius:
        return None
    c = _root(n, lambda shape: 1 / y - 1 / shape.fold_radius, rigid, strongest)
    return _transition(_shape(n, c), y)


def folds(adhesions: int, ks_hat: float) -> tuple[Transition, ...]:
    """Return the two contractilities between which there is no smooth cell, or none."""
    n, k = whole_number("adhesions", adhesions, 2), _positive("ks_hat", ks_hat)
    meeting = reconnection(n)
    if k <= meeting.ks_hat:
        return ()

    def stiffer(shape: Tethered) -> float:
        y = shape.fold_radius
        return 1 / k - 2 * (y - shape.radius) / (shape.force * y**3)

    rigid, strongest = _ends_of_folds(n)
    middle = _meeting(n)
    ends = (rigid, middle), (middle, strongest)
    found = [_shape(n, _root(n, stiffer, *pair)) for pair in ends]
    return tuple(_transition(shape, shape.fold_radius) for shape in found)


def fold_line(adhesions: int, count: int = 101) -> tuple[Transition, ...]:
    """Return points of the fold for ever larger sigma_hat, from next to `rigid_fold`.

    Evenly spaced in c between its two ends at infinity, which are left out.
    """
    n = whole_number("adhesions", adhesions, 2)
    places = np.linspace(*_ends_of_folds(n), count + 2)[1:-1]
    shapes = [_shape(n, float(c)) for c in places]
    return tuple(_transition(shape, shape.fold_radius) for shape in shapes)


def reconnection(adhesions: int) -> Transition:
    """Return the softest substrate with a fold, where two branches reconnect."""
    n = whole_number("adhesions", adhesions, 2)
    shape = _shape(n, _meeting(n))
    return _transition(shape, 1.5 * shape.radius)


def rigid_fold(adhesions: int) -> Transition:
    """Return the largest contractility with a smooth cell on a rigid substrate."""
    n = whole_number("adhesions", adhesions, 2)
    shape = _shape(n, _ends_of_folds(n)[0])
    return _transition(shape, shape.radius)


def strongest_pull(adhesions: int) -> float:
    """Return lim ks_hat / sigma_hat^(2/3) on the fold for large contractility: f / 2."""
    n = whole_number("adhesions", adhesions, 2)
    return 0.5 * _shape(n, _ends_of_folds(n)[1]).force


@dataclass(frozen=True)
class Stretch:
    """The stable shapes at one contractility: from the circle to a fold, or to rigidity.

    Attributes
    ----------
    round, end : float, c at the circle and where the stretch ends, below it
    """

    adhesions: int
    y: float
    round: float
    end: float

    def at(self, c: float) -> Transition:
        """Return the cell with c in mid-side and the substrate it belongs to."""
        return _transition(_shape(self.adhesions, c), self.y)


def stable_stretch(adhesions: int, sigma_hat: float) -> Stretch:
    """Return the symmetric shapes that are stable at sigma_hat > 1, as far as these go."""
    n, y = adhesions, float(np.cbrt(sigma_hat))
    top = fold_stiffness(n, sigma_hat)
    if top is not None:
        return Stretch(n, y, _ROUND, top.cell.kappa_mid / y)
    # The radius grows as c falls, up to that of the adhesions.
    rigid = _root(n, lambda shape: shape.radius - y, _ends_of_folds(n)[0], _ROUND)
    return Stretch(n, y, _ROUND, rigid + _NEXT_TO_RIGID * (_ROUND - rigid))


def smooth_cells(
    adhesions: int, sigma_hat: float, ks_hat: float
) -> tuple[RegularCell, ...]:
    """Return the smooth cells that pull on their adhesions, the stable one first.

    There are two below the fold, one below `rigid_fold`, none beyond: for sigma_hat > 1.
    Stable is meant within the cell's symmetry.
    """
    n = whole_number("adhesions", adhesions, 2)
    sigma, k = _positive("sigma_hat", sigma_hat), _positive("ks_hat", ks_hat)
    if sigma <= 1.0:
        raise SpecError("sigma_hat", f"found {sigma:g}; should be above 1: cells pull")
    stretch = stable_stretch(n, sigma)
    y, end = stretch.y, stretch.end
    brackets = [(end, _ROUND)]
    fold = fold_stiffness(n, sigma)
    if fold is not None:
        if k > fold.ks_hat:
            return ()
        brackets.append((_root(n, lambda shape: shape.force, 2 * _LOWEST, end), end))

    def excess(shape: Tethered) -> float:
        return shape.force * y**3 - 2 * k * (y - shape.radius)

    shapes = [_shape(n, _root(n, excess, *pair)) for pair in brackets]
    return tuple(_transition(shape, y).cell for shape in shapes)


def _meeting(n: int) -> float:
    def beyond(shape: Tethered) -> float:
        return 1 / shape.fold_radius - 1 / (1.5 * shape.radius)

    return _root(n, beyond, *_ends_of_folds(n))


def _shape(n: int, c: float) -> Tethered:
    shape = _curve(n).at(c)
    if shape is None:
        raise RuntimeError(f"the curve of shapes with {n} adhesions ends before {c:g}")
    return shape


def _root(n: int, of: Callable[[Tethered], float], low: float, high: float) -> float:
    """Return the c between two others at which a function of the shape is zero."""
    return float(brentq(lambda c: of(_shape(n, c)), low, high, xtol=1e-15, rtol=1e-15))


def _transition(shape: Tethered, y: float) -> Transition:
    """Return the point of a shape whose adhesions rest at y, in units of R_0."""
    rigid = y == shape.radius
    k = np.inf if rigid else shape.stiffness(y) * y**3
    side = HalfSide(shape.side.adhesions, np.append(shape.side.z[:-1], shape.side.h / y))
    cell = RegularCell(side, float(y**3), float(k), 0.0, CellStatus.CONVERGED)
    return Transition(float(y**3), float(k), cell)


def _positive(name: str, value: float) -> float:
    found = finite(name, value)
    if found == 0.0:
        raise SpecError(name, "found 0; should be above 0")
    return found
