"""A rod that is curved by nature: its frame at rest, what the loop feels, its limits."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.linalg import LinAlgError
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import CurvedRod, Frame, Loop, Twist
from eulerplateau.loop.bend_kernels import bend
from eulerplateau.loop.frame_kernels import carried, settle, turned
from eulerplateau.loop.loop import differences
from tests.helpers import twins
from tests.loop.test_writhe import tangle


def loop_of(x: FloatArray) -> Loop:
    return Loop(np.linalg.norm(differences(x), axis=1))


def rod_of(x: FloatArray, link: float = 0.0, q: float = 0.7) -> CurvedRod:
    return CurvedRod(loop_of(x), 0.8, link, q)


def bow(n: int, size: float = 0.3) -> tuple[FloatArray, FloatArray]:
    """A smooth loop in no plane, and its curvature vectors half-way between vertices."""

    def curve(t: FloatArray, order: int) -> FloatArray:
        a, b = t + order * np.pi / 2, 2 * t + order * np.pi / 2
        z = size * 2**order * np.sin(b + 0.4)
        return np.stack([1.4 * np.cos(a), np.sin(a), z], axis=1)

    t = 2 * np.pi * np.arange(n) / n
    first, second = curve(t + np.pi / n, 1), curve(t + np.pi / n, 2)
    square = (first**2).sum(axis=1)[:, None]
    along = (first * second).sum(axis=1)[:, None]
    return curve(t, 0), (second - along / square * first) / square


def egg(n: int, rng: np.random.Generator) -> FloatArray:
    """An uneven polygon in a plane, three times as long as wide, blunt at one end."""
    t = 2 * np.pi * (np.arange(n) + rng.uniform(-0.2, 0.2, n)) / n
    x = np.stack([3 * np.cos(t) + 0.4 * np.cos(2 * t), np.sin(t), 0 * t], axis=1)
    return x / np.linalg.norm(differences(x), axis=1).sum()


def test_a_vertex_bends_by_its_angle_times_the_mean_cosine_of_the_directors(
    rng: np.random.Generator,
) -> None:
    x = tangle(30, rng=rng)
    frame = Frame.even(x, 0.4)
    t, d = frame.tangents, frame.directors
    u, g = np.roll(t, -1, axis=0), np.roll(d, -1, axis=0)
    binormal = np.cross(t, u)
    sine = np.linalg.norm(binormal, axis=1)[:, None]
    cosine = (d * np.cross(binormal / sine, t)).sum(axis=1)
    cosine += (g * np.cross(binormal / sine, u)).sum(axis=1)
    angle = np.arctan2(sine[:, 0], (t * u).sum(axis=1))
    assert angle.max() > np.pi / 3 > angle.min()  # by its series, and by the formula
    expected = 0.5 * float((angle * cosine).sum())
    assert bend(t, frame.lengths, d)[0] == pytest.approx(expected, rel=1e-12)


def test_directors_are_turned_and_carried_by_rotations(rng: np.random.Generator) -> None:
    before, after = Frame.even(tangle(9, rng=rng), 0.3), Frame.even(tangle(9, rng=rng), 0.3)
    t, u, d = before.tangents, after.tangents, before.directors
    angles = rng.standard_normal(9)
    by = Rotation.from_rotvec(angles[:, None] * t)
    np.testing.assert_allclose(turned(t, d, angles), by.apply(d), atol=1e-14)
    axis = np.cross(t, u)
    sine = np.linalg.norm(axis, axis=1)
    turn = np.arctan2(sine, (t * u).sum(axis=1)) / sine
    least = Rotation.from_rotvec(turn[:, None] * axis)
    np.testing.assert_allclose(carried(t, u, d), least.apply(d), atol=1e-13)


def test_a_frame_settles_where_its_energy_is_least(rng: np.random.Generator) -> None:
    p, q, twists = rng.standard_normal((3, 12))
    springs = rng.uniform(1, 3, 12)

    def energy(psi: FloatArray) -> float:
        twist = twists + np.roll(psi, -1) - psi
        return float((p * np.cos(psi) + q * np.sin(psi) + 0.5 * springs * twist**2).sum())

    psi = np.zeros(12)
    assert settle(p, q, springs, twists, psi)
    found = minimize(energy, psi + 0.01, tol=1e-12)
    np.testing.assert_allclose(psi, found.x, atol=1e-5)
    assert energy(psi) <= found.fun + 1e-12


@pytest.mark.parametrize("link", [0.0, 0.3, 1.0])
def test_force_and_hessian_have_taylor_slopes_of_2(
    link: float, rng: np.random.Generator
) -> None:
    x = tangle(18, rng=rng)
    rod, p = rod_of(x, link), 0.02 * rng.standard_normal(x.shape)
    energy = twins.taylor_slope(lambda y: (rod.energy(y), rod.force(y)), x, p)
    assert energy == pytest.approx(2, abs=0.1)
    hessian, q = rod.hessian(x), rng.standard_normal(x.shape)
    across = (hessian @ q.ravel()).reshape(x.shape)
    force = twins.taylor_slope(lambda y: (float(np.vdot(q, rod.force(y))), across), x, p)
    assert force == pytest.approx(2, abs=0.1)
    np.testing.assert_allclose(hessian, hessian.T, atol=1e-13 * np.abs(hessian).max())


def test_the_change_of_the_energy_keeps_its_digits(rng: np.random.Generator) -> None:
    x = tangle(30, rng=rng)
    rod, p = rod_of(x, 0.3), rng.standard_normal(x.shape)
    p /= np.linalg.norm(p)
    differ = rod.energy(x + 0.02 * p) - rod.energy(x)
    assert rod.change(x, 0.02 * p) == pytest.approx(differ, rel=1e-8)
    slope = float(np.vdot(rod.force(x), p))
    assert rod.change(x, 1e-9 * p) == pytest.approx(1e-9 * slope, rel=1e-6)


@pytest.mark.parametrize("parameter", ["link", "twist_ratio", "rest_curvature"])
def test_the_rate_of_the_force_is_its_difference(
    parameter: str, rng: np.random.Generator
) -> None:
    x = tangle(15, rng=rng)
    rod = rod_of(x, 0.3)
    value = {"link": 0.3, "twist_ratio": 0.8, "rest_curvature": 0.7}[parameter]
    rod.frame(x)
    after, before = (rod.with_value(parameter, value + h).force(x) for h in (1e-4, -1e-4))
    rate = rod.rate(parameter, x)
    assert rate is not None
    error = np.abs((after - before) / 2e-4 - rate).max()
    assert error < 1e-5 * np.abs(rate).max()
    assert rod.rate("load", x) is None
    assert rod.with_value("load", 1.0) is rod


def test_no_place_numbering_or_direction_is_felt_and_mirror_images_have_minus_link(
    rng: np.random.Generator,
) -> None:
    x = tangle(24, rng=rng)
    expected = pytest.approx(rod_of(x, 1.0).energy(x), rel=1e-12)
    turn = Rotation.random(rng=np.random.default_rng(2))
    placed = turn.apply(x) + np.array([1.0, 2.0, 3.0])
    for other in (placed, np.roll(x, 7, axis=0), x[::-1].copy()):
        assert rod_of(other, 1.0).energy(other) == expected
    mirrored = x * [1, 1, -1]
    assert rod_of(mirrored, -1.0).energy(mirrored) == expected
    # A weld that is no whole turn is at the first vertex, in either direction.
    back = np.roll(x[::-1], 1, axis=0)
    assert rod_of(back, 0.3).energy(back) == pytest.approx(rod_of(x, 0.3).energy(x))
    rolled = np.roll(x, 7, axis=0)
    assert rod_of(rolled, 0.3).energy(rolled) != pytest.approx(rod_of(x, 0.3).energy(x))
    assert rod_of(x, 1.0).slides
    assert not rod_of(x, 0.3).slides


def test_without_a_natural_curvature_it_is_twist(rng: np.random.Generator) -> None:
    x = tangle(20, rng=rng)
    x /= loop_of(x).rest_lengths.sum()
    twist, rod = Twist(loop_of(x), 0.8, 0.3), rod_of(x, 0.3, 0.0)
    assert rod.energy(x) == pytest.approx(twist.energy(x), rel=1e-12)
    scale = np.abs(twist.force(x)).max()
    np.testing.assert_allclose(rod.force(x), twist.force(x), atol=1e-10 * scale)
    scale = np.abs(twist.hessian(x)).max()
    np.testing.assert_allclose(rod.hessian(x), twist.hessian(x), atol=1e-9 * scale)
    # And comes to it in proportion.
    away = [rod_of(x, 0.3, q).energy(x) - twist.energy(x) for q in (1e-5, 1e-6)]
    assert away[0] / away[1] == pytest.approx(10, rel=1e-3)


@pytest.mark.parametrize("q", [0.3, 1.5])
def test_in_a_plane_a_rod_shifts_the_energy_and_does_nothing(
    q: float, rng: np.random.Generator
) -> None:
    x = egg(60, rng)
    rod, k0 = rod_of(x, 0.0, q), 2 * np.pi * q
    assert rod.energy(x) == pytest.approx(k0**2 - 4 * np.pi * k0, rel=1e-12)
    assert np.abs(rod.force(x)).max() < 1e-9
    np.testing.assert_allclose(rod.moments(x), 0, atol=1e-10)


def test_a_ring_s_frame_points_inwards_wherever_it_comes_from() -> None:
    """The one that points outwards is at rest as well, at a maximum."""
    t = 2 * np.pi * np.arange(40) / 40
    x = np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)
    rod, even = rod_of(x), Frame.even(x, 0.0)
    inwards = rod.frame(x).directors
    middles = 0.5 * (x + np.roll(x, -1, axis=0))
    expected = -middles / np.linalg.norm(middles, axis=1)[:, None]
    np.testing.assert_allclose(inwards, expected, atol=1e-12)
    best = even.angles_to(rod.frame(x))
    for start in (0.0, 1.0, np.pi):
        found = rod.framed.settled(even, best + start)
        np.testing.assert_allclose(found.directors, expected, atol=1e-12)


def test_moments_change_along_the_rod_as_its_balance_wants_with_order_2() -> None:
    """C Omega' = -2 alpha k0 t' . (t x d1), half-way between the vertices."""
    errors = []
    for n in (100, 200):
        x, curvature = bow(n)
        rod = rod_of(x, 1.0, 0.6)
        frame, moments = rod.frame(x), rod.moments(x)
        second = np.cross(frame.tangents, frame.directors)
        expected = -2 * rod.framed.natural * (curvature * second).sum(axis=1)
        found = (moments - np.roll(moments, 1)) / frame.lengths
        assert np.abs(expected).max() > 0.1
        errors.append(np.abs(found - expected).max())
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.1)


def test_of_several_frames_the_same_is_found_wherever_a_loop_lies(
    rng: np.random.Generator,
) -> None:
    x = tangle(40, rng=rng)
    rod = resting(x)[0]
    for turn in Rotation.random(8, rng=np.random.default_rng(5)):
        placed = turn.apply(x)
        fresh = CurvedRod(loop_of(x), 0.02, 0.0, 3.0)
        expected = pytest.approx(rod.energy(x), rel=1e-10)
        assert fresh.energy(placed) == expected
    # And whatever loop far away was asked for before.
    turn = Rotation.from_rotvec([0, 0, np.pi])
    fresh = CurvedRod(loop_of(x), 0.02, 0.0, 3.0)
    expected_frame = fresh.frame(turn.apply(x))
    np.testing.assert_array_equal(
        rod.frame(turn.apply(x)).directors, expected_frame.directors
    )


def test_where_a_loop_is_straight_or_folded_flat_nothing_breaks() -> None:
    """Two straight stretches and two half circles; then closed to a strip of no width."""
    t = np.linspace(-np.pi / 2, np.pi / 2, 12)
    cap = np.stack([1 + 0.3 * np.cos(t), 0.3 * np.sin(t), 0 * t], axis=1)
    straight = np.linspace([1, 0.3, 0], [-1, 0.3, 0], 12)[1:-1]
    half = np.concatenate([cap, straight])
    x = np.concatenate([half, half * [-1, -1, 1]])
    for link in (0.0, 1.0):
        for width in (1.0, 1e-3):
            flat = x * [1, width, 1]
            rod = rod_of(flat, link)
            found = rod.energy(flat), rod.force(flat), rod.hessian(flat)
            assert all(np.isfinite(part).all() for part in found)


def test_twist_is_link_less_writhe_wherever_it_goes(rng: np.random.Generator) -> None:
    x = tangle(40, rng=rng)
    twist, rod = Twist(loop_of(x), 0.8, 1.0), rod_of(x, 1.0)
    total = rod.frame(x).twists.sum() / (2 * np.pi)
    assert total == pytest.approx(1.0 - twist.writhe(x), abs=1e-12)
    near = x + 0.01 * rng.standard_normal(x.shape)
    moved = rod.frame(x).carried(near)
    assert moved.twists.sum() / (2 * np.pi) == pytest.approx(moved.turns, abs=1e-12)
    assert moved.turns == pytest.approx(1.0 - twist.writhe(near), abs=1e-11)


@pytest.mark.parametrize("link", [0.0, 0.3])
def test_the_frame_of_a_loop_is_the_same_to_the_bit_whatever_was_before(
    link: float, rng: np.random.Generator
) -> None:
    """Unless it snaps on the way, as one that was turned by a whole turn may."""
    x = tangle(40, 0.2, rng=rng)
    p = 0.01 * rng.standard_normal(x.shape)
    direct, after = rod_of(x, link), rod_of(x, link)
    for part in (0.0, 0.3, 0.8):
        after.frame(x + part * p)
    np.testing.assert_array_equal(
        direct.frame(x + p).directors, after.frame(x + p).directors
    )


def test_no_step_takes_a_strand_through_another() -> None:
    t = 2 * np.pi * np.arange(60) / 60
    eight = np.stack([np.sin(t), np.sin(2 * t), 0.1 * np.cos(t)], axis=1)
    through = np.zeros_like(eight)
    through[:, 2] = -0.2 * np.cos(t)
    with pytest.raises(LinAlgError, match="pass through"):
        rod_of(eight, 1.0).change(eight, through)


def resting(x: FloatArray) -> tuple[CurvedRod, Frame, Frame]:
    """A rod soft to twist, and of its frames at rest those of most and of least energy."""
    rod = CurvedRod(loop_of(x), 0.02, 0.0, 3.0)
    even = Frame.even(x, rod.frame(x).turns)
    starts = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    found = [rod.framed.settled(even, np.full(len(x), start)) for start in starts]
    found.sort(key=rod.framed.energy)
    assert rod.framed.energy(found[-1]) > rod.framed.energy(found[0]) + 1e-3
    return rod, found[-1], found[0]


def test_a_frame_is_followed_whatever_else_is_known_of_loops_near_by(
    rng: np.random.Generator,
) -> None:
    x = tangle(40, rng=rng)
    rod, high, low = resting(x)
    step = 1e-6 * rng.standard_normal(x.shape)
    for frame, other in ((high, low), (low, high)):
        beyond = [rod.framed.at_rest(other.carried(x + part * step)) for part in (0.9, 1.0)]
        rod._known[:] = [*beyond, frame]
        work = float(np.vdot(rod.framed.force(frame), step))
        assert rod.change(x, step) == pytest.approx(work, abs=1e-7)
        assert rod.energy(x) == pytest.approx(rod.framed.energy(frame))
        assert rod.energy(x + step) == pytest.approx(rod.framed.energy(frame), abs=1e-3)


def test_changes_add_up_where_the_frame_snaps(rng: np.random.Generator) -> None:
    """On the way to a ring a frame at rest is lost: what that frees is in one change."""
    t = 2 * np.pi * np.arange(40) / 40
    ring = np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)
    snapped = 0
    for _ in range(3):
        x = tangle(40, rng=rng)
        rod = CurvedRod(loop_of(x), 0.1, 0.0, 3.0)
        even = Frame.even(x, rod.frame(x).turns)
        starts = np.linspace(0, 2 * np.pi, 12, endpoint=False)
        frames = [rod.framed.settled(even, np.full(40, start)) for start in starts]
        first = max(frames, key=rod.framed.energy)
        rod._known[:] = [first]
        parts = x + np.linspace(0, 1, 101)[:, None, None] * (ring - x)
        changes = [rod.change(y, z - y) for y, z in pairwise(parts)]
        gained = rod.energy(parts[-1]) - rod.framed.energy(first)
        assert sum(changes) == pytest.approx(gained, abs=1e-5)
        snapped += np.abs(np.diff(changes, 2)).max() > 1
    assert snapped
