"""Motions of a conformal film that change nothing: rotations, and maps of the disk."""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import BoolArray, FloatArray
from eulerplateau.exact.conformal.basis import Basis, Curve

# Relative singular value below which motions that change nothing coincide.
_SAME = 1e-6


def gauge_fields(basis: Basis, curve: Curve) -> FloatArray:
    """Return the displacements (n, 3, m) of three rotations and the conformal maps."""
    x_theta = curve.x1 / basis.rate[:, None]
    turned = np.cross(np.eye(3)[:, None], curve.x)
    slid = basis.slides[:, :, None] * x_theta
    return np.concatenate([turned, slid]).transpose(1, 2, 0)


def gauge_modes(basis: Basis, curve: Curve) -> FloatArray:
    """Return orthonormal motions (size, m) that change no energy and keep the symmetry.

    Of the rotations and the conformal maps of the disk onto itself (x_theta times 1,
    cos theta, sin theta), those that have the symmetry of `basis`, which need not be the
    curve's: each has it or is orthogonal to it. Two coincide for the disk.
    """
    if basis.keeps_half_turns:  # which none of them does
        return np.zeros((basis.size, 0))
    fields = gauge_fields(basis, curve)
    inside = basis.project(fields)
    kept = kept_fields(basis, fields, inside)
    return independent(inside[:, kept])


def kept_fields(basis: Basis, fields: FloatArray, inside: FloatArray) -> BoolArray:
    """Return which of fields (n, 3, m) have the symmetry: their coefficients say so."""
    share = basis.spacing[:, None, None] / len(basis.phi)
    off = fields - (share * fields).sum(axis=0)
    whole = 2 * (share * off**2).sum(axis=(0, 1))
    kept: BoolArray = np.square(inside).sum(axis=0) > 0.5 * whole
    return kept


def independent(motions: FloatArray) -> FloatArray:
    """Return orthonormal motions (size, l) that span those given (size, m)."""
    if not motions.size:
        return np.zeros((len(motions), 0))
    sizes = np.sqrt(np.square(motions).sum(axis=0) + 1e-300)
    directions, sizes, _ = np.linalg.svd(motions / sizes, full_matrices=False)
    return directions[:, sizes > _SAME * sizes[0]].astype(np.float64)
