"""Where two strands of a smooth loop are closest, compiled. Arrays in, arrays out.

A loop gamma is a periodic piecewise cubic: `pieces` (n, 4, d) of its edges, the cube's
coefficient first, in s less the edge's first of `knots` (n + 1,). With r = gamma(s) -
gamma(t) what is least is f = r.r / 2, whose derivatives are r.gamma'(s), -r.gamma'(t) and

    f_ss = gamma'(s)^2 + r.gamma''(s),  f_tt = gamma'(t)^2 - r.gamma''(t),
    f_st = -gamma'(s).gamma'(t).

Helpers stay in this file (numba #1833).
"""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import BoolArray, FloatArray
from eulerplateau.compiling import njit

# Newton's steps from a guess, the last one's length in parts of the loop, that of one which
# is not asked whether it goes downhill, and by how much the second derivative is positive.
_STEPS = 60
_SETTLED = 1e-14
_TINY = 1e-9
_CURVED = 1e-10
# An edge's curve leaves its chord by a fraction of its length.
_SLACK = 1.2
# Minima nearer to each other, in parts of the loop, are the same.
_SAME = 1e-7


@njit(cache=True)
def place(pieces: FloatArray, knots: FloatArray, s: float, out: FloatArray) -> None:
    """Write gamma, gamma', gamma'' at s to `out` (3, d); s is taken round the loop."""
    n, d = knots.shape[0] - 1, pieces.shape[2]
    whole = float(knots[n])
    s = s - whole * np.floor(s / whole)
    e, beyond = 0, n
    while beyond - e > 1:
        middle = (e + beyond) // 2
        if knots[middle] <= s:
            e = middle
        else:
            beyond = middle
    u = s - knots[e]
    for k in range(d):
        a, b, c = pieces[e, 0, k], pieces[e, 1, k], pieces[e, 2, k]
        out[0, k] = ((a * u + b) * u + c) * u + pieces[e, 3, k]
        out[1, k] = (3.0 * a * u + 2.0 * b) * u + c
        out[2, k] = 6.0 * a * u + 2.0 * b


@njit(cache=True)
def _looked_at(
    pieces: FloatArray, knots: FloatArray, s: float, t: float, here: FloatArray
) -> tuple[float, float, float, float, float, float]:
    """Return f, f_s, f_t, f_ss, f_st, f_tt at two places; into `here` (2, 3, d) too."""
    place(pieces, knots, s, here[0])
    place(pieces, knots, t, here[1])
    p, q = here[0], here[1]
    f, fs, ft, fss, fst, ftt = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(p.shape[1]):
        r = p[0, k] - q[0, k]
        f += 0.5 * r * r
        fs += r * p[1, k]
        ft -= r * q[1, k]
        fss += p[1, k] * p[1, k] + r * p[2, k]
        fst -= p[1, k] * q[1, k]
        ftt += q[1, k] * q[1, k] - r * q[2, k]
    return f, fs, ft, fss, fst, ftt


@njit(cache=True)
def _downhill(
    fs: float, ft: float, fss: float, fst: float, ftt: float, slides: bool
) -> tuple[float, float]:
    """Return Newton's step, of a second derivative that is made positive."""
    least = _CURVED * (abs(fss) + abs(ftt))
    if not slides:
        return 0.0, -ft / max(abs(ftt), least)
    lowest = 0.5 * (fss + ftt) - np.sqrt(0.25 * (fss - ftt) ** 2 + fst * fst)
    lift = max(0.0, least - lowest)
    a, b = fss + lift, ftt + lift
    determinant = a * b - fst * fst
    return -(b * fs - fst * ft) / determinant, -(a * ft - fst * fs) / determinant


@njit(cache=True)
def settle(
    pieces: FloatArray, knots: FloatArray, s: float, t: float, slides: bool
) -> tuple[float, float, float, float]:
    """Return where the distance is least near (s, t), it, and how it grows from there.

    Newton's method, its steps at most two edges long and downhill; s stays where it is
    unless it `slides`. What grows is D(s), the least distance by t: returned is d2D/ds2.
    """
    here = np.empty((2, 3, pieces.shape[2]))
    whole = float(knots[-1])
    longest, tiny = 2.0 * whole / len(pieces), _TINY * whole
    f, fs, ft, fss, fst, ftt = _looked_at(pieces, knots, s, t, here)
    for _ in range(_STEPS):
        ds, dt = _downhill(fs, ft, fss, fst, ftt, slides)
        size = max(abs(ds), abs(dt))
        if size > longest:
            ds, dt, size = ds * longest / size, dt * longest / size, longest
        # Where rounding hides whether it falls, the last step is taken all the same.
        while size > tiny and not _looked_at(pieces, knots, s + ds, t + dt, here)[0] < f:
            ds, dt, size = 0.5 * ds, 0.5 * dt, 0.5 * size
        s, t = s + ds, t + dt
        f, fs, ft, fss, fst, ftt = _looked_at(pieces, knots, s, t, here)
        if size < _SETTLED * whole:
            break
    distance = np.sqrt(2.0 * f)
    if distance == 0.0 or ftt <= 0.0:
        return s, t, distance, -np.inf
    return s, t, distance, (fss - fst * fst / ftt) / distance


@njit(cache=True)
def _apart(s: float, t: float, whole: float) -> float:
    """Return the length of loop between two places, the shorter way."""
    along = abs(s - t) % whole
    return min(along, whole - along)


@njit(cache=True)
def _closest_on_chords(x: FloatArray, i: int, j: int) -> tuple[float, float, float]:
    """Return where the chords i and j are closest, in parts of each, and the distance."""
    n = x.shape[0]
    i, j = i % n, j % n
    i1, j1 = (i + 1) % n, (j + 1) % n
    uu, uv, vv, uw, vw, ww = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(x.shape[1]):
        u, v, w = x[i1, k] - x[i, k], x[j1, k] - x[j, k], x[i, k] - x[j, k]
        uu, uv, vv = uu + u * u, uv + u * v, vv + v * v
        uw, vw, ww = uw + u * w, vw + v * w, ww + w * w
    determinant = uu * vv - uv * uv
    a = 0.5
    if determinant > 1e-12 * uu * vv:
        a = min(max((uv * vw - vv * uw) / determinant, 0.0), 1.0)
    b = min(max((uv * a + vw) / vv, 0.0), 1.0)
    a = min(max((uv * b - uw) / uu, 0.0), 1.0)
    square = ww + 2 * a * uw - 2 * b * vw + a * a * uu - 2 * a * b * uv + b * b * vv
    return a, b, np.sqrt(max(square, 0.0))


@njit(cache=True)
def _nearest_nearby(x: FloatArray, i: int, j: int, distance: float, most: float) -> bool:
    """Whether no pair of edges next to i and j is nearer than that by more than `most`."""
    for k in range(-1, 2, 2):
        if _closest_on_chords(x, i + k, j)[2] < distance - most:
            return False
        if _closest_on_chords(x, i, j + k)[2] < distance - most:
            return False
    return True


@njit(cache=True)
def _may_touch(
    x: FloatArray, knots: FloatArray, i: int, j: int, reach: float, apart: float
) -> bool:
    """Whether edges i < j may come within reach, by their middles, far enough along."""
    n = x.shape[0]
    if knots[j + 1] - knots[i] < apart or knots[n] - knots[j] + knots[i + 1] < apart:
        return False
    i1, j1 = i + 1, (j + 1) % n
    square = 0.0
    for k in range(x.shape[1]):
        square += 0.25 * (x[i, k] + x[i1, k] - x[j, k] - x[j1, k]) ** 2
    lengths = knots[i1] - knots[i] + knots[j + 1] - knots[j]
    return bool(square < (reach + 0.5 * _SLACK * lengths) ** 2)


@njit(cache=True)
def _nearest_on_chord(x: FloatArray, point: FloatArray, j: int) -> float:
    """Return where the line of chord j is nearest to a point (d,), in parts of it."""
    j1 = (j + 1) % x.shape[0]
    along, square = 0.0, 0.0
    for k in range(x.shape[1]):
        v = x[j1, k] - x[j, k]
        along += v * (point[k] - x[j, k])
        square += v * v
    return along / square


@njit(cache=True)
def _is_listed(found: FloatArray, count: int, s: float, t: float, whole: float) -> bool:
    """Whether a pair of places is among the first rows of those that were found."""
    for m in range(min(count, len(found))):
        off = max(_apart(s, found[m, 0], whole), _apart(t, found[m, 1], whole))
        if off < _SAME * whole:
            return True
    return False


@njit(cache=True)
def nearest_pairs(
    x: FloatArray,
    pieces: FloatArray,
    knots: FloatArray,
    reach: float,
    apart: float,
    sagging: float,
    found: FloatArray,
) -> int:
    """Find the local minima of the distance below reach; return how many there are.

    Of places at least `apart` from each other along the loop: to rows of `found` (m, 4) go
    s, t, D, d2D/ds2, s < t, as far as there is room. x : (n, d), the vertices; all pairs of
    edges are looked at. Chords may be nearer by `sagging` than their curves are.
    """
    n = x.shape[0]
    whole = float(knots[n])
    count = 0
    for i in range(n):
        for j in range(i + 2, n):
            if not _may_touch(x, knots, i, j, reach, apart):
                continue
            a, b, distance = _closest_on_chords(x, i, j)
            if not _nearest_nearby(x, i, j, distance, sagging):
                continue
            s = float(knots[i] + a * (knots[i + 1] - knots[i]))
            t = float(knots[j] + b * (knots[j + 1] - knots[j]))
            s, t, distance, grows = settle(pieces, knots, s, t, True)
            if not distance < reach or _apart(s, t, whole) < apart:
                continue
            s, t = s - whole * np.floor(s / whole), t - whole * np.floor(t / whole)
            s, t = min(s, t), max(s, t)
            # Where the loop begins rounding decides which of two places comes first.
            if _is_listed(found, count, s, t, whole) or _is_listed(
                found, count, t, s, whole
            ):
                continue
            if count < len(found):
                found[count, 0], found[count, 1] = s, t
                found[count, 2], found[count, 3] = distance, grows
            count += 1
    return count


@njit(cache=True)
def nearest_to_places(
    x: FloatArray,
    pieces: FloatArray,
    knots: FloatArray,
    offsets: FloatArray,
    reach: float,
    apart: float,
    found: FloatArray,
) -> int:
    """Find where other strands are closest to places; return how many there are.

    There is a place s on every edge, in parts of it at `offsets` (n,). To rows of `found`
    (m, 6) go s, t, D, s', t', d2D/ds2, D below reach; at (s', t') near by the
    distance is least by both, and d2D/ds2 is that there.
    """
    n, d = x.shape
    whole = float(knots[n])
    here = np.empty((3, d))
    count = 0
    for i in range(n):
        start = float(knots[i] + offsets[i] * (knots[i + 1] - knots[i]))
        place(pieces, knots, start, here)
        for j in range(n):
            if not _may_touch(x, knots, min(i, j), max(i, j), reach, apart):
                continue
            b = _nearest_on_chord(x, here[0], j)
            if b < -_SLACK or b > 1.0 + _SLACK:
                continue
            guess = float(knots[j] + b * (knots[j + 1] - knots[j]))
            s, t, distance, _ = settle(pieces, knots, start, guess, False)
            t = t - whole * np.floor(t / whole)
            if not distance < reach or _apart(s, t, whole) < apart:
                continue
            if _is_listed(found, count, s, t, whole):
                continue
            a, b, _, grows = settle(pieces, knots, s, t, True)
            if _apart(a, b, whole) < apart:
                grows = -np.inf
            if count < len(found):
                found[count, 0], found[count, 1], found[count, 2] = s, t, distance
                found[count, 3], found[count, 4], found[count, 5] = a, b, grows
            count += 1
    return count


@njit(cache=True)
def settle_each(
    pieces: FloatArray, knots: FloatArray, s: FloatArray, t: FloatArray, slides: BoolArray
) -> FloatArray:
    """Return `settle` of each of k pairs: rows s, t, D, d2D/ds2 (k, 4)."""
    found = np.empty((s.shape[0], 4))
    for k in range(s.shape[0]):
        a, b, distance, grows = settle(pieces, knots, s[k], t[k], slides[k])
        found[k, 0], found[k, 1], found[k, 2], found[k, 3] = a, b, distance, grows
    return found
