"""Areas of round cells on substrates of several stiffnesses, against measured ones."""

from __future__ import annotations

from dataclasses import dataclass
from math import log, pi

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.cell.spreading import cubic_root
from eulerplateau.exact.profiles import Box

# How far beyond the data a parameter is followed, and how much farther the others may go
# meanwhile, as logarithms. There the model is within 1e-6 of its limits.
_EDGE, _BEYOND = 14.0, 30.0
_GRID = 8


@dataclass(frozen=True)
class AreaModel:
    """Stiffnesses (n,) and measured areas (n,), in units in which their means are 1 and pi.

    `error` (n,) is each area's; None, with residuals relative ones: those of logarithms.
    `rest_radius` is None where it is to be fitted. Parameters are the logarithms of sigma,
    alpha and R_0.
    """

    stiffness: FloatArray
    area: FloatArray
    error: FloatArray | None
    rest_radius: float | None

    def __call__(self, theta: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return residuals (b, n) and their derivatives (b, n, 3) at theta (b, 3)."""
        area, slopes = areas(self.stiffness, theta)
        if self.error is None:
            return np.log(area / self.area), slopes
        scale = area / self.error
        return (area - self.area) / self.error, scale[..., None] * slopes

    def bounds(self, margin: float) -> Box:
        """Return the box that reaches so far beyond what the data are made of."""
        radius = np.log(self.area / pi) / 2
        k = np.log(self.stiffness)
        low = np.array([k.min(), k.min() + 3 * radius.min(), radius.min()]) - margin
        high = np.array([k.max(), k.max() + 3 * radius.max(), radius.max()]) + margin
        if self.rest_radius is not None:
            low[2] = high[2] = log(self.rest_radius)
        return Box(low, high)

    @property
    def edges(self) -> Box:
        """How far a profile is followed."""
        return self.bounds(_EDGE)

    @property
    def box(self) -> Box:
        """Where minima are looked for."""
        return self.bounds(_EDGE + _BEYOND)

    def starts(self) -> FloatArray:
        """Return parameters (b, 3) to start from: for each sigma of a grid, the best."""
        wide = self.bounds(log(10.0))
        sigma = np.linspace(wide.low[0], wide.high[0], _GRID)
        radii = self.bounds(0.0)
        xi = np.linspace(radii.low[2], radii.high[2], _GRID)
        if self.rest_radius is not None:
            radius = np.log(self.area / pi) / 2
            xi = np.linspace(radius.min() - 1, radius.max() + 1, _GRID)
        rest = np.linspace(radii.low[2], radii.high[2] + log(3.0), _GRID)
        if self.rest_radius is not None:
            rest = radii.low[2:]
        grid = np.stack(np.meshgrid(sigma, xi, rest, indexing="ij"), axis=-1)
        grid[..., 1] = grid[..., 0] + 3 * grid[..., 1]
        residual, _ = self(grid.reshape(-1, 3))
        cost = (residual**2).sum(axis=1).reshape(_GRID, -1)
        chosen: FloatArray = grid.reshape(_GRID, -1, 3)[range(_GRID), cost.argmin(axis=1)]
        return chosen

    def far_starts(self) -> FloatArray:
        """Return parameters (b, 3) for the edges: in valleys where two or three diverge."""
        near = self.starts()
        free = np.array([1.0, 1.0, float(self.rest_radius is None)])
        shifts = [
            0 * free,
            *(far * np.array([1.0, 1.0, 0.0]) for far in (_EDGE, 2 * _EDGE)),
        ]
        shifts += [far * free for far in (-_EDGE, _EDGE)]
        return np.concatenate([near + shift for shift in shifts])


def areas(stiffness: FloatArray, theta: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return areas (b, n) and the derivatives (b, n, 3) of their logarithms.

    `theta` (b, 3) are the logarithms of sigma, alpha and R_0, by which is derived.
    """
    sigma, alpha, rest = np.exp(theta).T[:, :, None]
    radius = cubic_root(stiffness[None, :], sigma, alpha, rest)
    bending = pi * alpha / radius**3
    half_curvature = stiffness + pi * sigma + 2 * bending
    inward = np.broadcast_to(-pi * sigma, radius.shape)
    forces = np.stack([inward, bending, stiffness * rest / radius], axis=-1)
    slopes: FloatArray = 2 * forces / half_curvature[..., None]
    return pi * radius**2, slopes
