"""Repaired meshes: the same disk, the same loop, better triangles, the same film."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import Delaunay

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.film.flip_kernels import flip_to_delaunay
from eulerplateau.film.flips import (
    delaunay_flips,
)
from eulerplateau.film.models import (
    area,
)
from eulerplateau.film.repair import carry_along, mend_triangles
from eulerplateau.film.tiling import LIMITS, Tiling
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.triangles import (
    neighbours,
)
from tests.helpers import shapes


def tiling_of(mesh: Disk) -> Tiling:
    return area(mesh).tiling(mesh.triangles)


def sheared(rings: int = 6) -> tuple[Tiling, FloatArray]:
    """A convex film, flat, whose triangles have been sheared along it."""
    points, triangles = shapes.disk_points(rings, jitter=0.2)
    mesh = shapes.mesh_of(points, triangles)
    return tiling_of(mesh), mesh.x @ np.array([[1.0, 0, 0], [1.5, 1, 0], [0, 0, 1]])


def bent(rings: int = 6) -> tuple[Tiling, FloatArray]:
    """The same on Enneper's surface."""
    film, x = sheared(rings)
    return film, shapes.enneper(x[:, :2] / np.linalg.norm(x, axis=1).max(), 0.8)


def triangle_set(triangles: IntArray) -> set[frozenset[int]]:
    return {frozenset(t) for t in triangles.tolist()}


def assert_same_disk(before: Tiling, after: Tiling, x: FloatArray) -> None:
    mesh = Disk.from_triangles(x, after.triangles)
    assert len(after.triangles) == len(before.triangles)
    np.testing.assert_array_equal(np.sort(mesh.loop), np.sort(before.loop))
    start = int(np.flatnonzero(mesh.loop == before.loop[0])[0])
    np.testing.assert_array_equal(np.roll(mesh.loop, -start), before.loop)


@pytest.mark.parametrize("make", [sheared, bent])
def test_neighbours_are_the_triangles_that_share_a_side(make) -> None:
    film, _ = make()
    found = neighbours(film.triangles)
    owners: dict[frozenset[int], list[int]] = {}
    for t, corners in enumerate(film.triangles.tolist()):
        for j in range(3):
            owners.setdefault(frozenset(corners[:j] + corners[j + 1 :]), []).append(t)
    for t, corners in enumerate(film.triangles.tolist()):
        for j in range(3):
            others = set(owners[frozenset(corners[:j] + corners[j + 1 :])]) - {t}
            assert found[t, j] == (others.pop() if others else -1)


def test_flips_lead_to_delaunays_triangles_in_a_convex_polygon() -> None:
    film, x = sheared()
    found = delaunay_flips(film, x)
    assert triangle_set(found.triangles) != triangle_set(film.triangles)
    assert triangle_set(found.triangles) == triangle_set(Delaunay(x[:, :2]).simplices)
    assert_same_disk(film, found, x)
    assert delaunay_flips(found, x) is found


def test_flips_keep_the_list_of_neighbours_up_to_date() -> None:
    film, x = bent()
    triangles = film.triangles.copy()
    across = neighbours(triangles)
    assert flip_to_delaunay(x, triangles, across) > 0
    np.testing.assert_array_equal(across, neighbours(triangles))


def test_flips_leave_a_surface_of_acute_angles_sums_and_the_same_disk() -> None:
    """Opposite angles sum to pi at most: no cotangent weight is negative."""
    film, x = bent()
    found = delaunay_flips(film, x)
    assert_same_disk(film, found, x)

    def lowest(film: Tiling) -> float:
        """The least weight of an edge inside; L has minus half the weights beside."""
        laplacian = film.matrix(film.cotangent_laplacian(film.sides(x))).toarray()
        inner = np.ones((film.n_v, film.n_v), dtype=bool)
        inner[film.loop, np.roll(film.loop, -1)] = inner[
            np.roll(film.loop, -1), film.loop
        ] = 0
        np.fill_diagonal(inner, False)
        return float((-laplacian * inner).min())

    assert lowest(film) < -0.1
    assert lowest(found) > -1e-9


@pytest.mark.parametrize("make", [sheared, bent])
def test_repair_makes_thin_triangles_good_and_leaves_the_loop_alone(make) -> None:
    film, x = make()
    before = film.sides(x).smallest_angle
    found, after = mend_triangles(film, x)
    assert before < LIMITS.thin
    assert found.sides(after).smallest_angle > 20
    np.testing.assert_array_equal(after[film.loop], x[film.loop])
    assert_same_disk(film, found, after)


@pytest.mark.parametrize("seed", range(6))
def test_repair_never_makes_the_worst_angle_worse(seed: int) -> None:
    """Good meshes, bad ones and crumpled ones."""
    rng = np.random.default_rng(seed)
    mesh = shapes.mesh_of(*shapes.disk_points(5, jitter=0.1 * (seed % 3)))
    film, x = tiling_of(mesh), mesh.x * [1.0, 1.0 + seed, 1.0]
    x = x + 3e-3 * (seed // 3) * rng.standard_normal(x.shape)
    found, after = mend_triangles(film, x)
    assert found.sides(after).smallest_angle >= film.sides(x).smallest_angle
    assert_same_disk(film, found, after)


def test_repair_of_a_flat_film_keeps_its_area_to_rounding() -> None:
    film, x = sheared()
    found, after = mend_triangles(film, x)
    area_then = found.sides(after).areas.sum()
    assert area_then == pytest.approx(film.sides(x).areas.sum(), rel=1e-14)
    assert (found.sides(after).normals[:, 2] > 0).all()


def test_repair_keeps_a_curved_film_to_second_order() -> None:
    """Its area, by less and less of the error that the triangles make anyway."""
    rings, changes = [6, 9, 13, 19], []
    for number in rings:
        film, x = bent(number)
        found, after = mend_triangles(film, x)
        changes.append(found.sides(after).areas.sum() - film.sides(x).areas.sum())
    order = shapes.fitted_order([1 / number for number in rings], changes)
    assert order == pytest.approx(2.0, abs=0.2)


def test_film_is_carried_far_without_folding_over() -> None:
    """A disk becomes four times as long as it is wide, and turns by a right angle."""
    mesh = shapes.mesh_of(*shapes.disk_points(6, jitter=0.1))
    film, x = tiling_of(mesh), mesh.x
    turned = x[film.loop] @ np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    target = turned * [2.0, 0.5, 1.0]
    found, after = carry_along(film, x, target)
    np.testing.assert_array_equal(after[film.loop], target)
    assert_same_disk(film, found, after)
    sides = found.sides(after)
    assert (sides.normals[:, 2] > 0.999).all()
    assert sides.smallest_angle > 12
    assert sides.areas.sum() == pytest.approx(film.sides(x).areas.sum(), rel=1e-13)


def cap(rings: int) -> tuple[Tiling, FloatArray]:
    """Sheared triangles on a unit sphere, up to 46 degrees from its pole."""
    film, x = sheared(rings)
    angle = 0.8 * x[:, :2] / np.linalg.norm(x, axis=1).max()
    size = np.linalg.norm(angle, axis=1)[:, None]
    return film, np.column_stack([angle * np.sinc(size / np.pi), np.cos(size)])


@pytest.mark.parametrize("rings", [6, 9, 13])
def test_repair_slides_vertices_along_the_film(rings: int) -> None:
    """None leaves a sphere by more than the chord of the longest edge does."""
    film, x = cap(rings)
    found, after = mend_triangles(film, x)
    longest = np.linalg.norm(found.sides(after).edges, axis=2).max()
    off = np.abs(np.linalg.norm(after, axis=1) - 1)
    assert off.max() < longest**2 / 8
