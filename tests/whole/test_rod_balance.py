"""The loop as a rod in balance with its film: F' = -sigma T, and no net normal curvature.

The discrete loop stores E_b = sum_v |t_v - t_{v-1}|^2 / <s_v>, t_v = e_v / s_v, and its
lengths are kept by lambda_v c_v, c_v = (|e_v|^2 - s_v^2) / (2 s_v). Both depend on edge
vectors alone, so edge v carries the stress resultant

    F_v = d(E_b + lambda . c)/de_v = (2 / s_v) (K_v - K_{v+1}) + lambda_v t_v,

K_v = (t_v - t_{v-1}) / <s_v>: tension positive, and -2 K' + lambda t in the continuum, the
elastica's for the energy kappa^2 (rigidity 2). The rod's force on vertex v is the jump
F_v - F_{v-1}; the film pulls it with +sigma T <s_v>, T = N x t the conormal into the film,
so F' = -sigma T. Nothing of the area's gradient enters: T is from the loop's frame.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.branches import BranchPoint, FilmFamily
from eulerplateau.loop import Loop
from eulerplateau.mesh.curvature import LoopFrame, loop_frame
from eulerplateau.mesh.disk import Disk
from tests.helpers import shapes, soap_films

ANGLES = (0.0, 0.35, 0.7)


def two_lobed(mesh: Disk, angle: float) -> BranchPoint:
    planar = soap_films.two_lobed(mesh, 1750.0, angle)
    special = soap_films.twist_point(planar)
    return soap_films.twisted_from_two_lobed(special, 1700.0)


def disk(mesh: Disk, angle: float) -> BranchPoint:
    return soap_films.twisted_disk(mesh, 0.03, angle)


# A disk is soon twisted; the other film is followed for a second a ring and angle.
RINGS = {two_lobed: (6, 8, 11), disk: (6, 9, 13)}


def loop_of(point: BranchPoint) -> Loop:
    assert isinstance(point.family, FilmFamily)
    return point.family.problem.loop


def stress_resultant(point: BranchPoint) -> FloatArray:
    """F_v (n_b, 3), from bending and tensions."""
    loop = loop_of(point)
    tangent = loop.chords(point.x) / loop.rest_lengths[:, None]
    bend = (tangent - np.roll(tangent, 1, axis=0)) / loop.mean_lengths[:, None]
    shear = 2 * (bend - np.roll(bend, -1, axis=0)) / loop.rest_lengths[:, None]
    return shear + point.model.tensions[:, None] * tangent


def frame_of(point: BranchPoint, mesh: Disk) -> LoopFrame:
    return loop_frame(soap_films.mesh_of(point, mesh), soap_films.shape(point).x)


def imbalance(point: BranchPoint, frame: LoopFrame) -> tuple[float, float]:
    """Relative errors of F' = -sigma T: of F itself, and of F' along T, both at worst."""
    force = stress_resultant(point)
    jump = force - np.roll(force, 1, axis=0)
    left = jump / point.value + frame.conormal * frame.mean_lengths[:, None]
    summed = np.cumsum(left, axis=0)
    summed -= summed.mean(axis=0)
    inwards = (left * frame.conormal).sum(axis=1) / frame.mean_lengths
    return float(np.abs(summed).max()), float(np.abs(inwards).max())


@pytest.mark.parametrize("leave", [two_lobed, disk])
@pytest.mark.parametrize("even", [True, False], ids=["even", "uneven"])
def test_rod_balances_the_films_pull_at_second_order(
    leave: Callable[[Disk, float], BranchPoint], even: bool
) -> None:
    """On the branches that leave the two-lobed film, and the disk at 96 pi^3; and no net
    normal curvature, to the second order at least, over three ways the film may lie."""
    forces, pulls, curvatures = [], [], []
    for rings in RINGS[leave]:
        mesh = soap_films.irregular_disk(rings)
        if not even:
            mesh = shapes.mesh_of(*shapes.disk_points(rings, jitter=0.15))
        found = []
        for angle in ANGLES:
            point = leave(mesh, angle)
            frame = frame_of(point, mesh)
            net = frame.kappa_n @ frame.mean_lengths
            found.append([*imbalance(point, frame), net])
            # Twisted, and far from flat: the net curvature is a sum that cancels.
            assert np.abs(frame.kappa_n) @ frame.mean_lengths > 0.7
            assert point.stability.n_unstable > 0
        for column, values in zip(
            (forces, pulls, curvatures), np.transpose(found), strict=True
        ):
            column.append(float(np.sqrt((values**2).mean())))
    sizes = [1 / rings for rings in RINGS[leave]]
    assert shapes.fitted_order(sizes, forces) == pytest.approx(2.0, abs=0.25)
    assert shapes.fitted_order(sizes, pulls) == pytest.approx(2.0, abs=0.25)
    assert shapes.fitted_order(sizes, curvatures) > 1.75


def test_moments_of_the_rod_balance_on_every_loop() -> None:
    """m_v = 2 t_v x K_v, m' = -t x F: an identity of the discrete rod, for any lambda."""
    mesh = soap_films.irregular_disk(6)
    point = disk(mesh, 0.2)
    loop = loop_of(point)
    tangent = loop.chords(point.x) / loop.rest_lengths[:, None]
    bend = (tangent - np.roll(tangent, 1, axis=0)) / loop.mean_lengths[:, None]
    moment = 2 * np.cross(tangent, bend)
    ahead = 2 * np.cross(tangent, np.roll(bend, -1, axis=0))
    # At vertex v + 1 the moment is the same from either of its edges.
    np.testing.assert_allclose(ahead, np.roll(moment, -1, axis=0), atol=1e-11)
    turn = np.cross(loop.chords(point.x), stress_resultant(point))
    np.testing.assert_allclose(ahead - moment, -turn, atol=1e-11)
