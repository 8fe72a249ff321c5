"""The initial polygons: corners (n, 2), counter-clockwise, in the polygon's own units."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from eulerplateau.arrays import BoolArray, FloatArray

# Two sides of a polygon of size 1 that come closer than this are taken to touch.
_TOUCHING = 1e-12


def regular(sides: int) -> FloatArray:
    """Return the regular polygon of circumradius 1 with a corner on the x axis."""
    angle = 2 * np.pi * np.arange(sides) / sides
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def stretched_hexagon(factor: float) -> FloatArray:
    """Return the regular hexagon stretched by `factor` along the corner axis x."""
    return regular(6) * (factor, 1.0)


def lengthened_hexagon(half_length: float) -> FloatArray:
    """Return the hexagon with 120 degree corners, (+-a, 0) and (+-(a - 1/sqrt 3), +-1)."""
    a, b = half_length, half_length - 1 / np.sqrt(3)
    return np.array([[a, 0], [b, 1], [-b, 1], [-a, 0], [-b, -1], [b, -1]])


def ellipse(aspect: float, sides: int) -> FloatArray:
    """Return `sides` points at equal arc length on the ellipse of semi-axes `aspect`, 1."""
    # Slow to load, and only ellipses need it.
    from scipy.special import ellipe, ellipeinc

    m = 1 - 1 / aspect**2
    quarter = ellipe(m)
    # Arc length is aspect E(t | m) with t = theta - pi/2. Bisection, because Newton
    # overshoots at the tips of a long ellipse.
    target = quarter * (4 * np.arange(sides) / sides - 1)
    low = np.full(sides, -np.pi / 2)
    high = np.full(sides, 3 * np.pi / 2)
    for _ in range(60):
        middle = (low + high) / 2
        short = ellipeinc(middle, m) < target
        low, high = np.where(short, middle, low), np.where(short, high, middle)
    theta = (low + high) / 2 + np.pi / 2
    return np.stack([aspect * np.cos(theta), np.sin(theta)], axis=1)


def ellipse_perimeter(aspect: float) -> float:
    """Return the arc length of the ellipse of semi-axes `aspect` and 1."""
    from scipy.special import ellipe

    return 4 * aspect * float(ellipe(1 - 1 / aspect**2))


def counter_clockwise(corners: ArrayLike) -> FloatArray:
    """Return `corners` (n, 2) counter-clockwise, the first corner first.

    Raises ValueError saying which corners or sides keep them from bounding a region.
    """
    given = np.asarray(corners, dtype=np.float64)
    if len(given) < 3:
        raise ValueError(f"a polygon needs at least 3 corners, here are {len(given)}")
    unit = to_unit_scale(given)[0]
    gaps = _distances(unit)
    if (first := _first_pair(gaps <= _TOUCHING)) is not None:
        raise ValueError(f"corners {first[0]} and {first[1]} are the same point")
    if (first := _first_pair(_crossings(unit))) is not None:
        raise ValueError(
            f"the side from corner {first[0]} meets the side from corner {first[1]}: "
            "a polygon must not cross or touch itself"
        )
    return given if polygon_area(unit) > 0 else np.roll(given[::-1], 1, axis=0)


def polygon_area(corners: FloatArray) -> float:
    """Return the enclosed area, positive if `corners` (n, 2) run counter-clockwise.

    Taken about their mean, so that a place far from the origin costs no digits.
    """
    y = corners - corners.mean(axis=0)
    after = np.roll(y, -1, axis=0)
    return 0.5 * float((y[:, 0] * after[:, 1] - y[:, 1] * after[:, 0]).sum())


def polygon_gradient(x: FloatArray) -> FloatArray:
    """Return the gradient (n, 2) of the area: half the chord across, turned outwards."""
    chord = np.roll(x, -1, axis=0) - np.roll(x, 1, axis=0)
    return 0.5 * np.column_stack([chord[:, 1], -chord[:, 0]])


def perimeter(corners: FloatArray) -> float:
    """Return the length of the closed polygon `corners` (n, 2)."""
    return float(np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1).sum())


def to_unit_scale(points: FloatArray) -> tuple[FloatArray, float]:
    """Return `points` about their mean in units of the largest distance, and that unit."""
    magnitude = float(np.abs(points).max()) or 1.0
    centred = points / magnitude
    centred = centred - centred.mean(axis=0)
    size = float(np.linalg.norm(centred, axis=1).max()) or 1.0
    return centred / size, size * magnitude


def subdivide(corners: FloatArray, edge_length: float) -> FloatArray:
    """Return the loop's vertices (n_b, 2): every side in equal parts near `edge_length`."""
    sides = np.roll(corners, -1, axis=0) - corners
    # A hair below one half, so that sides of equal length are divided alike.
    wanted = np.linalg.norm(sides, axis=1) / edge_length * (1 - 1e-9)
    parts = np.maximum(np.rint(wanted), 1).astype(np.int64)
    side = np.repeat(np.arange(len(corners)), parts)
    step = np.arange(len(side)) - np.repeat(np.cumsum(parts) - parts, parts)
    loop: FloatArray = corners[side] + sides[side] * (step / parts[side])[:, None]
    return loop


def _distances(points: FloatArray) -> FloatArray:
    gaps: FloatArray = np.linalg.norm(points[:, None] - points[None], axis=2)
    np.fill_diagonal(gaps, np.inf)
    return gaps


def _crossings(corners: FloatArray) -> BoolArray:
    """Return (n, n): whether sides i and j meet anywhere but in a corner they share."""
    chord = np.roll(corners, -1, axis=0) - corners
    length = np.linalg.norm(chord, axis=1)
    along = chord / length[:, None]
    across = along[:, ::-1] * (-1.0, 1.0)
    # Corner j in the frame of side i: distance along it from corner i, and to its left.
    offset = corners[None] - corners[:, None]
    ahead = np.einsum("ijk,ik->ij", offset, along)
    left = np.einsum("ijk,ik->ij", offset, across)
    one_side = _outside(left, np.zeros_like(left))
    beyond = _outside(ahead, np.broadcast_to(length[:, None], ahead.shape))
    apart = one_side | beyond
    meets = ~(apart | apart.T)
    # Neighbours always share a corner: they cross only by folding back on each other.
    this = np.arange(len(corners))
    following = np.roll(this, -1)
    after = np.roll(this, -2)
    folded = (ahead[this, after] < length) & (np.abs(left[this, after]) <= _TOUCHING)
    meets[this, this] = False
    meets[this, following] = meets[following, this] = folded
    return meets


def _outside(place: FloatArray, upper: FloatArray) -> BoolArray:
    """Return (n, n): whether both ends of side j lie below 0, or both above `upper`."""
    other = np.roll(place, -1, axis=1)
    below = np.maximum(place, other) < -_TOUCHING
    return below | (np.minimum(place, other) > upper + _TOUCHING)


def _first_pair(wrong: BoolArray) -> list[int] | None:
    pairs = np.argwhere(np.triu(wrong | wrong.T, 1))
    return [int(place) for place in pairs[0]] if len(pairs) else None
