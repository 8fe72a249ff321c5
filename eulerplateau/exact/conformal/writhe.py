"""The writhe of a smooth loop and its two derivatives.

How the writhe changes is local (Fuller 1978; Aldinger, Klapper and Tabor 1995):

    dWr = 1/(2 pi) oint det(x', dx', x'') / |x'|^3 dphi.

So modulo 2 it is an integral along the loop: with a fixed unit vector e, of which the
tangent t is nowhere the opposite,

    1 + Wr = 1/(2 pi) oint (e x t) . t' / (1 + e . t) dphi,

the area on the sphere that the tangent goes round, over 2 pi. The even number that is left
is seen along e: signed crossings, right-handed ones positive, less how often the tangent
turns round, plus 1. By the direction in which one looks both change together, but where e
is opposite to t.
"""

from __future__ import annotations

from itertools import product
from math import pi

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.conformal.basis import Basis, Curve
from eulerplateau.exact.conformal.energy import Blocks, gradient
from eulerplateau.exact.conformal.integrand_kernels import (
    crossings,
    tangent_area,
    writhe_second,
    writhe_slopes,
)

# Axes that are tried: through the corners, edges and faces of a cube.
_AXES = np.array([axis for axis in product((-1, 0, 1), repeat=3) if any(axis)])
_AXES = _AXES / np.linalg.norm(_AXES, axis=1)[:, None]
# Crossings are seen from beside an axis: along it those of half-turns lie on vertices.
_SEEN = _AXES + 0.01 * np.array([1.0, 1.3, 1.7])
# Coordinates (3, 3) each in which one looks along the last, right-handed.
_RIGHT = np.cross(np.eye(3)[np.abs(_SEEN).argmin(axis=1)], _SEEN)
_FRAMES = np.stack([_RIGHT, np.cross(_SEEN, _RIGHT), _SEEN], axis=2)


def smooth_writhe(curve: Curve) -> float:
    """Return Wr of a loop."""
    t = curve.x1 / np.sqrt(np.einsum("na,na->n", curve.x1, curve.x1))[:, None]
    which = (t @ _AXES.T).min(axis=0).argmax()
    seen = curve.x @ _FRAMES[which]
    even = crossings(seen) + 1 - _turns(seen[:, 0] + 1j * seen[:, 1])
    return tangent_area(curve.x1, curve.x2, _AXES[which]) - 1 + even


def _turns(seen: np.ndarray) -> int:
    """Return how often the edges of a polygon (n,) of complex numbers turn left."""
    edges = np.diff(seen, append=seen[:1])
    return round(float(np.angle(np.roll(edges, -1) / edges).sum()) / (2 * pi))


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
