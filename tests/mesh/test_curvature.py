"""Curvatures of the loop and of the film against exact surfaces."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from eulerplateau.mesh.curvature import (
    angle_defects,
    gauss_curvature_from_loop,
    loop_frame,
    total_gauss_curvature,
)
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.triangles import (
    area_vectors,
    unit,
)
from tests.helpers import shapes

RINGS = (8, 12, 16, 24, 32, 48)
SIZES = [1.0 / n for n in RINGS]


def enneper_mesh(rings: int, radius: float, jitter: float) -> Disk:
    points, triangles = shapes.disk_points(rings, jitter)
    return shapes.mesh_of(shapes.enneper(points, radius), triangles)


def saddle() -> Disk:
    return enneper_mesh(10, 0.8, 0.2)


def test_regular_polygon_has_the_kappa_of_its_circumscribed_chords() -> None:
    points, triangles = shapes.disk_points(5)
    mesh = shapes.mesh_of(points, triangles)
    n = mesh.n_b
    frame = loop_frame(mesh, mesh.x)
    np.testing.assert_allclose(frame.kappa, 2 * np.sin(np.pi / n) * n, rtol=1e-12)
    np.testing.assert_allclose(frame.kappa_g, frame.kappa, rtol=1e-12)
    np.testing.assert_allclose(frame.mean_lengths, 1.0 / n, rtol=1e-12)


def test_flat_hexagon_turns_by_60_degrees_at_its_corners_and_nowhere_else() -> None:
    points, triangles = shapes.hexagon_points(4)
    mesh = shapes.mesh_of(points, triangles)
    frame = loop_frame(mesh, mesh.x)
    corner = np.isclose(np.linalg.norm(points[mesh.loop], axis=1), 1.0)
    assert corner.sum() == 6
    np.testing.assert_allclose(frame.kappa_g * frame.mean_lengths, corner, atol=1e-12)
    np.testing.assert_allclose(frame.kappa_n, 0.0, atol=1e-12)
    np.testing.assert_allclose(frame.normal, [[0, 0, 1]] * mesh.n_b, atol=1e-12)
    np.testing.assert_allclose(frame.contact_angle, np.pi / 2, atol=1e-12)
    inward = -points[mesh.loop]
    assert ((frame.conormal[:, :2] * inward).sum(axis=1) > 0).all()


def test_frame_is_orthonormal_and_splits_the_curvature_vector() -> None:
    mesh = saddle()
    frame = loop_frame(mesh, shapes.crumpled(mesh, 0.01))
    axes = np.stack([frame.tangent, frame.normal, frame.conormal], axis=1)
    np.testing.assert_allclose(
        axes @ axes.transpose(0, 2, 1), np.broadcast_to(np.eye(3), axes.shape), atol=1e-12
    )
    np.testing.assert_allclose(np.linalg.det(axes), -1.0)  # T = N x t
    np.testing.assert_allclose(np.hypot(frame.kappa_n, frame.kappa_g), frame.kappa)
    np.testing.assert_allclose(np.cos(frame.contact_angle) * frame.kappa, frame.kappa_n)


def test_normal_is_exact_on_a_quadric_and_its_slope_is_not_that_of_the_triangles() -> None:
    points, triangles = shapes.disk_points(6, 0.2)
    u, v = points.T
    mesh = shapes.mesh_of(
        np.column_stack([u, v, 1e-4 * (u * u - v * v + u * v)]), triangles
    )
    normal = loop_frame(mesh, mesh.x).normal
    u, v = points[mesh.loop].T
    exact = unit(
        np.column_stack([-1e-4 * (2 * u + v), 1e-4 * (2 * v - u), np.ones_like(u)])
    )
    tangent = loop_frame(mesh, mesh.x).tangent
    conormal = np.cross(exact, tangent)
    # Only the slope across the loop is fitted; the other follows from the loop itself.
    np.testing.assert_allclose((normal * conormal).sum(axis=1), 0.0, atol=1e-4 * 1e-3)


@pytest.mark.parametrize("jitter", [0.0, 0.25])
@pytest.mark.parametrize("radius", [0.3, 0.5])
def test_gauss_curvature_from_the_loop_converges_at_second_order(
    radius: float, jitter: float
) -> None:
    exact = -4 * np.pi * radius**2 / (1 + radius**2)
    errors = []
    for rings in RINGS:
        mesh = enneper_mesh(rings, radius, jitter)
        errors.append(gauss_curvature_from_loop(mesh, mesh.x) - exact)
    assert shapes.fitted_order(SIZES, errors) == pytest.approx(2.0, abs=0.35)
    assert abs(errors[-1]) < 1e-3 * abs(exact)


@pytest.mark.parametrize("jitter", [0.0, 0.25])
def test_angle_defects_converge_to_the_loop_integral_at_first_order(jitter: float) -> None:
    gaps = []
    for rings in RINGS:
        points, triangles = shapes.disk_points(rings, jitter)
        mesh = shapes.mesh_of(shapes.eight(points, 0.4), triangles)
        gaps.append(
            gauss_curvature_from_loop(mesh, mesh.x) - total_gauss_curvature(mesh, mesh.x)
        )
    assert shapes.fitted_order(SIZES, gaps) == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("jitter", [0.0, 0.25])
def test_contour_integral_of_abs_kappa_n_converges_at_second_order(jitter: float) -> None:
    radius = 0.5
    exact = 8 * radius / (1 + radius**2)
    errors = []
    for rings in RINGS:
        mesh = enneper_mesh(rings, radius, jitter)
        frame = loop_frame(mesh, mesh.x)
        errors.append(np.abs(frame.kappa_n) @ frame.mean_lengths - exact)
    assert shapes.fitted_order(SIZES, errors) == pytest.approx(2.0, abs=0.2)


def test_spherical_cap_has_uniform_kappa_n_contact_angle_and_gauss_curvature() -> None:
    opening = 1.0
    errors = []
    for rings in RINGS:
        points, triangles = shapes.disk_points(rings)
        mesh = shapes.mesh_of(shapes.cap(points, opening), triangles)
        frame = loop_frame(mesh, mesh.x)
        # Outward normal, so the curvature vector lies on its far side: cos = -sin(opening).
        off_angle = np.abs(frame.contact_angle - (np.pi / 2 + opening)).max()
        off_normal = np.abs(frame.kappa_n / mesh.length + 1.0).max()
        exact = 2 * np.pi * (1 - np.cos(opening))
        off_gauss = abs(gauss_curvature_from_loop(mesh, mesh.x) - exact)
        errors.append((off_angle, off_normal, off_gauss))
    for column in np.array(errors).T:
        assert shapes.fitted_order(SIZES, list(column)) > 1.8


def test_kappa_n_of_the_eight_follows_the_paper_to_third_order_in_t() -> None:
    """The paper's expansion in t of kappa_n; what is left over must fall as t^5."""
    points, triangles = shapes.disk_points(64)
    phi = np.arctan2(*points[shapes.mesh_of(points, triangles).loop].T[::-1])
    leftover, amplitudes = [], [0.4, 0.3, 0.2]
    for t in amplitudes:
        mesh = shapes.mesh_of(shapes.eight(points, t), triangles)
        kappa_n = loop_frame(mesh, mesh.x).kappa_n / mesh.length
        series = -2 * t * np.sin(2 * phi)
        series += 2 * t**3 * (3 * np.sin(2 * phi) - np.sin(4 * phi) + np.sin(6 * phi))
        leftover.append(float(np.sqrt(np.mean((kappa_n - series) ** 2))))
    assert shapes.fitted_order(amplitudes, leftover) == pytest.approx(5.0, abs=0.6)


def test_eight_has_minus_four_pi_t_squared_of_gauss_curvature_near_t_0() -> None:
    points, triangles = shapes.disk_points(64)
    t = 0.02
    mesh = shapes.mesh_of(shapes.eight(points, t), triangles)
    flat = shapes.mesh_of(points, triangles)
    # The chords of a flat loop miss 2 pi by a little; that is no curvature of the film.
    bias = gauss_curvature_from_loop(flat, flat.x)
    curvature = gauss_curvature_from_loop(mesh, mesh.x) - bias
    assert curvature == pytest.approx(-4 * np.pi * t**2, rel=0.01)


def test_gauss_bonnet_with_angle_sums_holds_on_a_crumple_and_tests_only_the_code() -> None:
    mesh = saddle()
    for size in (0.0, 0.01, 1.0):
        assert angle_defects(mesh, shapes.crumpled(mesh, size)).sum() == pytest.approx(
            2 * np.pi, abs=1e-10
        )


def test_trimesh_finds_the_same_interior_angle_defects() -> None:
    import trimesh

    mesh = saddle()
    x = shapes.crumpled(mesh, 0.003)
    other = trimesh.Trimesh(x, mesh.triangles, process=False)
    np.testing.assert_allclose(
        angle_defects(mesh, x)[mesh.interior],
        other.vertex_defects[mesh.interior],
        atol=1e-7,
    )


def test_flat_disk_has_no_defects_inside_and_its_turning_angles_on_the_loop() -> None:
    points, triangles = shapes.disk_points(6, 0.2)
    mesh = shapes.mesh_of(points, triangles)
    defects = angle_defects(mesh, mesh.x)
    frame = loop_frame(mesh, mesh.x)
    np.testing.assert_allclose(defects[mesh.interior], 0.0, atol=1e-12)
    turning = 2 * np.arcsin(0.5 * frame.kappa * frame.mean_lengths)
    np.testing.assert_allclose(defects[mesh.loop], turning, atol=1e-10)


def test_area_of_a_hexagon_is_exact() -> None:
    points, triangles = shapes.hexagon_points(7)
    areas = np.linalg.norm(area_vectors(triangles, shapes.flat(points)), axis=1)
    assert areas.sum() == pytest.approx(1.5 * np.sqrt(3), rel=1e-13)


def test_rigid_motions_carry_the_frame_along_and_leave_the_curvatures() -> None:
    mesh = saddle()
    q = shapes.rotation()
    here = loop_frame(mesh, mesh.x)
    there = loop_frame(mesh, mesh.x @ q.T + [1.0, -2.0, 0.5])
    for name in ("tangent", "normal", "conormal", "kappa_vec"):
        np.testing.assert_allclose(
            getattr(there, name), getattr(here, name) @ q.T, atol=1e-9
        )
    for name in ("kappa", "kappa_n", "kappa_g", "contact_angle"):
        np.testing.assert_allclose(getattr(there, name), getattr(here, name), atol=1e-9)


def test_scaling_lengths_by_a_divides_curvatures_by_a_and_keeps_angles() -> None:
    mesh = saddle()
    scaled = replace(mesh, x=7.0 * mesh.x, rest_lengths=7.0 * mesh.rest_lengths)
    here, there = loop_frame(mesh, mesh.x), loop_frame(scaled, scaled.x)
    np.testing.assert_allclose(7.0 * there.kappa_n, here.kappa_n, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(7.0 * there.kappa_g, here.kappa_g, rtol=1e-9)
    np.testing.assert_allclose(there.contact_angle, here.contact_angle, rtol=1e-9)
    np.testing.assert_allclose(
        angle_defects(scaled, scaled.x), angle_defects(mesh, mesh.x), atol=1e-12
    )


def test_turning_the_film_over_flips_kappa_n_and_keeps_kappa_g() -> None:
    mesh = saddle()
    over = Disk.from_triangles(mesh.x, mesh.triangles[:, ::-1])
    here, there = loop_frame(mesh, mesh.x), loop_frame(over, over.x)
    place, other = np.argsort(mesh.loop), np.argsort(over.loop)
    np.testing.assert_allclose(there.kappa_n[other], -here.kappa_n[place], atol=1e-9)
    np.testing.assert_allclose(there.kappa_g[other], here.kappa_g[place], atol=1e-9)
    np.testing.assert_allclose(
        there.contact_angle[other], np.pi - here.contact_angle[place], atol=1e-9
    )


def test_smallest_disks_and_straight_or_reversing_loops_stay_finite() -> None:
    triangle = shapes.mesh_of(np.array([[0.0, 0], [1, 0], [0, 1]]), np.array([[0, 1, 2]]))
    np.testing.assert_allclose(loop_frame(triangle, triangle.x).normal, [[0, 0, 1]] * 3)
    square = shapes.mesh_of(
        np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]), np.array([[0, 1, 2], [0, 2, 3]])
    )
    folded = square.x[[0, 1, 2, 1]]
    frame = loop_frame(square, folded)
    for values in vars(frame).values():
        assert np.isfinite(values).all()
