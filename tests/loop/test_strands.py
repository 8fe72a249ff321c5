"""Gaps between strands of a loop: against brute force, Taylor slopes, invariances."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import minimize

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import Gaps, HeldGaps, Lengths, Loop, Strands, strands_of

DIAMETER = 0.04
# Places on a loop that are compared with each other.
SAMPLE = 600


def curve(seed: int, places: FloatArray, d: int = 3) -> FloatArray:
    """Points (n, d) of a random smooth closed curve of unit length, at parts of it.

    In the plane, where strands that cross have no least distance, a waist about 0.05 wide.
    """
    rng = np.random.default_rng(seed)
    k = np.arange(1, 6)
    waves = rng.standard_normal((2, len(k), d)) / k[:, None]

    def at(phase: FloatArray) -> FloatArray:
        cosines, sines = np.cos(np.outer(phase, k)), np.sin(np.outer(phase, k))
        tangle = cosines @ waves[0] + sines @ waves[1]
        if d == 3:
            return tangle
        waist = np.sin(phase) * (0.15 + 0.6 * np.cos(phase) ** 2)
        return np.stack([np.cos(phase), waist], axis=1) + 0.01 * tangle

    phase = np.linspace(0, 2 * np.pi, 20001)
    fine = at(phase)
    arc = np.cumsum(np.linalg.norm(np.diff(fine, axis=0, prepend=fine[:1]), axis=1))
    return at(np.interp(places % 1.0, arc / arc[-1], phase)) / arc[-1]


def tangle(seed: int, n: int = 120, d: int = 3, shift: float = 0.0) -> FloatArray:
    return curve(seed, (np.arange(n) + shift) / n, d)


def strands_on(x: FloatArray, diameter: float = DIAMETER) -> Strands:
    edges = np.linalg.norm(np.roll(x, -1, axis=0) - x, axis=1)
    return strands_of(Loop(edges, diameter=diameter))


def brute(strands: Strands, x: FloatArray, reach: float) -> FloatArray:
    """Local minima (k, 3) of the distance below reach: s, t, gap.

    Those of a fine sample, each followed downhill by SciPy.
    """
    whole, curve = strands.knots[-1], strands.curve(x)
    s = np.arange(SAMPLE) / SAMPLE * whole
    distance = np.linalg.norm(curve(s)[:, None] - curve(s), axis=2)
    moves = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j]
    least = np.all([distance <= np.roll(distance, m, (0, 1)) for m in moves], axis=0)
    i, j = np.nonzero(np.triu(least & (distance < strands.diameter + 1.2 * reach), 1))

    def square(place: FloatArray) -> float:
        return float(((curve(place[0]) - curve(place[1])) ** 2).sum())

    def downhill(place: FloatArray) -> FloatArray:
        corners = place + np.array([[0, 0], [1, 0], [0, 1]]) * whole / SAMPLE
        options = {"fatol": 1e-16, "xatol": 1e-9, "initial_simplex": corners}
        return minimize(square, place, method="Nelder-Mead", options=options).x

    ends = [downhill(place) for place in np.column_stack([s[i], s[j]])]
    places = np.array(ends).reshape(-1, 2) % whole
    off = np.abs(places[:, 0] - places[:, 1])
    places = places[np.minimum(off, whole - off) > strands.apart]
    widths = np.array([np.sqrt(square(p)) for p in places]) - strands.diameter
    return np.column_stack([np.sort(places, axis=1), widths])[widths < reach]


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("d", [2, 3])
def test_no_pair_of_strands_is_missed_and_none_is_invented(seed: int, d: int) -> None:
    x = tangle(seed, d=d)
    strands = strands_on(x)
    gaps, widths = strands.near(x, 0.02)
    points = np.column_stack([gaps.s, gaps.t, widths])[gaps.slides]
    sampled = brute(strands, x, 0.02)
    for one, others in ((points, sampled), (sampled, points)):
        off = np.abs(one[:, None] - others).max(axis=2)
        assert off.min(axis=1, initial=np.inf).max(initial=0.0) < 1e-6


def test_a_rod_s_own_bend_is_no_contact() -> None:
    """Two places are as near as a half circle lets them: pi d / 2 along the loop."""
    x = tangle(0, d=2)
    s, t = brute(strands_on(x), x, 0.03)[0, :2]
    along = min(t - s, 1 - (t - s))
    for part, count in ((0.99, 1), (1.01, 0)):
        thick = strands_on(x, part * 2 * along / np.pi)
        assert len(thick.near(x, 0.0)[0]) == count


def held(strands: Strands, x: FloatArray, slides: bool) -> Gaps:
    """Gaps of one kind, at all places where strands cross."""
    gaps, widths = strands.near(x, 0.03)
    gaps = gaps[gaps.slides & (widths > -0.5 * DIAMETER)]
    assert len(gaps)
    return strands.at(x, replace(gaps, slides=np.full(len(gaps), slides)))[0]


@pytest.mark.parametrize("slides", [True, False])
@pytest.mark.parametrize("seed", [1, 3])
@pytest.mark.parametrize("d", [2, 3])
def test_slopes_of_gaps_are_2_and_3(seed: int, d: int, slides: bool) -> None:
    x = tangle(seed, d=d)
    strands = strands_on(x)
    gaps = held(strands, x, slides)
    _, before = strands.at(x, gaps)
    rng = np.random.default_rng(0)
    shares = rng.standard_normal(len(gaps))
    moved = tangle(seed + 10, d=d)
    first = shares @ strands.between(x, gaps).jacobian() @ moved.ravel()
    hessian = strands.between(x, gaps).hessian(shares, gaps.slides)
    second = 0.5 * moved.ravel() @ hessian @ moved.ravel()
    assert np.abs(hessian - hessian.T).max() < 1e-9 * np.abs(hessian).max()
    sizes = np.array([4e-3, 2e-3, 1e-3])
    left = []
    for size in sizes:
        _, after = strands.at(x + size * moved, gaps)
        gained = float(shares @ (after - before))
        left.append((gained - size * first, gained - size * first - size**2 * second))
    linear, quadratic = np.abs(np.array(left)).T
    assert np.log2(linear[1] / linear[2]) == pytest.approx(2, abs=0.1)
    assert np.log2(quadratic[1] / quadratic[2]) == pytest.approx(3, abs=0.4)


def test_gaps_do_not_change_under_rigid_motions() -> None:
    x = tangle(3)
    strands = strands_on(x)
    turn = np.linalg.qr(np.random.default_rng(1).standard_normal((3, 3)))[0]
    gaps, widths = strands.near(x, 0.02)
    moved, after = strands.near(x @ turn + [1.0, -2.0, 3.0], 0.02)
    assert len(moved) == len(gaps)
    np.testing.assert_allclose(after, widths, atol=1e-13)
    np.testing.assert_allclose(moved.s[moved.slides], gaps.s[gaps.slides], atol=1e-11)


def test_gaps_do_not_change_when_vertices_are_renumbered() -> None:
    x = tangle(3)
    gaps, widths = strands_on(x).near(x, 0.02)
    y = np.roll(x, 37, axis=0)
    other, after = strands_on(y).near(y, 0.02)
    at_points, again = gaps.slides, other.slides
    np.testing.assert_allclose(
        np.sort(after[again]), np.sort(widths[at_points]), atol=1e-13
    )


@pytest.mark.slow
def test_gaps_at_points_change_by_order_4_when_the_mesh_is_shifted() -> None:
    def smallest(n: int, shift: float) -> float:
        x = tangle(3, n, shift=shift)
        gaps, widths = strands_on(x).near(x, 0.02)
        return float(widths[gaps.slides].min())

    shifts = (0.25, 0.5, 0.75)
    off = [
        max(abs(smallest(n, shift) - smallest(n, 0.0)) for shift in shifts)
        for n in (120, 240)
    ]
    assert off[1] < 1e-6
    assert np.log2(off[0] / off[1]) > 3.5


@pytest.mark.parametrize(("d", "seed", "most"), [(2, 3, 0.025), (3, 2, 0.008)])
def test_gaps_are_closed_and_lengths_kept(d: int, seed: int, most: float) -> None:
    x = tangle(seed, d=d)
    strands = strands_on(x)
    gaps, widths = strands.near(x, 0.03)
    gaps = gaps[gaps.slides & (np.abs(widths) < most)]
    assert len(gaps)
    closed = HeldGaps(Lengths(strands.loop), strands, gaps).project(x)
    assert closed is not None
    assert strands.loop.length_error(closed) < 1e-12
    assert np.abs(strands.at(closed, gaps)[1]).max() < 1e-12
