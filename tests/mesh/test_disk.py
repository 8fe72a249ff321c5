"""Disk: what it refuses, naming the culprit, and what it leaves unchanged."""

import numpy as np
import pytest

from eulerplateau.errors import MeshError
from eulerplateau.mesh.disk import (
    Disk,
)
from eulerplateau.mesh.triangles import (
    directed_edges,
)
from tests.helpers.shapes import hexagon_points

# A square with its centre: four triangles, counter-clockwise.
SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 0]], dtype=float)
FAN = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])


def moved(vertex, position):
    points = SQUARE.copy()
    points[vertex] = position
    return points


def annulus():
    angle = np.arange(6) * np.pi / 3
    ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    k, following = np.arange(6), (np.arange(6) + 1) % 6
    inner = np.stack([k, k + 6, following], axis=1)
    outer = np.stack([following, k + 6, following + 6], axis=1)
    return np.concatenate([ring, 2 * ring]), np.concatenate([inner, outer])


TETRAHEDRON = np.array([[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]])
# A triangle that touches the fan in vertex 1 only, and one edge to edge with it there.
BESIDE = np.concatenate([SQUARE, [[2, 0, 0], [2, 1, 0], [3, 0, 0], [1, 0, 1]]])

BAD_MESHES = {
    "points_not_in_space": (SQUARE[:, :2], FAN, "mesh", None),
    "no_triangles": (SQUARE, FAN[:0], "mesh", None),
    "quads": (SQUARE, [[0, 1, 2, 3]], "mesh", None),
    "nan": (moved(3, [0, np.nan, 0]), FAN, "vertex", 3),
    "infinity": (moved(2, [np.inf, 0, 0]), FAN, "vertex", 2),
    "vertex_number_too_large": (SQUARE, [*FAN[:3], [3, 0, 5]], "triangle", 3),
    "vertex_number_negative": (SQUARE, [[0, 1, -1], *FAN[1:]], "triangle", 0),
    "vertex_named_twice": (SQUARE, [*FAN[:2], [2, 2, 4], FAN[3]], "triangle", 2),
    "vertex_in_no_triangle": (BESIDE[:6], FAN, "vertex", 5),
    "three_triangles_at_an_edge": (
        BESIDE,
        [*FAN, [1, 0, 5], [0, 1, 6], [5, 0, 7], [6, 7, 8]],
        "edge",
        (0, 1),
    ),
    "flipped_triangle": (SQUARE, [*FAN[:3], [0, 3, 4]], "edge", (3, 4)),
    "same_triangle_twice": (SQUARE, [*FAN, FAN[0]], "edge", (4, 0)),
    "two_pieces": (
        np.concatenate([SQUARE, SQUARE + np.array([3, 0, 0])]),
        np.concatenate([FAN, FAN + 5]),
        "triangle",
        4,
    ),
    "joined_in_one_vertex": (BESIDE[:7], [*FAN, [1, 5, 6]], "triangle", 4),
    "closed": ([*SQUARE[[0, 1, 3]], [0, 0, 1]], TETRAHEDRON, "mesh", None),
    "two_loops": (*annulus(), "vertex", 6),
    "coincident_neighbours": (moved(1, SQUARE[0]), FAN, "edge", (0, 1)),
    "flat_triangle": (moved(4, [0.5, 0, 0]), FAN, "triangle", 0),
}


@pytest.mark.parametrize("case", BAD_MESHES)
def test_a_bad_mesh_is_refused_and_its_culprit_named(case):
    points, triangles, kind, index = BAD_MESHES[case]
    with pytest.raises(MeshError) as caught:
        Disk.from_triangles(points, triangles)
    assert (caught.value.kind, caught.value.index) == (kind, index)
    assert caught.value.exit_code == 3


def test_a_boundary_that_passes_a_vertex_twice_is_refused():
    # A strip of triangles bent round until its ends meet in vertex 0 alone.
    angle = np.arange(6) * np.pi / 3
    outer = np.stack([2 * np.cos(angle), 2 * np.sin(angle), 0 * angle], axis=1)
    inner = outer[1:] / 2
    points = np.concatenate([outer, inner])
    triangles = [[0, 1, 6]]
    for k in range(1, 5):
        triangles += [[k, k + 1, k + 5], [k + 1, k + 6, k + 5]]
    triangles += [[5, 0, 10]]
    with pytest.raises(MeshError) as caught:
        Disk.from_triangles(points, triangles)
    assert (caught.value.kind, caught.value.index) == ("vertex", 0)


def test_a_torus_with_a_hole_is_refused():
    n = 4
    i, j = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    u, v = 2 * np.pi * i.ravel() / n, 2 * np.pi * j.ravel() / n
    radius = 2 + np.cos(v)
    points = np.stack([radius * np.cos(u), radius * np.sin(u), np.sin(v)], axis=1)
    a, b = i * n + j, (i + 1) % n * n + j
    c, d = (i + 1) % n * n + (j + 1) % n, i * n + (j + 1) % n
    first = np.stack([a, b, c], axis=-1).reshape(-1, 3)
    second = np.stack([a, c, d], axis=-1).reshape(-1, 3)
    with pytest.raises(MeshError) as caught:
        Disk.from_triangles(points, np.concatenate([first, second])[1:])
    assert (caught.value.kind, caught.value.index) == ("mesh", None)


def test_the_loop_has_the_film_on_its_left():
    mesh = Disk.from_triangles(SQUARE, FAN)
    assert mesh.loop.tolist() == [0, 1, 2, 3]
    turned = Disk.from_triangles(SQUARE, FAN[:, ::-1])
    assert turned.loop.tolist() == [0, 3, 2, 1]
    border = np.stack([mesh.loop, np.roll(mesh.loop, -1)], axis=1)
    assert {tuple(e) for e in border} <= {tuple(e) for e in directed_edges(FAN)}


def test_edges_are_loop_and_interior_once_each():
    plane, triangles = hexagon_points(4)
    mesh = Disk.from_triangles(np.pad(plane, ((0, 0), (0, 1))), triangles)
    assert mesh.n_v - len(mesh.edges) + len(mesh.triangles) == 1
    assert len(mesh.edges) == len(np.unique(mesh.edges, axis=0))
    assert len(mesh.edges) - len(mesh.interior_edges) == mesh.n_b == 24
    assert len(mesh.interior) + mesh.n_b == mesh.n_v
    both_on_loop = np.isin(mesh.interior_edges, mesh.loop).all(axis=1)
    assert not both_on_loop.any()  # two triangles meet in each corner of this lattice


def test_lengths_are_scaled_by_the_loop_and_centred_on_it():
    mesh = Disk.from_triangles(SQUARE + np.array([10, -7, 3]), FAN)
    assert mesh.length == pytest.approx(4, rel=1e-15)
    np.testing.assert_allclose(mesh.rest_lengths, 0.25, rtol=1e-15)
    np.testing.assert_allclose(mesh.x[mesh.loop].mean(axis=0), 0, atol=1e-16)


@pytest.mark.parametrize("power", [-900, -30, 30, 900])
def test_a_power_of_two_of_the_unit_changes_no_bit(power):
    points = moved(4, [0.3, 0.6, 0.2])
    mesh = Disk.from_triangles(points, FAN)
    scaled = Disk.from_triangles(np.ldexp(points, power), FAN)
    assert scaled.digest == mesh.digest
    assert scaled.length == np.ldexp(mesh.length, power)


@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_the_unit_of_length_does_not_matter(unit):
    points = moved(4, [0.3, 0.6, 0.2])
    mesh = Disk.from_triangles(points, FAN)
    scaled = Disk.from_triangles(points * unit, FAN)
    np.testing.assert_allclose(scaled.x, mesh.x, rtol=0, atol=1e-15)
    assert scaled.length == pytest.approx(mesh.length * unit, rel=1e-14)


def test_slivers_are_no_error():
    Disk.from_triangles(moved(4, [0.5, 1e-8, 0]), FAN)


def test_the_digest_tells_meshes_apart():
    digests = {
        Disk.from_triangles(SQUARE, FAN).digest,
        Disk.from_triangles(moved(4, [0.5, 0.6, 0]), FAN).digest,
        Disk.from_triangles(SQUARE, np.roll(FAN, 1, axis=0)).digest,
    }
    assert len(digests) == 3


def test_the_mesh_keeps_its_own_triangles():
    triangles = FAN.copy()
    mesh = Disk.from_triangles(SQUARE, triangles)
    triangles[:] = 0
    assert mesh.triangles.tolist() == FAN.tolist()
