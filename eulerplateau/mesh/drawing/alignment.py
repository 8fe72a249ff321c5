"""Turn shapes to lie alike: for one view of many prints, or to follow without a jump."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.mesh.shape import Shape

# Where the camera of the page stands at first: slanted, from the front, and not midway
# between y and z, where it would see one half of a saddle edge-on.
EYE = np.array([0.3, -0.45, 0.85])
# Half turns about the axes, as signs: what principal axes leave open without a mirror.
_HALF_TURNS = np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)])


def aligned(shapes: Sequence[Shape]) -> list[Shape]:
    """Return the shapes free of the rigid motion an equilibrium leaves undetermined.

    Each loop is centred at the origin, its longest principal axis along x and its
    shortest along z, and then turned by half a turn about an axis, or not, to lie as close
    to its predecessor as it can. (Turning it there all the way, as `settled` does and an
    animation must, would stand the flat eight on edge: the two halves of the film it comes
    from turn by a quarter each, in opposite senses.) The first loop has its normal along
    +z. A tie, which only symmetric films can have, falls either way.
    """
    turned: list[Shape] = []
    for shape in shapes:
        x = shape.x - shape.x[shape.loop].mean(axis=0)
        axes = np.linalg.svd(x[shape.loop], full_matrices=False)[2].T
        choices = [x @ (_right_handed(axes) * signs) for signs in _HALF_TURNS]
        if turned:
            before = turned[-1].x[shape.loop]
            away = [np.linalg.norm(choice[shape.loop] - before) for choice in choices]
        else:
            away = [-_area_vector(choice[shape.loop])[2] for choice in choices]
        turned.append(shape.moved(choices[int(np.argmin(away))]))
    return turned


def settled(x: FloatArray, before: Sequence[int | None], loop: IntArray) -> FloatArray:
    """Return shapes `x` (n, n_v, 3) free of rigid motions, each close to its predecessor.

    `before` numbers the predecessor of each shape, an earlier one, or None. A shape is
    centred and turned onto its predecessor, as near as it comes. Then all are turned
    alike: the longest of the principal axes of all of them together along x, the shortest
    along z, the front of the first film towards the viewer.

    That follows a film wherever it turns, but lets the flat eight stand upright: the two
    halves of the film it comes from turn by a quarter each, in opposite senses. Where one
    view must do for all, as in the renders, each shape's own principal axes serve better
    (`aligned`); but they swap, with a jump, where two of them are of one length.
    """
    moved = x - x.mean(axis=1, keepdims=True)
    for place, last in enumerate(before):
        if last is not None:
            moved[place] = moved[place] @ turn_onto(moved[last], moved[place])
    axes = np.linalg.eigh(np.einsum("sva,svb->ab", moved, moved))[1][:, ::-1]
    axes = _right_handed(axes)
    front = _area_vector(moved[0, loop]) @ axes
    signs = _HALF_TURNS[np.argmax(_HALF_TURNS @ (front * EYE))]
    turned: FloatArray = moved @ (axes * signs)
    return turned


def turn_onto(there: FloatArray, here: FloatArray) -> FloatArray:
    """Return the rotation R (3, 3), no mirror, that turns `here` onto `there` (n, 3) each.

    Of the distances between `here @ R` and `there` the squares' sum is the least (Kabsch
    1976). SciPy's takes longer to load than a picture to draw.
    """
    left, _, right = np.linalg.svd(here.T @ there)
    left[:, 2] *= np.sign(np.linalg.det(left @ right))
    turn: FloatArray = left @ right
    return turn


def _right_handed(axes: FloatArray) -> FloatArray:
    """Return axes, columns (3, 3), with the third such that they are no mirror."""
    first, second = axes[:, 0], axes[:, 1]
    return np.stack([first, second, np.cross(first, second)], axis=1)


def _area_vector(loop: FloatArray) -> FloatArray:
    """Return (3,) the area inside a loop (n_b, 3) times its normal."""
    area: FloatArray = 0.5 * np.cross(loop, np.roll(loop, -1, axis=0)).sum(axis=0)
    return area
