"""The writhe of a smooth loop, modulo 2, and its two derivatives.

How the writhe changes is local (Fuller 1978; Aldinger, Klapper and Tabor 1995):

    dWr = 1/(2 pi) oint det(x', dx', x'') / |x'|^3 dphi.

So modulo 2 it is an integral along the loop: with a fixed unit vector e, of which the
tangent t is nowhere the opposite,

    1 + Wr = 1/(2 pi) oint (e x t) . t' / (1 + e . t) dphi,

the area on the sphere that the tangent goes round, over 2 pi.
"""

from __future__ import annotations

from itertools import product
from math import pi

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.conformal.basis import Basis, Curve
from eulerplateau.exact.conformal.energy import Blocks, gradient
from eulerplateau.exact.conformal.integrand_kernels import writhe_second, writhe_slopes

# Axes that are tried: through the corners, edges and faces of a cube.
_AXES = np.array([axis for axis in product((-1, 0, 1), repeat=3) if any(axis)])
_AXES = _AXES / np.linalg.norm(_AXES, axis=1)[:, None]


def writhe_modulo_two(curve: Curve) -> float:
    """Return Wr of a loop, up to an even number."""
    u = (curve.x1**2).sum(axis=1)[:, None]
    t = curve.x1 / np.sqrt(u)
    bent = (curve.x2 - (curve.x2 * t).sum(axis=1)[:, None] * t) / np.sqrt(u)
    axis = _AXES[(t @ _AXES.T).min(axis=0).argmax()]
    rate = (np.cross(axis, t) * bent).sum(axis=1) / (1 + t @ axis)
    return float(rate.mean()) - 1


def writhe_gradient(basis: Basis, curve: Curve) -> FloatArray:
    """Return the gradient (size,) of the writhe, in the columns of `basis`."""
    return gradient(basis, writhe_slopes(*curve.first(basis.points)[1:]))


def writhe_hessian(basis: Basis, curve: Curve) -> FloatArray:
    """Return the Hessian (size, size) of the writhe, in the columns of `basis`.

    `basis` may have another symmetry than the loop: then this is the block of the
    displacements that have it.
    """
    return writhe_blocks(basis, curve).matrix(basis)


def writhe_blocks(basis: Basis, curve: Curve) -> Blocks:
    """Return the second derivative of what is integrated."""
    return Blocks(writhe_second(*curve.first(basis.points)[1:]))
