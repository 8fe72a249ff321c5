"""Motions of a loop that cost no energy: rigid ones, and its sliding along itself."""

from __future__ import annotations

import numpy as np
from numpy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.loop.loop import Loop

RIGID_MOTIONS = 6

# Row k is the matrix G_k with axis_k x r = r G_k.
TURNS = np.array(
    [
        [[0, 0, 0], [0, 0, 1], [0, -1, 0]],
        [[0, 0, -1], [0, 0, 0], [1, 0, 0]],
        [[0, 1, 0], [-1, 0, 0], [0, 0, 0]],
    ],
    dtype=np.float64,
)


def rigid_motions(x: FloatArray) -> FloatArray:
    """Return the translations and rotations of x (n, 3) as columns (3 n, 6).

    Of a plane loop (n, 2) the three in its plane (2 n, 3).
    """
    centred = x - x.mean(axis=0)
    if x.shape[1] == 2:
        turned = np.stack([-centred[:, 1], centred[:, 0]], axis=1)
        return np.column_stack([np.tile(np.eye(2), (len(x), 1)), turned.ravel()])
    motions = np.empty((len(x), 3, RIGID_MOTIONS))
    motions[:, :, :3] = np.eye(3)
    motions[:, :, 3:] = (centred @ TURNS).transpose(1, 2, 0)
    return motions.reshape(-1, RIGID_MOTIONS)


def sliding(loop: Loop, x: FloatArray) -> FloatArray | None:
    """Return the loop's sliding along itself (n, d), of unit size.

    None if that is rigid, or costs something: where the loop knows its pieces apart.

    A soap film does not know which piece of a uniform loop lies where: a loop that slides
    along its own curve changes nothing but how the vertices lie on it, which is to say the
    discretisation. That displacement is the tangent, made to keep all lengths (J p = 0) and
    orthogonal to rigid motions, both in the norm sum_v <s_v> |p_v|^2.

    Parameters
    ----------
    x : (n, d) float
        The loop's vertices, d = 2 in a plane or 3.

    Raises
    ------
    LinAlgError
        If an edge has no length.
    """
    if not all(term.slides for term in loop.terms.values()):
        return None
    motions = orthonormal_motions(loop, x)
    rigid = RIGID_MOTIONS if x.shape[1] == 3 else 3
    return motions[rigid] if len(motions) > rigid else None


def orthonormal_motions(loop: Loop, x: FloatArray) -> FloatArray:
    """Return rigid motions (m, n, d) and sliding, if that is not rigid, of a loop (n, d).

    They are orthonormal in the norm sum_v <s_v> |p_v|^2. Raises LinAlgError if an edge has
    no length.
    """
    from eulerplateau.loop.slide_kernels import fill_motions  # not for springs

    motions = np.empty((RIGID_MOTIONS + 1 if x.shape[1] == 3 else 4, *x.shape))
    directions = loop.chords(x) / loop.rest_lengths[:, None]
    found = fill_motions(x, directions, loop.mean_lengths, motions)
    if not found:
        raise LinAlgError("an edge of the loop has no length, or the loop no width")
    return motions[:found]


def free_motions(loop: Loop, x: FloatArray, slides: bool) -> FloatArray:
    """Return rigid motions, and sliding if it costs nothing either, as columns (d n, m)."""
    rigid = rigid_motions(x)
    slide = sliding(loop, x) if slides else None
    return rigid if slide is None else np.column_stack([rigid, slide.ravel()])


def remove_sliding(slide: FloatArray | None, loop: Loop, forces: FloatArray) -> FloatArray:
    """Return the forces (n, d) on a loop less their part that slides it along itself.

    Parameters
    ----------
    slide : (n, d) float, or None
        What `sliding` returns; None leaves the forces as they are.
    forces : (n, d) float
        Work per displacement of each vertex.
    """
    if slide is None:
        return forces
    share = float(np.sum(slide * forces))
    return forces - share * loop.mean_lengths[:, None] * slide
