"""Films whose waist is held at a given width: the energy on the way from film to film.

A pair of point forces across the waist, phi = pi/2 and 3 pi/2, in the direction of y. Where
the force vanishes the film is in equilibrium. A point force makes kappa' jump, so that
truncation decays only as a power of the number of harmonics.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.conformal.basis import Basis, make_basis
from eulerplateau.exact.conformal.energy import terms
from eulerplateau.exact.conformal.equilibrium import lagrangian_hessian, precondition

_STEPS, _TRUST = 40, 0.5
_SETTLED, _STUCK = 1e-12, 1e-8
_SHARPEN, _MOST_CROWDED = 1e-6, 1e-8


@dataclass(frozen=True)
class HeldFilm:
    """A film of the families PLANAR or TWISTED with a waist held at `width`.

    `force` is d energy / d width, positive if the film pulls the waist together.
    """

    basis: Basis
    coefficients: FloatArray
    beta: float
    force: float
    load: float
    width: float
    energy: float

    @property
    def tail(self) -> float:
        """Estimate of the relative error of truncation (Basis.tail)."""
        return self.basis.tail(self.coefficients)


def hold(
    basis: Basis, guess: FloatArray, beta: float, force: float, load: float, width: float
) -> HeldFilm | None:
    """Return the film with this waist near a guess (size,); None if Newton fails."""
    scale, across = precondition(basis), width_gradient(basis)
    c, n, best = guess, basis.size, np.inf
    for _ in range(_STEPS):
        t = terms(basis, c)
        pull = force * across
        gradient = t.bending_gradient + beta * t.length_gradient + load * t.area_gradient
        misfit = scale * (gradient - pull)
        largest = np.abs(scale * load * t.area_gradient).max()
        gaps = [t.length - 1, float(across @ c) - width]
        residual = max(float(np.abs(misfit).max() / largest), *map(abs, gaps))
        if residual < _SETTLED or 0.5 * best < residual < _STUCK:
            energy = t.bending + load * t.area
            return HeldFilm(basis, c, beta, force, load, width, energy)
        if not np.isfinite(residual):
            return None
        best = min(best, residual)
        matrix = np.zeros((n + 2, n + 2))
        hessian = lagrangian_hessian(basis, basis.curve(c), beta, load)
        matrix[:n, :n] = scale[:, None] * hessian * scale
        matrix[:n, n] = matrix[n, :n] = scale * t.length_gradient
        matrix[:n, n + 1] = matrix[n + 1, :n] = -scale * across
        rhs = -np.concatenate([misfit, [gaps[0], -gaps[1]]])
        step = np.linalg.solve(matrix, rhs)
        shift = scale * step[:n]
        short = min(1.0, _TRUST / float(basis.wavenumbers @ np.abs(shift) + 1e-300))
        c, beta, force = (
            c + short * shift,
            beta + short * step[n],
            force + short * step[n + 1],
        )
    return None


def sharpen_grid(film: HeldFilm) -> HeldFilm:
    """Return the film on a more crowded grid if its tail asks for one and that helps."""
    crowding = film.basis.crowding / 3
    if film.tail < _SHARPEN or crowding < _MOST_CROWDED:
        return film
    basis = make_basis(film.basis.harmonics, film.basis.family, crowding)
    guess = basis.transfer(film.basis, film.coefficients)
    finer = hold(basis, guess, film.beta, film.force, film.load, film.width)
    return film if finer is None or finer.tail > film.tail else finer


def width_gradient(basis: Basis) -> FloatArray:
    """Return the gradient (size,) of 2 y at phi = pi/2, y being a sum of odd sines."""
    gradient = np.zeros(basis.size)
    k = basis.wavenumbers[basis.slices[1]]
    gradient[basis.slices[1]] = 2 * np.sin(k * pi / 2)
    return gradient
