"""The writhe of a polygon: its value, how it changes, and what passing strands do to it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import Loop, Twist
from eulerplateau.loop.loop import differences
from eulerplateau.loop.writhe_kernels import tangent_area, writhe
from tests.helpers import twins


def tangle(n: int, size: float = 0.4, *, rng: np.random.Generator) -> FloatArray:
    """A round loop with a few random harmonics, in no plane."""
    t = 2 * np.pi * np.arange(n) / n
    x = np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)
    for k in (1, 2, 3):
        wave = np.cos(k * t[:, None] + rng.uniform(0, 2 * np.pi, 3))
        x += size / k * rng.standard_normal(3) * wave
    return x


def trefoil(n: int) -> tuple[FloatArray, float]:
    """A knot on a torus, and the total torsion of the smooth curve over 2 pi."""
    t = 2 * np.pi * np.arange(4000) / 4000

    def curve(t: FloatArray, order: int) -> FloatArray:
        # By complex exponentials, so that derivatives are products.
        waves = ((1j, 1.0, 0), (2j, 2.0, 0), (1j, 1.0, 1), (2j, -2.0, 1), (3j, -1.0, 2))
        x = np.zeros((len(t), 3))
        for rate, size, axis in waves:
            wave = size * rate**order * np.exp(rate * t)
            x[:, axis] += wave.real if axis == 1 else wave.imag
        return x

    first, second, third = (curve(t, order) for order in (1, 2, 3))
    binormal = np.cross(first, second)
    torsion = (binormal * third).sum(axis=1) / (binormal**2).sum(axis=1)
    turns = float(np.mean(torsion * np.linalg.norm(first, axis=1)))
    return curve(2 * np.pi * np.arange(n) / n, 0), turns


def test_the_writhe_is_the_gauss_integral_over_all_pairs_of_edges(
    rng: np.random.Generator,
) -> None:
    for _ in range(3):
        x = tangle(9, rng=rng)
        assert writhe(x) == pytest.approx(twins.writhe(x), abs=1e-11)


def test_writhe_and_torsion_make_a_whole_number_with_order_2() -> None:
    """Calugareanu: writhe plus the total torsion over 2 pi is an integer."""
    missing = []
    for n in (200, 400):
        x, turns = trefoil(n)
        whole = writhe(x) + turns
        missing.append(abs(whole - round(whole)))
    assert missing[1] < 1e-3
    assert np.log2(missing[0] / missing[1]) == pytest.approx(2, abs=0.1)


def test_a_flat_eight_with_a_right_handed_crossing_writhes_once() -> None:
    t = 2 * np.pi * np.arange(60) / 60
    # The upper strand, at t = 0, heads along (1, 2), the lower along (-1, 2): to its left.
    eight = np.stack([np.sin(t), np.sin(2 * t), 1e-7 * np.cos(t)], axis=1)
    assert writhe(eight) == pytest.approx(1, abs=1e-5)


def test_the_writhe_is_nought_in_a_plane_odd_under_reflection_and_free_of_places(
    rng: np.random.Generator,
) -> None:
    x = tangle(24, rng=rng)
    flat = x * [1, 1, 0]
    assert abs(writhe(flat)) < 1e-14
    turn, _ = np.linalg.qr(rng.standard_normal((3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    expected = pytest.approx(writhe(x), abs=1e-12)
    assert writhe(3.7 * x @ turn + [1, 2, 3]) == expected
    assert writhe(np.roll(x, 7, axis=0)) == expected
    assert writhe(x[::-1].copy()) == expected
    assert -writhe(x * [1, 1, -1]) == expected


def test_what_the_tangents_gain_in_area_is_what_the_writhe_gains(
    rng: np.random.Generator,
) -> None:
    for _ in range(5):
        x = tangle(40, rng=rng)
        after = x + 0.002 * rng.standard_normal(x.shape)
        gained = tangent_area(differences(x), differences(after)) / (2 * np.pi)
        assert gained == pytest.approx(writhe(after) - writhe(x), abs=1e-12)


def twist_of(x: FloatArray, link: float = 1.3) -> Twist:
    return Twist(Loop(np.linalg.norm(differences(x), axis=1)), 0.8, link)


def test_force_and_hessian_of_the_twist_have_taylor_slopes_of_2() -> None:
    rng = np.random.default_rng(4)
    x = tangle(18, rng=rng)
    twist, p = twist_of(x), rng.standard_normal(x.shape)
    energy = twins.taylor_slope(lambda y: (twist.energy(y), twist.force(y)), x, 0.02 * p)
    assert energy == pytest.approx(2, abs=0.1)
    hessian = twist.hessian(x)
    q = rng.standard_normal(x.shape)
    force = twins.taylor_slope(
        lambda y: (
            float(np.vdot(q, twist.force(y))),
            (hessian @ q.ravel()).reshape(x.shape),
        ),
        x,
        0.02 * p,
    )
    assert force == pytest.approx(2, abs=0.1)
    np.testing.assert_allclose(hessian, hessian.T, atol=1e-13 * np.abs(hessian).max())


def test_the_change_of_the_twisting_energy_keeps_its_digits(
    rng: np.random.Generator,
) -> None:
    x = tangle(30, rng=rng)
    twist, p = twist_of(x), rng.standard_normal(x.shape)
    p /= np.linalg.norm(p)
    assert twist.change(x, 0.01 * p) == pytest.approx(
        twist.energy(x + 0.01 * p) - twist.energy(x), rel=1e-10
    )
    slope = float(np.vdot(twist.force(x), p))
    assert twist.change(x, 1e-9 * p) == pytest.approx(1e-9 * slope, rel=1e-6)


@pytest.mark.parametrize("parameter", ["link", "twist_ratio"])
def test_the_rate_of_the_force_by_link_and_ratio_is_its_difference(
    parameter: str, rng: np.random.Generator
) -> None:
    x = tangle(15, rng=rng)
    loop = twist_of(x).loop

    def force(step: float) -> FloatArray:
        numbers = {"ratio": 0.8, "link": 1.3}
        numbers["ratio" if parameter == "twist_ratio" else "link"] += step
        return Twist(loop, **numbers).force(x)

    rate = twist_of(x).rate(parameter, x)
    assert rate is not None
    # Linear in both.
    np.testing.assert_allclose(rate, force(0.5) - force(-0.5), rtol=1e-10, atol=1e-12)


def test_no_step_takes_a_strand_through_another() -> None:
    t = 2 * np.pi * np.arange(60) / 60
    eight = np.stack([np.sin(t), np.sin(2 * t), 0.1 * np.cos(t)], axis=1)
    through = np.zeros_like(eight)
    through[:, 2] = -0.2 * np.cos(t)
    twist = twist_of(eight)
    assert abs(writhe(eight + through) - writhe(eight)) == pytest.approx(2, abs=0.3)
    with pytest.raises(LinAlgError, match="pass through"):
        twist.change(eight, through)
    assert np.isfinite(twist.change(eight, 0.4 * through))
