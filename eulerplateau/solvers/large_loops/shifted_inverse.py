"""The inverse of the second variation on the constraint's tangent space, by structure.

Coordinates are y = sqrt(<s>) x, fields (n_b, 3). There the Lagrangian's Hessian is C (x)
I_3, C (n_b, n_b), and (C + tau)^-1 on the tangent space (J y = 0, no rigid motion) is
what the bordered system

    [C + tau  J^T  V] [y     ]   [b]
    [J        0    0] [mu    ] = [0]       V: the six rigid motions
    [V^T      0    0] [motion]   [0]

does. Because C is the same for the three coordinates, J has one chord e_v / s_v per row,
and the rigid motions are combinations of 1, x, y, z in each coordinate,

* C + tau + rho U U^T, with U an orthonormal basis of span{1, x, y, z}, is factorised
  instead of C (x) I_3. At equilibrium C U = 0 (that is the balance of forces), so that C
  itself cannot be; Z = rho U^T y (k, 3) less the rigid motions' share becomes an unknown.
* J (C + ...)^-1 J^T is (D (C + ...)^-1 D^T) * (e e^T), element by element, with
  (D y)_v = y_{v+1} - y_v.

Two factorisations and one inverse of matrices of n_b rows, then n_b^2 per solution. The
inertias of both add up to that of the bordered system (Haynsworth 1968), and so count the
eigenvalues on the tangent space below -tau.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError
from scipy.linalg.lapack import dsysv, dsytrf, dsytrs

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.film import negative_pivots
from eulerplateau.loop import (
    RIGID_MOTIONS,
    LengthMetric,
    Loop,
    backward_differences,
    differences,
    length_metric,
    rigid_motions,
)

# rho: about the bending stiffness of a circle's first harmonic, 2 (2 pi)^4.
_DEFLATION = 3e3
# Directions of span{1, x, y, z} smaller than this are rounding: the loop is planar.
_FLAT = 1e-12
# Columns LAPACK's symmetric factorisation takes at a time.
_COLUMNS = 64


@dataclass(frozen=True)
class TangentSpace:
    """The fields y = sqrt(<s>) p (n_b, 3) with J p = 0 and no rigid motion.

    Attributes
    ----------
    direction : (n_b, 3) float, e_v / s_v
    root : (n_b,) float, sqrt(<s>)
    affine : (n_b, k) float
        U: orthonormal basis of span{1, x, y, z} sqrt(<s>); k = 3 for planar loops, else 4.
    motions : (k, 3, 6) float
        Orthonormal combinations of `affine` that are the rigid motions.
    metric : J M^-1 J^T
    """

    direction: FloatArray
    root: FloatArray
    affine: FloatArray
    motions: FloatArray
    metric: LengthMetric

    def stretch(self, fields: FloatArray) -> FloatArray:
        """Return J y (n_b, m) of fields (n_b, 3, m)."""
        moved = self.differences(fields.reshape(len(fields), -1)).reshape(fields.shape)
        rates: FloatArray = np.einsum("vc,vcm->vm", self.direction, moved)
        return rates

    def differences(self, values: FloatArray) -> FloatArray:
        """Return D (values / sqrt(<s>)) for values (n_b, m)."""
        return differences(values / self.root[:, None])

    def pull(self, tensions: FloatArray) -> FloatArray:
        """Return J^T tensions (n_b, 3, m), for tensions (n_b, m)."""
        along = self.direction[:, :, None] * tensions[:, None, :]
        return -backward_differences(along) / self.root[:, None, None]

    def project(self, fields: FloatArray) -> FloatArray:
        """Return the nearest tangent fields to `fields` (n_b, 3, m)."""
        kept = fields - self.pull(self.metric.solve(self.stretch(fields)))
        share = np.tensordot(self.affine, kept, (0, 0))
        rigid = np.tensordot(self.motions, share, ((0, 1), (0, 1)))
        motion = np.tensordot(self.motions, rigid, (2, 0))
        projected: FloatArray = kept - np.tensordot(self.affine, motion, (1, 0))
        return projected


def tangent_space(loop: Loop, x: FloatArray) -> TangentSpace:
    """Return the tangent space at loop positions x (n_b, 3)."""
    root = np.sqrt(loop.mean_lengths)
    columns = np.column_stack([np.ones(len(x)), x - x.mean(axis=0)]) * root[:, None]
    left, size, _ = np.linalg.svd(columns, full_matrices=False)
    affine = left[:, size > _FLAT * size[0]]
    motions = rigid_motions(x).reshape(-1, 3, RIGID_MOTIONS) * root[:, None, None]
    share = np.tensordot(affine, motions, (0, 0)).reshape(-1, RIGID_MOTIONS)
    orthonormal = np.linalg.qr(share)[0].reshape(-1, 3, RIGID_MOTIONS)
    direction = loop.chords(x) / loop.rest_lengths[:, None]
    return TangentSpace(direction, root, affine, orthonormal, length_metric(loop, x))


@dataclass(frozen=True)
class ShiftedInverse:
    """(C + tau)^-1 on the tangent space.

    Attributes
    ----------
    n_below : int
        How many eigenvalues on the tangent space are below -tau.
    space : the tangent space
    """

    n_below: int
    space: TangentSpace
    _inverse: FloatArray
    _complement: FloatArray
    _pivots: IntArray

    def solve(self, fields: FloatArray) -> FloatArray:
        """Return (C + tau)^-1 fields (n_b, 3, m), tangent fields."""
        space, n, m = self.space, len(fields), fields.shape[2]
        free = self._apply(fields)
        affine = np.tensordot(space.affine, free, (0, 0)).reshape(-1, m)
        gap = np.concatenate([-space.stretch(free), affine])
        z, _ = dsytrs(self._complement, self._pivots, gap, lower=1)
        held = space.pull(z[:n]) - np.tensordot(space.affine, z[n:].reshape(-1, 3, m), 1)
        # Once more onto the tangent space: the solution is there up to its rounding only.
        return space.project(free - self._apply(held))

    def _apply(self, fields: FloatArray) -> FloatArray:
        product: FloatArray = self._inverse @ fields.reshape(len(fields), -1)
        return product.reshape(fields.shape)


def shifted_inverse(
    space: TangentSpace, hessian: FloatArray, shift: float
) -> ShiftedInverse:
    """Factorise C + shift, C = `hessian` (n_b, n_b); LinAlgError if a pivot vanishes."""
    n, affine = len(hessian), space.affine
    deflated = _DEFLATION * (affine @ affine.T) + hessian
    deflated[np.diag_indices(n)] += shift
    # Symmetric, so that the transpose is the matrix, and in LAPACK's order.
    factor, pivots, inverse, info = dsysv(
        deflated.T,
        np.eye(n, order="F"),
        lwork=_COLUMNS * n,
        lower=1,
        overwrite_a=1,
        overwrite_b=1,
    )
    if info:
        raise LinAlgError("the shift is an eigenvalue")
    below = 3 * negative_pivots(factor, pivots)
    del factor, deflated
    complement = _schur_complement(space, inverse)
    size = len(complement)
    complement, pivots, info = dsytrf(
        complement.T, lwork=_COLUMNS * size, lower=1, overwrite_a=1
    )
    if info:
        raise LinAlgError("the shift is an eigenvalue")
    below += negative_pivots(complement, pivots)
    return ShiftedInverse(below - n - RIGID_MOTIONS, space, inverse, complement, pivots)


def _schur_complement(space: TangentSpace, inverse: FloatArray) -> FloatArray:
    """Return the (n_b + 3 k, n_b + 3 k) matrix of edge tensions and Z."""
    n, k = space.affine.shape
    direction = space.direction
    result = np.empty((n + 3 * k, n + 3 * k))
    rows = space.differences(inverse)
    result[:n, :n] = space.differences(rows.T)
    result[:n, :n] *= -(direction @ direction.T)
    coupling = (rows @ space.affine)[:, :, None] * direction[:, None, :]
    result[:n, n:] = coupling.reshape(n, -1)
    result[n:, :n] = result[:n, n:].T
    compliance = space.affine.T @ inverse @ space.affine
    motions = space.motions.reshape(-1, RIGID_MOTIONS)
    strains = np.eye(3 * k) - motions @ motions.T
    result[n:, n:] = strains / _DEFLATION - np.kron(compliance, np.eye(3))
    return result
