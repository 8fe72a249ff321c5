"""Finer triangles near places of a film: which edges, and that it stays the same."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.film import EdgeSizes, Finer, make_film
from eulerplateau.film.refinement import refined, with_cut_loop
from eulerplateau.film.tiling import Tiling
from eulerplateau.mesh import Disk
from eulerplateau.mesh.disk import trace_disk
from tests.helpers import shapes

MESH = shapes.mesh_of(*shapes.disk_points(8))
PLACES = np.array([[0.02, 0.01, 0.0], [-0.05, 0.0, 0.0]])
FINEST = 0.003
MANY = 10_000
UNCUT = np.ones(MESH.n_b, dtype=np.int64)
AS_FINE = Finer(EdgeSizes(PLACES, FINEST), UNCUT, MESH.shape.x_loop, MANY)
# All kinds, and next to each other.
PARTS = np.resize([1, 2, 4, 1, 1, 8], MESH.n_b)


def tiling_of(mesh: Disk) -> Tiling:
    return Tiling(mesh.triangles, mesh.loop, mesh.interior)


def finer(mesh: Disk, x: FloatArray, most: int = MANY) -> tuple[Tiling, FloatArray]:
    return refined(tiling_of(mesh), x, EdgeSizes(PLACES, FINEST), most)


def saddle(x: FloatArray) -> FloatArray:
    return np.column_stack([x[:, 0], x[:, 1], 8 * x[:, 0] * x[:, 1]])


def cut(mesh: Disk, parts: IntArray) -> tuple[Tiling, FloatArray]:
    """A mesh's film on its loop with edges in parts."""
    start = mesh.x[mesh.loop]
    step = np.repeat((np.roll(start, -1, axis=0) - start) / parts[:, None], parts, axis=0)
    past = np.concatenate([np.arange(m) for m in parts])
    x_loop = np.repeat(start, parts, axis=0) + past[:, None] * step
    finer = Finer(EdgeSizes(PLACES, FINEST), parts, x_loop, MANY)
    return with_cut_loop(tiling_of(mesh), mesh.x, finer)


@pytest.mark.parametrize("bent", [pytest.param(False, marks=pytest.mark.slow), True])
def test_a_refined_film_is_a_disk_on_the_same_loop(bent: bool) -> None:
    x = saddle(MESH.x) if bent else MESH.x
    tiling, after = finer(MESH, x)
    assert tiling.n_v == len(after) > MESH.n_v
    assert trace_disk(len(after), tiling.triangles).tolist() == MESH.loop.tolist()
    assert tiling.loop.tolist() == MESH.loop.tolist()
    assert after[MESH.loop].tolist() == x[MESH.loop].tolist()
    inside = np.setdiff1d(np.arange(len(after)), MESH.loop)
    assert tiling.interior.tolist() == inside.tolist()


def test_a_flat_film_keeps_its_area_and_no_triangle_is_turned_over() -> None:
    tiling, after = finer(MESH, MESH.x)
    sides, before = tiling.sides(after), tiling_of(MESH).sides(MESH.x)
    assert sides.areas.sum() == pytest.approx(before.areas.sum(), rel=1e-13)
    assert (sides.normals @ before.normals[0] > 0.99).all()


def test_edges_inside_are_as_short_as_they_should_be() -> None:
    """From the loop inwards they need not be shorter than 0.7 of its own."""
    tiling, x = finer(MESH, MESH.x)
    disk = MESH.with_triangles(tiling.triangles)
    one, other = x[disk.interior_edges.T]
    lengths = np.linalg.norm(one - other, axis=1)
    middles = 0.5 * (one + other)
    sizes = EdgeSizes(PLACES, FINEST).at(middles)
    at_loop = np.isin(disk.interior_edges, disk.loop).any(axis=1)
    allowed = np.maximum(sizes, np.where(at_loop, 0.7 * disk.rest_lengths.mean(), 0.0))
    assert (lengths <= 1.3 * allowed).all()
    near = np.linalg.norm(middles[:, None] - PLACES, axis=2).min(axis=1) < FINEST
    assert np.median(lengths[near]) < FINEST


def test_edges_grow_in_proportion_to_their_distance() -> None:
    sizes = EdgeSizes(PLACES[:1], FINEST)
    away = PLACES[0] + np.outer([0.1, 0.2, 0.4], [0.0, 0.0, 1.0])
    close, middling, far = sizes.at(away)
    assert sizes.at(PLACES)[0] == FINEST
    assert middling / close == pytest.approx(2.0)
    assert far / close == pytest.approx(4.0)


def test_what_is_fine_enough_is_left_alone_and_what_would_be_too_much_not_begun() -> None:
    tiling, x = finer(MESH, MESH.x)
    again, same = refined(tiling, x, EdgeSizes(PLACES, FINEST), MANY)
    assert again is tiling
    assert same is x
    assert finer(MESH, MESH.x, MESH.n_v)[0].n_v == MESH.n_v
    assert finer(MESH, MESH.x, MESH.n_v + 60)[0].n_v <= MESH.n_v + 60


def test_a_soap_film_has_shapes_of_its_mesh_and_finer_ones() -> None:
    film = make_film(MESH, "area")
    shape = film.refined(MESH.shape, AS_FINE)
    assert len(shape.x) > MESH.n_v
    for each in (shape, MESH.shape, shape):
        energy, gradient = film.energy_gradient(each, 2.0)
        assert energy == pytest.approx(film.energy_gradient(MESH.shape, 2.0)[0])
        assert gradient.shape == each.x.shape


@pytest.mark.parametrize("model", ["springs", "dirichlet"])
def test_films_tied_to_their_mesh_are_not_refined(model: str) -> None:
    film = make_film(MESH, model)
    assert film.refined(MESH.shape, AS_FINE) is MESH.shape


def test_a_film_kept_in_its_plane_is_not_refined() -> None:
    film = make_film(MESH, "area", in_plane=True)
    assert film.refined(MESH.shape, AS_FINE) is MESH.shape


def test_a_mesh_takes_finer_triangles_on_its_loop_and_its_own_again() -> None:
    tiling, _ = finer(MESH, MESH.x)
    disk = MESH.with_triangles(tiling.triangles)
    assert disk.n_v == tiling.n_v
    assert disk.x[MESH.loop].tolist() == MESH.x[MESH.loop].tolist()
    areas = tiling.sides(disk.x).areas
    assert areas.sum() == pytest.approx(tiling_of(MESH).sides(MESH.x).areas.sum())
    back = disk.with_triangles(MESH.triangles)
    np.testing.assert_array_equal(back.x, MESH.with_triangles(MESH.triangles).x)


def fan() -> Disk:
    """A square of two triangles with two edges of the loop each, in a ring of others."""
    return shapes.mesh_of(
        np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]]), [[0, 1, 2], [0, 2, 3]]
    )


@pytest.mark.parametrize(
    ("mesh", "parts"), [(MESH, PARTS), (fan(), np.array([2, 4, 1, 2]))]
)
def test_a_film_whose_loop_is_cut_is_a_disk_on_it_and_keeps_its_area(
    mesh: Disk, parts: IntArray
) -> None:
    """In a corner one triangle has two edges of the loop: both are cut."""
    tiling, x = cut(mesh, parts)
    assert tiling.n_v == len(x) == mesh.n_v + int((parts - 1).sum())
    assert trace_disk(len(x), tiling.triangles).tolist() == tiling.loop.tolist()
    assert mesh.parts(tiling.loop).tolist() == parts.tolist()
    assert sorted([*tiling.loop, *tiling.interior]) == list(range(tiling.n_v))
    sides = tiling.sides(x)
    before = tiling_of(mesh).sides(mesh.x)
    assert sides.areas.sum() == pytest.approx(before.areas.sum(), rel=1e-13)
    assert (sides.normals @ before.normals[0] > 0.99).all()


def test_a_film_whose_loop_stays_is_left_alone() -> None:
    tiling = tiling_of(MESH)
    assert with_cut_loop(tiling, MESH.x, AS_FINE)[0] is tiling


def test_a_mesh_takes_a_finer_loop_of_equal_parts_and_triangles_on_it() -> None:
    tiling, _ = cut(MESH, PARTS)
    disk = MESH.with_loop(tiling.loop).with_triangles(tiling.triangles)
    assert disk.n_b == PARTS.sum()
    assert disk.rest_lengths.sum() == pytest.approx(1.0, rel=1e-14)
    chords = np.roll(disk.x[disk.loop], -1, axis=0) - disk.x[disk.loop]
    lengths = np.linalg.norm(chords, axis=1)
    np.testing.assert_allclose(disk.rest_lengths, lengths, rtol=1e-11)
    areas = tiling.sides(disk.x).areas
    assert areas.sum() == pytest.approx(tiling_of(MESH).sides(MESH.x).areas.sum())
    assert MESH.with_loop(MESH.loop) is MESH
