"""Which mirrors and half turns a loop has, and which of them a mode breaks.

The operations are those of a rectangular box along the loop's principal axes: mirrors
across, half turns about, and inversion through the centre. A loop has an operation if the
operation, together with a shift or reversal of the vertex numbers, brings it back onto
itself. An unstructured mesh is symmetric only nearly (its plane apart), hence a tolerance.

A loop in the plane (n, 2) counts as flat in space. Where two extents are equal, as those of
a regular triangle are, the axes in their plane are any, and nothing is said of them. A
round loop has all turns besides, of which every mode breaks some.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray

# Axes are those of the loop's largest, middle and smallest extent.
OPERATIONS = {
    "mirror across long axis": (-1, 1, 1),
    "mirror across middle axis": (1, -1, 1),
    "mirror across short axis": (1, 1, -1),
    "half turn about long axis": (1, -1, -1),
    "half turn about middle axis": (-1, 1, -1),
    "half turn about short axis": (-1, -1, 1),
    "inversion": (-1, -1, -1),
}
# Those that a loop of one handedness can have.
_TURNS = {name for name, signs in OPERATIONS.items() if np.prod(signs) > 0}

# What a circle has besides, about the axis across its plane.
ROUND = "any turn about short axis"

# Root-mean-square mismatch, in units of L: half an edge of the paper's mesh.
_SAME_SHAPE = 7e-3
# Extents (root mean square, in units of L) that are as equal as meshes leave them.
_SAME_EXTENT = 1e-3


@dataclass(frozen=True)
class ModeSymmetry:
    """What a mode does to a loop's symmetries, and how much of it leaves the plane.

    Attributes
    ----------
    breaks, keeps : names in OPERATIONS under which the mode is odd, or even
        Of a round loop ROUND is broken too.
    transverse : float
        Fraction of the mode's square norm along the loop's shortest axis.
    """

    breaks: tuple[str, ...]
    keeps: tuple[str, ...]
    transverse: float


def mode_symmetry(
    x_loop: FloatArray, mode: FloatArray, *, mirrors: bool = True
) -> ModeSymmetry:
    """Classify a displacement `mode` (n, d) of the loop (n, d), d = 3, or 2 in a plane.

    Without `mirrors` what reverses handedness counts as no operation.
    """
    shape, axes = _along_axes(x_loop)
    moved = in_space(mode) @ axes.T
    breaks: list[str] = []
    keeps: list[str] = []
    alike = _alike(shape)
    for name, numbering in _own_operations(shape, _SAME_SHAPE).items():
        told = len(set(np.array(OPERATIONS[name])[alike])) < 2
        if not (told and (mirrors or name in _TURNS)):
            continue
        turned = (moved * np.array(OPERATIONS[name]))[numbering]
        parity = float(np.sum(turned * moved) / np.sum(moved * moved))
        if abs(parity) > 0.5:
            (keeps if parity > 0 else breaks).append(name)
    if _is_round(shape):
        breaks.append(ROUND)
    transverse = float(np.sum(moved[:, 2] ** 2) / np.sum(moved**2))
    return ModeSymmetry(tuple(breaks), tuple(keeps), transverse)


def _alike(shape: FloatArray) -> list[int]:
    """Return which of the axes of a loop along them (n, 3) have the extent of another."""
    extents = np.sqrt(np.mean(shape**2, axis=0))
    pairs = [(i, i + 1) for i in (0, 1) if extents[i] - extents[i + 1] < _SAME_EXTENT]
    return sorted({axis for pair in pairs for axis in pair})


def _is_round(shape: FloatArray) -> bool:
    """Return whether a loop along its axes (n, 3) is a circle."""
    radii = np.linalg.norm(shape[:, :2], axis=1)
    return float(np.hypot(radii.std(), np.sqrt(np.mean(shape[:, 2] ** 2)))) < _SAME_EXTENT


def loop_symmetries(x_loop: FloatArray, within: float) -> tuple[str, ...]:
    """Return the names in OPERATIONS of those that bring a loop (n, d) back onto itself.

    within : float, the r.m.s. distance, in units of L, up to which they do
    """
    return tuple(_own_operations(_along_axes(x_loop)[0], within))


def _along_axes(x_loop: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return a loop (n, 3) by its principal axes, and these, the rows of (3, 3)."""
    centred = in_space(x_loop - x_loop.mean(axis=0))
    axes = np.linalg.svd(centred, full_matrices=False)[2]
    return centred @ axes.T, axes


def _own_operations(shape: FloatArray, within: float) -> dict[str, IntArray]:
    """Return the operations of a loop along its axes (n, 3), each with a renumbering."""
    every = numberings(len(shape))
    own = {}
    for name, signs in OPERATIONS.items():
        image = shape * np.array(signs)
        offsets = np.linalg.norm(image[every] - shape, axis=(1, 2))
        best = int(offsets.argmin())
        if offsets[best] <= within * np.sqrt(len(shape)):
            own[name] = every[best]
    return own


def in_space(rows: FloatArray) -> FloatArray:
    """Return vectors (n, d) in space (n, 3)."""
    return np.pad(rows, ((0, 0), (0, 3 - rows.shape[1])))


def numberings(n: int) -> IntArray:
    """Return all 2 n cyclic shifts and reversals of 0 ... n - 1, one per row."""
    v = np.arange(n)
    shifts = (v[None, :] + v[:, None]) % n
    return np.concatenate([shifts, shifts[:, ::-1]])


def loop_distance(x_loop: FloatArray, other: FloatArray) -> float:
    """Return the r.m.s. distance of two loops (n, d) after the best rotation."""
    a, b = x_loop - x_loop.mean(axis=0), other - other.mean(axis=0)
    u, _, vt = np.linalg.svd(a.T @ b)
    handed = np.ones(len(u))
    handed[-1] = np.sign(np.linalg.det(u @ vt))
    aligned = a @ (u * handed) @ vt
    return float(np.sqrt(np.mean(np.sum((aligned - b) ** 2, axis=1))))
