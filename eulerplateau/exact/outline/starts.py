"""Where a fit begins: the film whose loop, moved, turned and scaled, is most alike."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from math import pi
from typing import Generic

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.outline.curves import C, Lobes, Racket
from eulerplateau.exact.planar import LOBES

# Loads over that of buckling at which films are held beside an outline.
_LOADS = (1.02, 1.15, 1.4, 1.75, 2.5, 3.5, 7.0, 20.0)
_NODES = 256
# Starts are tried whose misfit is at most this times the least, and so many.
_WORSE, _TRIED = 3.0, 3
# Points of an outline that is rid of its noise: means of its points.
_SMOOTH = 64


@dataclass(frozen=True)
class Start(Generic[C]):
    """Where a fit begins: unknowns (p,), and where on the curve (n,) the points lie."""

    curves: C
    unknowns: FloatArray
    near: FloatArray
    misfit: float


def lobed_starts(
    points: FloatArray, offset: float, numbers: Sequence[int]
) -> list[Start[Lobes]]:
    """Return the best start for each number of lobes, the best one first.

    `points` (n, 2) lie counter-clockwise around the loop, `offset` outwards of it.
    """
    share, resampled = _by_arc(points)
    centre = resampled.mean()
    around = resampled - centre
    found = [
        _placed(n, load, around, centre, share, offset) for n in numbers for load in _LOADS
    ]
    best: dict[Lobes, Start[Lobes]] = {}
    for start in sorted(found, key=_misfit):
        best.setdefault(start.curves, start)
    return list(best.values())


def _placed(
    n: int,
    load: float,
    around: FloatArray,
    centre: complex,
    share: FloatArray,
    offset: float,
) -> Start[Lobes]:
    """Return a film moved, turned and scaled: all shifts along it are tried at once."""
    curve = _loop(n, load)
    match = np.fft.ifft(np.fft.fft(around) * np.conj(np.fft.fft(curve)))
    shift = int(np.abs(match).argmax())
    own = float((np.abs(curve) ** 2).mean())
    scaled = complex(match[shift] / own / _NODES)
    misfit = float((np.abs(around) ** 2).mean() - abs(match[shift] / _NODES) ** 2 / own)
    curves = Lobes(n)
    # The offset curve's turning is 2 pi: it is longer by 2 pi times the offset.
    size = max(abs(scaled) - offset * 2 * pi, abs(scaled) / 2)
    amplitude = (load - 1) ** 0.5
    unknowns = [amplitude, np.log(size), centre.real, centre.imag, np.angle(scaled)]
    return Start(curves, np.array(unknowns), share - shift / _NODES, misfit)


@cache
def _loop(n: int, load: float) -> FloatArray:
    """Return the loop of a film as complex numbers (m,), evenly spaced."""
    film = Lobes(n).curve(np.array([(load - 1) ** 0.5]))
    x = film.points(np.arange(_NODES) / _NODES).x
    return np.asarray(x[:, 0] + 1j * x[:, 1])


def _by_arc(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the points' share of the arc length (n,), and evenly spaced ones, complex.

    Both by the line through means of successive points: noise lengthens one through all.
    """
    z = points[:, 0] + 1j * points[:, 1]
    groups = np.array_split(np.arange(len(z)), min(_SMOOTH, len(z)))
    smooth = np.array([z[group].mean() for group in groups])
    middles = np.array([group.mean() for group in groups])
    arc = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(smooth, append=smooth[0])))])
    closed = np.append(smooth, smooth[0])
    # Counted on round the loop, so that points before the first mean have a place.
    counted = np.append(middles, middles[0] + len(z))
    ahead = np.where(np.arange(len(z)) < middles[0], len(z), 0) + np.arange(len(z))
    share = np.interp(ahead, counted, arc) / arc[-1]
    even = np.arange(_NODES) / _NODES * arc[-1]
    return share, np.interp(even, arc, closed)


def racket_start(points: FloatArray) -> Start[Racket]:
    """Return where the fit of a racket's head begins, whose points run round its tip."""
    tail = (points[0] + points[-1]) / 2
    tip = points[np.argmax(((points - tail) ** 2).sum(axis=1))]
    axis = (tip - tail) / np.hypot(*(tip - tail))
    across = (points - tail) @ np.array([-axis[1], axis[0]])
    curves = Racket()
    head = curves.curve(np.empty(0)).points(np.linspace(-4.0, 4.0, 801)).x
    size = float(np.ptp(across) / np.ptp(head[:, 1]))
    steps = np.hypot(*np.diff(points, axis=0).T)
    arc = np.concatenate([[0.0], np.cumsum(steps)])
    near = (arc - arc[np.argmax((points - tail) @ axis)]) / size
    place = tip - axis * head[:, 0].max() * size
    angle = float(np.arctan2(axis[1], axis[0]))
    unknowns = np.array([np.log(size), *place, angle])
    return Start(curves, unknowns, near, 0.0)


def counter_clockwise(points: FloatArray) -> FloatArray:
    """Return the points (n, 2) in the order in which they run counter-clockwise."""
    x, y = points.T
    area = float(x @ np.roll(y, -1) - y @ np.roll(x, -1))
    return points if area > 0 else points[::-1]


def starts(points: FloatArray, offset: float, lobes: int | None) -> Iterator[Start[Lobes]]:
    """Yield where fits of films begin, of a given number of lobes or of the likeliest."""
    numbers = LOBES if lobes is None else (lobes,)
    found = lobed_starts(points, offset, numbers)
    rounds = sorted((round_start(n, points, offset) for n in numbers), key=_misfit)
    least = min(found[0].misfit, rounds[0].misfit)
    yield from (s for s in (*rounds[:1], *found[:_TRIED]) if s.misfit <= _WORSE * least)


def round_start(n: int, points: FloatArray, offset: float) -> Start[Lobes]:
    """Return n small lobes on a circle: a wave of the radius over the angle."""
    centre = points.mean(axis=0)
    for _ in range(2):
        x, y = (points - centre).T
        angle = np.arctan2(y, x)
        waves = [f(m * angle) for m in (1, n) for f in (np.cos, np.sin)]
        basis = np.stack([np.ones_like(x), *waves], axis=1)
        radius = np.hypot(x, y)
        found, *_ = np.linalg.lstsq(basis, radius, rcond=None)
        centre = centre + found[1:3]
    misfit = float(((radius - basis @ found) ** 2).mean())
    mean = abs(found[0])
    size = 2 * pi * max(mean - offset, mean / 2)
    wave = complex(found[3], -found[4])
    tip = float(np.angle(wave.conjugate())) / n
    amplitude = abs(wave) / size / _radius_by_amplitude(n)
    unknowns = np.array([amplitude, np.log(size), *centre, tip])
    return Start(Lobes(n), unknowns, (angle - tip) / (2 * pi) % 1.0, misfit)


def _misfit(start: Start[Lobes]) -> float:
    return start.misfit


@cache
def _radius_by_amplitude(n: int) -> float:
    """Return how the loop's radius at a lobe's tip grows with the amplitude."""
    return float(Lobes(n).slopes(np.zeros(1), np.zeros(1))[0, 0, 0])
