"""A film that follows its loop: values inside harmonic on a shape, given on the loop.

With the cotangent matrix of the shape, L x = 0 at every interior vertex; on a film at rest
that holds for its own positions (Pinkall and Polthier 1993).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.film import hessian_kernels
from eulerplateau.film.condensation import Condensation, factorise
from eulerplateau.film.tiling import Tiling, TriangleGeometry


@dataclass(frozen=True)
class Follower:
    """What extends values on the loop to those harmonic inside, on a shape.

    Attributes
    ----------
    entries : (m,) float, of the cotangent matrix, one for each of the tiling's pairs
    inverse : its part inside, factorised
    """

    tiling: Tiling
    entries: FloatArray
    inverse: Condensation

    def extend(self, moved: FloatArray) -> FloatArray:
        """Return the values (n_v, m) that are `moved` (n_b, m) on the loop."""
        tiling = self.tiling
        pairs, inside, on_loop = tiling.coupled
        values = np.empty((tiling.n_v, moved.shape[1]))
        values[tiling.loop] = moved
        pull = np.zeros((len(tiling.interior), moved.shape[1]))
        hessian_kernels.couple(self.entries, pairs, inside, on_loop, moved, pull)
        values[tiling.interior] = -self.inverse.solve(pull)
        return values

    def carry(self, forces: FloatArray) -> FloatArray:
        """Return what forces (n_v, m) come to on the loop (n_b, m): the adjoint."""
        tiling = self.tiling
        pairs, inside, on_loop = tiling.coupled
        held = self.inverse.solve(forces[tiling.interior])
        pull = np.zeros((len(tiling.loop), forces.shape[1]))
        hessian_kernels.couple(self.entries, pairs, on_loop, inside, held, pull)
        carried: FloatArray = forces[tiling.loop] - pull
        return carried

    @cached_property
    def condensed(self) -> Condensation:
        """The cotangent matrix with the inside eliminated."""
        return factorise(self.tiling.elimination, self.entries)


def follower(tiling: Tiling, sides: TriangleGeometry) -> Follower:
    """Return what follows the loop on a shape; LinAlgError where that is too degenerate."""
    entries = tiling.cotangent_laplacian(sides)
    pairs, elimination = tiling.inside
    return Follower(tiling, entries, factorise(elimination, entries[pairs]))


def follow_loop(tiling: Tiling, x: FloatArray, x_loop: FloatArray) -> FloatArray:
    """Return the shape x (n_v, 3) after its loop has moved to x_loop (n_b, 3)."""
    moved = x_loop - x[tiling.loop]
    after = x.copy()
    if moved.any():
        after += follower(tiling, tiling.sides(x)).extend(moved)
        after[tiling.loop] = x_loop
    return after


def balance(tiling: Tiling, x: FloatArray) -> FloatArray:
    """Return the forces (n_v, 3) of unit tension that do work near x (n_v, 3).

    Inside the part of the area's gradient along the normal; on the loop f = T^T g. Both
    are independent of the path by which a film came to x.
    """
    sides = tiling.sides(x)
    gradient = tiling.gradient(sides)
    forces = np.zeros_like(x)
    inside = tiling.interior
    normals = tiling.vertex_normals(sides)[inside]
    heights = (gradient[inside] * normals).sum(axis=1)
    forces[inside] = heights[:, None] * normals
    forces[tiling.loop] = follower(tiling, sides).carry(gradient)
    return forces
