"""What a sweep records about a shape, against shapes whose answer is known."""

from __future__ import annotations

from dataclasses import asdict

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import MeshError
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.measures import (
    aspect,
    measure,
)
from eulerplateau.mesh.waist import (
    WaistPath,
    waist_path,
    waist_twist,
)
from tests.helpers import shapes

RINGS = (8, 12, 16, 24, 32, 48)
SIZES = [1.0 / n for n in RINGS]


def ellipse_mesh(rings: int, jitter: float = 0.2) -> Disk:
    """A 2 : 1 ellipse: its long axis is the one farthest pair of loop vertices."""
    points, triangles = shapes.disk_points(rings, jitter)
    return shapes.mesh_of(points * [2.0, 1.0], triangles)


def on_eight(mesh: Disk, t: float) -> FloatArray:
    """The ellipse laid on the surface of eq. eight, its long axis on φ = 0."""
    return shapes.eight(mesh.x[:, :2] / np.abs(mesh.x).max(axis=0)[:2], t)


def degrees(t: float) -> float:
    return 4.0 * float(np.degrees(np.arctan(t)))


def test_flat_hexagon_has_its_area_its_corners_and_nothing_else() -> None:
    mesh = shapes.mesh_of(*shapes.hexagon_points(5))
    found = measure(mesh, mesh.shape)
    assert found.area == pytest.approx(1.5 * np.sqrt(3) / 36, rel=1e-12)
    assert found.max_turning == pytest.approx(60.0, rel=1e-12)
    assert found.aspect == pytest.approx(1.0, rel=1e-12)
    assert found.self_intersections == 0
    for nothing in (found.abs_kappa_n, found.total_gauss_curvature, found.waist_twist):
        assert nothing == pytest.approx(0.0, abs=1e-11)


def test_enneper_surface_has_its_total_curvature_and_abs_kappa_n() -> None:
    radius = 0.5
    points, triangles = shapes.disk_points(48)
    mesh = shapes.mesh_of(shapes.enneper(points, radius), triangles)
    found = measure(mesh, mesh.shape)
    exact = -4 * np.pi * radius**2 / (1 + radius**2)
    assert found.abs_kappa_n == pytest.approx(8 * radius / (1 + radius**2), rel=2e-3)
    assert found.total_gauss_curvature == pytest.approx(exact, rel=0.05)
    assert np.isnan(found.waist_twist)  # the rest mesh is not planar


@pytest.mark.parametrize("turning", [1e-6, 30.0, 90.0, 179.0, 180.0])
def test_largest_turning_is_the_loops_angle_at_its_sharpest_vertex(turning: float) -> None:
    mesh = shapes.mesh_of(*shapes.disk_points(1))
    a = np.radians(turning)
    path = np.cumsum([[0, 0], [1, 0], [np.cos(a), np.sin(a)]], axis=0)
    x = mesh.x.copy()
    # Three vertices make the bend; the way back to the start turns by more unless a = 180.
    x[mesh.loop[:3], :2] = path
    far = np.array([[0.5, -1.0], [-0.5, -1.0], [-1.0, -0.5]])
    x[mesh.loop[3:], :2] = far
    edges = np.roll(x[mesh.loop], -1, axis=0) - x[mesh.loop]
    headings = np.degrees(np.arctan2(edges[:, 1], edges[:, 0]))
    expected = np.abs((headings - np.roll(headings, 1) + 180.0) % 360.0 - 180.0).max()
    found = measure(mesh, mesh.shape.moved(x)).max_turning
    assert found == pytest.approx(expected, abs=1e-5)


@pytest.mark.parametrize("ratio", [1.0, 0.9, 0.5, 0.01])
def test_aspect_of_an_affine_regular_polygon_is_exact_in_every_position(
    ratio: float,
) -> None:
    for points, triangles in (shapes.hexagon_points(4), shapes.disk_points(5)):
        mesh = shapes.mesh_of(points, triangles)
        x = shapes.flat(points * [ratio, 1.0]) @ shapes.rotation().T + 3.0
        assert aspect(mesh, x) == pytest.approx(ratio, rel=1e-10)


def test_aspect_of_a_flat_film_does_not_depend_on_its_inner_vertices() -> None:
    points, triangles = shapes.hexagon_points(4)
    mesh = shapes.mesh_of(points * [0.4, 1.0], triangles)
    x = mesh.x.copy()
    noise = np.random.default_rng(9).uniform(-0.005, 0.005, (len(mesh.interior), 2))
    x[mesh.interior, :2] += noise
    assert aspect(mesh, x) == pytest.approx(0.4, rel=1e-10)


def test_aspect_of_an_unevenly_sampled_ellipse_converges_at_second_order() -> None:
    errors = []
    for rings in RINGS:
        points, triangles = shapes.disk_points(rings)
        angle = np.arctan2(points[:, 1], points[:, 0])
        radius = np.hypot(*points.T)
        angle = angle + 0.3 * np.sin(2 * angle)
        uneven = np.column_stack([2 * radius * np.cos(angle), radius * np.sin(angle)])
        mesh = shapes.mesh_of(uneven, triangles)
        errors.append(aspect(mesh, mesh.x) - 0.5)
    assert shapes.fitted_order(SIZES, errors) == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize("jitter", [0.0, 0.2])
@pytest.mark.parametrize("t", [0.3, -0.6, 0.95])
def test_waist_twist_of_the_eight_converges_to_4_arctan_t_at_second_order(
    t: float, jitter: float
) -> None:
    errors = []
    for rings in RINGS:
        mesh = ellipse_mesh(rings, jitter)
        errors.append(waist_twist(waist_path(mesh), on_eight(mesh, t)) - degrees(t))
    assert shapes.fitted_order(SIZES, errors) == pytest.approx(2.0, abs=0.3)


def test_waist_twist_reaches_half_a_turn_as_the_eight_falls_flat() -> None:
    mesh = ellipse_mesh(32)
    for t in (0.99, 0.9999):
        twist = waist_twist(waist_path(mesh), on_eight(mesh, t))
        assert twist == pytest.approx(degrees(t), abs=0.1)
    assert abs(waist_twist(waist_path(mesh), on_eight(mesh, 1.0))) == pytest.approx(
        180, abs=0.1
    )


@pytest.mark.parametrize("turns", [-1.25, 0.4, 3.0])
def test_waist_twist_counts_full_turns_of_a_helicoid(turns: float) -> None:
    points, triangles = shapes.disk_points(48)
    mesh = shapes.mesh_of(points * [10.0, 1.0], triangles)
    along = points[:, 0]
    angle = np.pi * turns * along
    x = np.column_stack([along, points[:, 1] * np.cos(angle), points[:, 1] * np.sin(angle)])
    twist = waist_twist(waist_path(mesh), x)
    # The normals are those of the triangles' middles: the end ones miss up to one row.
    assert twist == pytest.approx(360.0 * turns, rel=1.5 / 48)


def test_waist_twist_is_unchanged_by_rigid_motion_turning_over_and_renumbering() -> None:
    mesh = ellipse_mesh(12)
    x = on_eight(mesh, 0.6)
    twist = waist_twist(waist_path(mesh), x)
    moved = 3.0 * x @ shapes.rotation().T + [1.0, 2.0, 3.0]
    assert waist_twist(waist_path(mesh), moved) == pytest.approx(twist, abs=1e-9)
    rng = np.random.default_rng(8)
    new = rng.permutation(mesh.n_v)
    shuffled = rng.permutation(len(mesh.triangles))
    old = np.argsort(new)
    for corners in (mesh.triangles, mesh.triangles[:, ::-1]):
        other = Disk.from_triangles(mesh.x[old], new[corners][shuffled])
        assert waist_twist(waist_path(other), x[old]) == pytest.approx(twist, abs=1e-9)


def test_waist_twist_changes_sign_in_a_mirror() -> None:
    mesh = ellipse_mesh(12)
    x = on_eight(mesh, 0.6)
    twist = waist_twist(waist_path(mesh), x)
    for axis in range(3):
        mirrored = x.copy()
        mirrored[:, axis] *= -1.0
        assert waist_twist(waist_path(mesh), mirrored) == pytest.approx(-twist, abs=1e-9)


def test_waist_path_crosses_from_tip_to_tip_without_a_gap_also_along_edges() -> None:
    hexagon, cells = shapes.hexagon_points(6)
    stretched = shapes.mesh_of(hexagon * [1.8, 1.0], cells)  # the line runs along edges
    for mesh in (stretched, ellipse_mesh(9)):
        path = waist_path(mesh)
        assert path is not None
        both = np.einsum("npc,ncd->npd", path.weights, mesh.x[path.corners])
        distances = mesh.x[mesh.loop][:, None] - mesh.x[mesh.loop]
        longest = np.linalg.norm(distances, axis=2).max()
        there, back = np.split(both, path.first[1:])
        for ends in (there, back):
            np.testing.assert_allclose(ends[1:, 0], ends[:-1, 1], atol=1e-9)
            span = np.linalg.norm(ends[-1, 1] - ends[0, 0])
            assert span == pytest.approx(longest, rel=1e-12)
        np.testing.assert_allclose(there[0, 0], back[-1, 1], atol=1e-9)
        assert (path.weights >= 0.0).all()
        np.testing.assert_allclose(path.weights.sum(axis=2), 1.0, rtol=1e-12)


def test_a_polygon_that_the_line_leaves_has_no_path_and_no_twist() -> None:
    # A strip bent into a half ring: its farthest vertices face one another across the gap.
    angle = np.linspace(0.0, 1.1 * np.pi, 25)
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    i = np.arange(24)
    quads = np.stack([i, i + 25, i + 26, i, i + 26, i + 1], axis=1)
    mesh = shapes.mesh_of(np.concatenate([ring, 1.2 * ring]), quads.reshape(-1, 3))
    assert waist_path(mesh) is None
    assert np.isnan(waist_twist(None, mesh.x))


def test_measures_are_invariant_under_rigid_motions() -> None:
    mesh = ellipse_mesh(10)
    shape = mesh.shape.moved(on_eight(mesh, 0.5) / 6.0)
    here = asdict(measure(mesh, shape))
    turned = shape.moved(shape.x @ shapes.rotation().T + [0.1, 0.2, 0.3])
    there = asdict(measure(mesh, turned))
    for name, value in here.items():
        assert there[name] == pytest.approx(value, rel=1e-8, abs=1e-9), name


def test_shape_that_is_not_finite_is_refused() -> None:
    mesh = ellipse_mesh(4)
    x = mesh.x.copy()
    x[7, 2] = np.nan
    with pytest.raises(MeshError) as caught:
        measure(mesh, mesh.shape.moved(x))
    assert caught.value.index == 7


def test_lines_of_a_waist_know_nothing_of_each_other() -> None:
    """Of the hexagon's six the twist is that of the one that twists most."""
    mesh = shapes.mesh_of(*shapes.hexagon_points(4))
    path = waist_path(mesh)
    assert path is not None
    assert len(path.first) > 2
    ends = [*path.first[1:], len(path.corners)]
    lines = [
        WaistPath(path.corners[a:b], path.weights[a:b], np.zeros(1, dtype=np.int64))
        for a, b in zip(path.first, ends, strict=True)
    ]
    for seed in range(5):
        noise = np.random.default_rng(seed).standard_normal(mesh.n_v)
        x = mesh.x + np.outer(0.05 * noise, [0.0, 0.0, 1.0])
        twists = [waist_twist(line, x) for line in lines]
        assert waist_twist(path, x) == max(twists, key=abs)
