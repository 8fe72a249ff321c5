"""Angles of triangles against their corners' own directions, in the plane and in space."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh.triangles import cotangents, smallest_angle


def sides(corners: FloatArray) -> FloatArray:
    """Side j opposite corner j, of corners (n_t, 3, d)."""
    return np.roll(corners, 1, axis=1) - np.roll(corners, -1, axis=1)


def plane_areas(corners: FloatArray) -> FloatArray:
    """Negative for a triangle that runs clockwise."""
    (ax, ay), (bx, by) = (corners[:, 1:] - corners[:, :1]).transpose(1, 2, 0)
    return np.asarray(0.5 * (ax * by - ay * bx))


def angles(corners: FloatArray) -> FloatArray:
    """The angle (n_t, 3) between the two sides that leave each corner."""
    ahead = np.roll(corners, -1, axis=1) - corners
    back = np.roll(corners, 1, axis=1) - corners
    sizes = np.linalg.norm(ahead, axis=2) * np.linalg.norm(back, axis=2)
    return np.asarray(np.arccos((ahead * back).sum(axis=2) / sizes))


@pytest.mark.parametrize("d", [2, 3])
def test_angles_are_those_between_the_sides(d: int) -> None:
    corners = np.random.default_rng(d).standard_normal((50, 3, d))
    exact = angles(corners)
    areas = np.abs(plane_areas(corners[..., :2]))
    if d == 3:
        a, b = (corners[:, 1:] - corners[:, :1]).transpose(1, 0, 2)
        areas = 0.5 * np.linalg.norm(np.cross(a, b), axis=1)
    found = cotangents(sides(corners), areas)
    np.testing.assert_allclose(found, 1 / np.tan(exact), rtol=1e-9, atol=1e-12)
    smallest = smallest_angle(sides(corners), areas)
    assert smallest == pytest.approx(np.degrees(exact.min()), rel=1e-9)
    for one in range(5):
        alone = smallest_angle(sides(corners[[one]]), areas[[one]])
        assert alone == pytest.approx(np.degrees(exact[one].min()), rel=1e-9)


def test_a_plane_triangle_that_has_turned_over_has_a_negative_angle() -> None:
    corners = np.array([[[0.0, 0], [1, 0], [0.3, 0.8]], [[1, 0], [1.2, 1], [0.3, 0.8]]])
    assert smallest_angle(sides(corners), plane_areas(corners)) > 0
    over = corners.copy()
    over[1, 0] = [1.0, 2.0]
    assert plane_areas(over)[1] < 0
    assert smallest_angle(sides(over), plane_areas(over)) < 0
    mirrored = corners * [1.0, -1.0]
    upright = smallest_angle(sides(corners), plane_areas(corners))
    assert smallest_angle(sides(mirrored), plane_areas(mirrored)) <= -upright


def test_a_triangle_without_area_has_no_cotangents_and_no_angle() -> None:
    flat = np.array([[[0.0, 0], [1, 0], [2, 0]], [[1, 1], [1, 1], [1, 1]]])
    assert not cotangents(sides(flat), plane_areas(flat)).any()
    assert smallest_angle(sides(flat), plane_areas(flat)) == 0.0
