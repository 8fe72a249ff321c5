"""The writhe of smooth loops: against polygons, its derivatives, rotations and mirrors."""

from math import pi

import numpy as np
import pytest

from eulerplateau.exact.conformal import (
    GENERAL,
    TWISTED,
    make_basis,
    smooth_writhe,
    writhe_gradient,
    writhe_hessian,
)
from eulerplateau.loop import polygon_writhe
from tests.helpers.marks import quick_with

BASIS = make_basis(40, GENERAL, 0.5)


def some_loop(seed):
    rng = np.random.default_rng(seed)
    k = BASIS.wavenumbers
    return rng.normal(size=BASIS.size) * np.exp(-3 * k)


def knotted():
    """A trefoil on a torus, of which nobody knows the writhe from local formulas."""
    t = 2 * pi * np.arange(len(BASIS.phi)) / len(BASIS.phi)
    wide = 2 + np.cos(3 * t)
    x = np.stack([wide * np.cos(2 * t), wide * np.sin(2 * t), np.sin(3 * t)], axis=1)
    return BASIS.project(x)


@pytest.mark.parametrize("c", [*map(some_loop, range(1, 6)), knotted()])
def test_writhe_is_the_limit_of_polygons(c):
    """Polygons on a smooth loop err by O(n^-2)."""
    smooth = smooth_writhe(BASIS.curve(c))
    errors = []
    for n in (250, 500, 1000):
        polygon = polygon_writhe(BASIS.at(c, 2 * pi * np.arange(n) / n).x)
        errors.append(polygon - smooth)
    orders = np.log2(np.abs(np.array(errors[:-1]) / errors[1:]))
    np.testing.assert_allclose(orders, 2, atol=0.05)


def test_gradient_and_hessian_are_the_derivatives():
    c, h = some_loop(1), 1e-5
    way = some_loop(6)
    values = [smooth_writhe(BASIS.curve(c + t * h * way)) for t in (-1, 1)]
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
    one, other = (smooth_writhe(BASIS.curve(x)) for x in (c, mirrored))
    assert one == pytest.approx(-other, abs=1e-12)


@pytest.mark.parametrize("seed", quick_with(range(5), range(40)))
def test_strands_that_cross_are_counted_where_half_turns_lay_them_on_each_other(seed):
    """Loops with half-turns, of any shape: by all pairs of a polygon's edges."""
    few, half_turns = make_basis(24, TWISTED), make_basis(160, TWISTED)
    c = np.random.default_rng(seed).normal(size=few.size) * np.exp(-1.5 * few.wavenumbers)
    c[few.slices[2]] *= 4
    polygon = polygon_writhe(few.at(c, 2 * pi * np.arange(2000) / 2000).x)
    curve = half_turns.curve(half_turns.embed(few, c))
    assert smooth_writhe(curve) == pytest.approx(polygon, abs=0.02)


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
