"""Turn shapes so that they follow each other without a jump."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray

# Where the camera stands at first: slanted, from the front, and not midway between y and
# z, where it would see one half of a saddle edge-on.
EYE = np.array([0.3, -0.45, 0.85])


def settled(x: FloatArray, before: Sequence[int | None], loop: IntArray) -> FloatArray:
    """Return shapes `x` (n, n_v, 3) free of rigid motions, each close to its predecessor.

    `before` numbers the predecessor of each shape, an earlier one, or None. A shape is
    centred and turned to the least distance from its predecessor, summed over the
    vertices' squares (Kabsch 1976), never mirrored. Then all are turned alike: the
    longest of the principal axes of all of them together along x, the shortest along z,
    the front of the first film towards the viewer.

    That follows a film wherever it turns, but lets the flat eight stand upright: the two
    halves of the film it comes from turn by a quarter each, in opposite senses. Where one
    view must do for all, as in the renders, each shape's own principal axes serve better;
    but they swap, with a jump, where two of them are of one length.
    """
    moved = x - x.mean(axis=1, keepdims=True)
    for place, last in enumerate(before):
        if last is not None:
            moved[place] = moved[place] @ _rotation_onto(moved[place], moved[last])
    axes = np.linalg.eigh(np.einsum("sva,svb->ab", moved, moved))[1][:, ::-1]
    axes[:, 2] = np.cross(axes[:, 0], axes[:, 1])
    first = moved[0, loop]
    front = np.cross(first, np.roll(first, -1, axis=0)).sum(axis=0) @ axes
    signs = np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)])
    turned: FloatArray = moved @ (axes * signs[np.argmax(signs @ (front * EYE))])
    return turned


def _rotation_onto(x: FloatArray, target: FloatArray) -> FloatArray:
    """Return the rotation R (3, 3) for which `x` @ R is closest to `target`."""
    left, _, right = np.linalg.svd(x.T @ target)
    # Between planar shapes the smallest singular value is 0, and only this decides.
    left[:, 2] *= np.sign(np.linalg.det(left @ right))
    rotation: FloatArray = left @ right
    return rotation
