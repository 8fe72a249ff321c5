"""Second variation of the true film: Morse index and critical modes.

The constrained Hessian over all loops x(phi), reparametrisations included. At a conformal
loop its negative directions are as many as those of the area problem with the film relaxed
(Tromba, Struwe: the film's own instabilities are counted too), and its null space holds the
rigid motions and the conformal maps of the disk, which are taken out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError, cholesky, eigh

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.conformal.basis import Basis, make_basis
from eulerplateau.exact.conformal.energy import length_gradient
from eulerplateau.exact.conformal.equilibrium import (
    ConformalFilm,
    lagrangian_hessian,
    precondition,
)
from eulerplateau.exact.conformal.families import (
    GENERAL,
    HALF_TURNS,
    PLANAR,
    TWISTED,
    Family,
)
from eulerplateau.exact.conformal.gauge import gauge_modes

# Shifts tried, in units of alpha/L^4, to make the Hessian positive.
_SHIFTS = 10.0 ** np.arange(3, 16)
# An eigenvalue within this part of the shift is rounding.
_NOISE = 1e-11
_COUNT = 8


@dataclass(frozen=True)
class Mode:
    """A displacement of the loop and its second variation per oint |dx|^2 ds.

    Attributes
    ----------
    eigenvalue : float
        In units of alpha/L^4. For a displacement across the plane of a planar film it is
        that of the inextensible loop with the film relaxed; modes in a plane contain
        sliding along the loop, so that only the eigenvalue's sign means something.
    coefficients : (basis.size,) float
        Of unit norm oint |dx|^2 ds = 1.
    transverse : float
        The share of z in that norm.
    noise : float
        An eigenvalue smaller than this is rounding.
    """

    basis: Basis
    eigenvalue: float
    coefficients: FloatArray
    transverse: float
    noise: float


def modes(film: ConformalFilm, family: Family, count: int = _COUNT) -> list[Mode]:
    """Return the `count` lowest modes of one symmetry, without length change and gauge.

    `family` is one of HALF_TURNS for films of PLANAR or TWISTED, else GENERAL or the
    film's own.
    """
    basis = make_basis(film.basis.harmonics, family, film.basis.crowding)
    curve = film.curve
    scale = precondition(basis)
    mass = _mass(basis, np.linalg.norm(curve.x1, axis=1))
    hessian = lagrangian_hessian(basis, curve, film.beta, film.load)
    held = np.column_stack(
        [length_gradient(basis, curve), mass @ gauge_modes(basis, curve)]
    )
    free = _complement(scale[:, None] * held)
    stiff = free.T @ (scale[:, None] * hessian * scale) @ free
    heavy = free.T @ (scale[:, None] * mass * scale) @ free
    shift = _shift(stiff, heavy)
    last = len(stiff) - 1
    inverse, vectors = eigh(
        heavy, stiff + shift * heavy, subset_by_index=[max(0, last + 1 - count), last]
    )
    found = []
    for value, vector in zip(inverse[::-1], vectors.T[::-1], strict=True):
        c = scale * (free @ vector)
        c /= np.sqrt(c @ mass @ c)
        z = basis.slices[2]
        across = float(c[z] @ mass[z, z] @ c[z])
        found.append(Mode(basis, float(1 / value - shift), c, across, _NOISE * shift))
    return found


def spectrum(film: ConformalFilm, count: int = _COUNT) -> list[Mode]:
    """Return the `count` lowest modes of each symmetry, all in ascending order."""
    whole = film.basis.family in (PLANAR, TWISTED)
    families = HALF_TURNS if whole else (GENERAL,)
    found = [mode for family in families for mode in modes(film, family, count)]
    return sorted(found, key=lambda mode: mode.eigenvalue)


def morse_index(film: ConformalFilm) -> int:
    """Return the number of unstable modes (up to 8 of each symmetry)."""
    return sum(mode.eigenvalue < -mode.noise for mode in spectrum(film))


def _mass(basis: Basis, speed: FloatArray) -> FloatArray:
    """Return the matrix (size, size) of oint |dx|^2 ds."""
    mass = np.zeros((basis.size, basis.size))
    for part, (values, _, _) in zip(basis.slices, basis.matrices, strict=True):
        mass[part, part] = basis.weight * values.T @ (speed[:, None] * values)
    return mass


def _complement(held: FloatArray) -> FloatArray:
    """Return an orthonormal basis of what is orthogonal to the columns (size, m)."""
    sizes = np.linalg.norm(held, axis=0)
    # A column without this symmetry is rounding.
    held = held[:, sizes > 1e-9] / sizes[sizes > 1e-9]
    if held.shape[1] == 0:
        return np.eye(len(held))
    whole = np.linalg.qr(held, mode="complete")[0]
    return whole[:, held.shape[1] :].astype(np.float64)


def _shift(stiff: FloatArray, heavy: FloatArray) -> float:
    """Return a shift that makes the pencil positive: few digits are lost to it."""
    for shift in _SHIFTS:
        try:
            cholesky(stiff + shift * heavy, check_finite=False)
        except LinAlgError:
            continue
        return float(shift)
    raise ArithmeticError("the second variation has no lower bound: more harmonics needed")
