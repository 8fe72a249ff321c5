"""Where a film comes against its rod: known distances, and what hangs on the loop."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh import Shape, fill_polygon, film_touches

ROWS, COLUMNS = 41, 9
GAP = 0.1


def strip(profile: FloatArray) -> Shape:
    """Return a strip of width 1 over a profile (n, 2) in the plane of x and z."""
    along = np.linspace(0.0, 1.0, len(profile))
    fine = np.linspace(0.0, 1.0, (ROWS - 1) * (len(profile) - 1) + 1)
    x = np.interp(fine, along, profile[:, 0])
    z = np.interp(fine, along, profile[:, 1])
    y = np.linspace(0.0, 1.0, COLUMNS)
    points = np.stack(
        [np.repeat(x, COLUMNS), np.tile(y, len(x)), np.repeat(z, COLUMNS)], axis=1
    )
    number = np.arange(len(points)).reshape(len(x), COLUMNS)
    a, b = number[:-1, :-1].ravel(), number[1:, :-1].ravel()
    c, d = number[1:, 1:].ravel(), number[:-1, 1:].ravel()
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    sides = [number[:, 0], number[-1, 1:], number[-2::-1, -1], number[0, -2:0:-1]]
    return Shape(points, triangles, np.concatenate(sides))


def hook(end: float) -> Shape:
    """Return a floor, a wall of height 1, and a roof that comes down to `end`."""
    return strip(np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, end]]))


def test_a_rod_touches_the_film_that_is_nearer_than_its_radius() -> None:
    assert not film_touches(hook(GAP), 0.999 * GAP)
    assert film_touches(hook(GAP), 1.001 * GAP)


def test_a_film_that_passes_through_itself_touches_whatever_the_rod() -> None:
    assert film_touches(hook(-GAP), 1e-6)


@pytest.mark.parametrize("radius", [1e-6, 0.02, 0.2, 1.0])
def test_where_the_film_is_attached_is_no_contact(radius: float) -> None:
    """Flat or bent, and across a waist that is narrower than the rod."""
    t = 2 * np.pi * np.arange(64) / 64
    oval = np.stack([2.0 * np.cos(t), (0.05 + 0.95 * np.cos(t) ** 2) * np.sin(t)], axis=1)
    flat = Shape(np.column_stack([oval, 0 * t]), fill_polygon(oval), np.arange(64))
    assert not film_touches(flat, radius)
    saddle = flat.x + np.outer(flat.x[:, 0] ** 2, [0.0, 0.0, 0.2])
    assert not film_touches(flat.moved(saddle), radius)


def test_moved_turned_and_renumbered_it_is_the_same() -> None:
    rng = np.random.default_rng(5)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    for radius, touched in ((0.999 * GAP, False), (1.001 * GAP, True)):
        shape = hook(GAP)
        order = rng.permutation(len(shape.x))
        place = np.argsort(order)
        moved = Shape(
            (shape.x @ turn + [1.0, -2.0, 3.0])[order],
            rng.permutation(place[shape.triangles]),
            np.roll(place[shape.loop], 17),
        )
        assert film_touches(moved, radius) is touched
