"""Motions of a conformal film that change nothing: rotations, and maps of the disk."""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.conformal.basis import Basis, Curve

# Relative singular value below which motions that change nothing coincide.
_SAME = 1e-6


def gauge_fields(basis: Basis, curve: Curve) -> FloatArray:
    """Return the displacements (n, 3, 6) of three rotations and three conformal maps."""
    x_theta = curve.x1 / basis.rate[:, None]
    turned = np.cross(np.eye(3)[:, None], curve.x)
    slid = slides(basis)[:, :, None] * x_theta
    return np.concatenate([turned, slid]).transpose(1, 2, 0)


def slides(basis: Basis) -> FloatArray:
    """Return by how much theta changes in the conformal maps: (3, n), 1, cos and sin."""
    theta = basis.theta
    return np.stack([np.ones(len(theta)), np.cos(theta), np.sin(theta)])


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
    whole = (2 / len(basis.phi)) * np.square(fields - fields.mean(axis=0)).sum(axis=(0, 1))
    sizes = np.square(inside).sum(axis=0)
    found = (inside / np.sqrt(sizes + 1e-300))[:, sizes > 0.5 * whole]
    if not found.size:
        return np.zeros((basis.size, 0))
    directions, sizes, _ = np.linalg.svd(found, full_matrices=False)
    return directions[:, sizes > _SAME * sizes[0]].astype(np.float64)
