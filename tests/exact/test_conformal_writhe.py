"""The writhe of smooth loops: against polygons, its derivatives, rotations and mirrors."""

from math import pi

import numpy as np
import pytest

from eulerplateau.exact.conformal import (
    GENERAL,
    TWISTED,
    make_basis,
    writhe_gradient,
    writhe_hessian,
    writhe_modulo_two,
)
from eulerplateau.loop import polygon_writhe

BASIS = make_basis(40, GENERAL, 0.5)


def some_loop(seed):
    rng = np.random.default_rng(seed)
    k = BASIS.wavenumbers
    return rng.normal(size=BASIS.size) * np.exp(-3 * k)


@pytest.mark.parametrize("seed", [1, 2, 3, 4, 5])
def test_writhe_is_the_limit_of_polygons(seed):
    """Polygons on a smooth loop err by O(n^-2)."""
    c = some_loop(seed)
    smooth = writhe_modulo_two(BASIS.curve(c))
    errors = []
    for n in (250, 500, 1000):
        polygon = polygon_writhe(BASIS.at(c, 2 * pi * np.arange(n) / n).x)
        errors.append((polygon - smooth + 1) % 2 - 1)
    orders = np.log2(np.abs(np.array(errors[:-1]) / errors[1:]))
    np.testing.assert_allclose(orders, 2, atol=0.05)


def test_gradient_and_hessian_are_the_derivatives():
    c, h = some_loop(1), 1e-5
    way = some_loop(6)
    values = [writhe_modulo_two(BASIS.curve(c + t * h * way)) for t in (-1, 1)]
    slopes = [writhe_gradient(BASIS, BASIS.curve(c + t * h * way)) for t in (-1, 1)]
    curve = BASIS.curve(c)
    slope, second = writhe_gradient(BASIS, curve), writhe_hessian(BASIS, curve)
    size = np.abs(slope @ way)
    assert (values[1] - values[0]) / (2 * h) == pytest.approx(slope @ way, rel=1e-6)
    np.testing.assert_allclose(second, second.T, atol=1e-12 * np.abs(second).max())
    turned = (slopes[1] - slopes[0]) / (2 * h)
    np.testing.assert_allclose(turned, second @ way, atol=1e-4 * np.abs(turned).max())
    assert size > 0.1


def test_mirror_image_writhes_the_other_way():
    c = some_loop(2)
    mirrored = c.copy()
    mirrored[BASIS.slices[2]] *= -1
    one, other = (writhe_modulo_two(BASIS.curve(x)) for x in (c, mirrored))
    assert (one + other + 1) % 2 - 1 == pytest.approx(0, abs=1e-12)


def test_block_of_a_symmetry_is_that_of_all_displacements():
    """The writhe's Hessian at a loop with half-turns mixes none of their blocks."""
    half_turns = make_basis(24, TWISTED, 0.5)
    every = make_basis(24, GENERAL, 0.5)
    rng = np.random.default_rng(3)
    c = rng.normal(size=half_turns.size) * np.exp(-half_turns.wavenumbers)
    curve = half_turns.curve(c)
    way = rng.normal(size=half_turns.size)
    inside = every.embed(half_turns, way)
    own = writhe_hessian(half_turns, curve) @ way
    whole = writhe_hessian(every, curve) @ inside
    np.testing.assert_allclose(
        whole, every.embed(half_turns, own), atol=1e-11 * np.abs(whole).max()
    )
