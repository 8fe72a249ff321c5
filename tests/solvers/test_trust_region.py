"""The trust-region step: what makes it the global minimum, and brute force."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.solvers.trust_region import trust_region_step


def model(w: FloatArray, g: FloatArray, p: FloatArray) -> float:
    return float(g @ p + 0.5 * p @ (w * p))


def assert_global_minimum(w: FloatArray, g: FloatArray, p: FloatArray, r: float) -> None:
    """Necessary and sufficient (More and Sorensen 1983, lemmas 2.1 and 2.3):

    (w + tau) p = -g with tau >= 0, w + tau >= 0, |p| <= r and tau (r - |p|) = 0.
    """
    size = np.linalg.norm(p)
    assert size <= r * (1 + 1e-9)
    tau = max(0.0, -float((w * p + g) @ p) / float(p @ p)) if size > 0 else 0.0
    scale = np.abs(w).max() * r + np.linalg.norm(g)
    assert np.abs((w + tau) * p + g).max() < 1e-8 * scale
    assert (w + tau).min() > -1e-8 * np.abs(w).max()
    assert tau * (r - size) < 1e-8 * scale


def cases() -> list[tuple[FloatArray, FloatArray, float]]:
    rng = np.random.default_rng(1)
    found = []
    for shift in (-3.0, -1.0, 0.0, 2.0):
        for size in (1e-8, 1e-3, 1.0, 1e3):
            for radius in (1e-6, 1e-2, 1.0, 10.0):
                w = np.sort(rng.standard_normal(12) + shift)
                found.append((w, size * rng.standard_normal(12), radius))
    return found


@pytest.mark.parametrize(("w", "g", "radius"), cases())
def test_step_meets_the_conditions_of_a_global_minimum(
    w: FloatArray, g: FloatArray, radius: float
) -> None:
    assert_global_minimum(w, g, trust_region_step(w, g, radius), radius)


def test_no_step_inside_the_circle_is_better_by_brute_force() -> None:
    rng = np.random.default_rng(2)
    around = np.linspace(0, 2 * np.pi, 721)
    directions = np.stack([np.cos(around), np.sin(around)])
    for _ in range(20):
        w, g = np.sort(3 * rng.standard_normal(2)), rng.standard_normal(2)
        step = trust_region_step(w, g, 0.7)
        trials = np.linspace(0, 0.7, 201)[:, None, None] * directions
        values = np.einsum("rda,d->ra", trials, g)
        values += 0.5 * np.einsum("rda,d->ra", trials**2, w)
        assert model(w, g, step) <= values.min() + 1e-12


def test_step_is_newtons_where_it_fits() -> None:
    w, g = np.array([1.0, 4.0]), np.array([0.1, 0.4])
    np.testing.assert_allclose(trust_region_step(w, g, 1.0), [-0.1, -0.1])


@pytest.mark.parametrize("radius", [1e-3, 1.0, 30.0])
@pytest.mark.parametrize("others", [(0.0, 0.0), (1.0, -2.0), (1e-3, 0.0)])
def test_hard_case_goes_along_the_most_negative_mode_to_the_edge(
    radius: float, others: tuple[float, float]
) -> None:
    """At a saddle nothing pulls along the way out; the step must take it all the same."""
    w, g = np.array([-2.0, 1.0, 3.0]), np.array([0.0, *others])
    step = trust_region_step(w, g, radius)
    assert np.linalg.norm(step) == pytest.approx(radius, rel=1e-9)
    assert_global_minimum(w, g, step, radius)
    assert model(w, g, step) < 0
    if others == (0.0, 0.0):
        np.testing.assert_allclose(step, [radius, 0, 0])


def test_nearly_hard_case_is_as_good_as_the_hard_one() -> None:
    w = np.array([-2.0, -2.0 + 1e-13, 3.0])
    for tiny in (1e-300, 1e-20, 1e-12, 1e-8):
        for sign in (1, -1):
            g = np.array([sign * tiny, 0.0, 0.1])
            step = trust_region_step(w, g, 1.0)
            assert_global_minimum(w, g, step, 1.0)
            assert g[0] * step[0] <= 0


def test_singular_hessian_without_a_force_along_its_kernel_takes_the_newton_step() -> None:
    w, g = np.array([0.0, 2.0]), np.array([0.0, 1.0])
    step = trust_region_step(w, g, 1.0)
    assert_global_minimum(w, g, step, 1.0)
    assert model(w, g, step) == pytest.approx(-0.25, rel=1e-9)


def test_step_scales_with_the_gradient_and_not_with_the_unit_of_energy() -> None:
    w, g = np.array([-1.0, 2.0, 5.0]), np.array([0.3, -0.2, 0.1])
    step = trust_region_step(w, g, 0.5)
    for unit in (1e-6, 1e9):
        np.testing.assert_allclose(trust_region_step(unit * w, unit * g, 0.5), step)


def test_step_without_a_force_at_a_minimum_is_no_step() -> None:
    np.testing.assert_array_equal(
        trust_region_step(np.array([1.0, 2.0]), np.zeros(2), 1.0), 0
    )
