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
from itertools import product

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.branches import BranchPoint, FilmFamily
from eulerplateau.loop import Loop
from eulerplateau.mesh.curvature import LoopFrame, loop_frame
from eulerplateau.mesh.disk import Disk
from tests.helpers import shapes, soap_films
from tests.helpers.conformal_films import twisted
from tests.helpers.marks import quick_with

# Of the film against its mesh: a sixth of a turn, or a twelfth, would be no different one.
ANGLE = 0.35


def two_lobed(mesh: Disk) -> BranchPoint:
    return soap_films.on_the_exact_loop(mesh, twisted(1700.0).film, ANGLE)


def disk(mesh: Disk) -> BranchPoint:
    return soap_films.twisted_disk(mesh, 0.03, ANGLE)


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
    """Relative errors of F' = -sigma T, r.m.s.: of F itself, and of F' along T."""
    force = stress_resultant(point)
    jump = force - np.roll(force, 1, axis=0)
    left = jump / point.value + frame.conormal * frame.mean_lengths[:, None]
    summed = np.cumsum(left, axis=0)
    summed -= summed.mean(axis=0)
    inwards = (left * frame.conormal).sum(axis=1) / frame.mean_lengths
    return (
        float(np.sqrt((summed**2).sum(axis=1).mean())),
        float(np.sqrt((inwards**2).mean())),
    )


@pytest.mark.parametrize(
    ("leave", "even"),
    quick_with(
        [(two_lobed, False), (disk, True)], product([two_lobed, disk], [True, False])
    ),
)
def test_rod_balances_the_films_pull_at_second_order(
    leave: Callable[[Disk], BranchPoint], even: bool
) -> None:
    """On the branches that leave the two-lobed film, and the disk at 96 pi^3.

    And no net normal curvature, to one part in as many as the loop has edges: what is left
    of it comes from where a mesh happens to put its vertices, and has no clear order.
    """
    forces, pulls = [], []
    for rings in RINGS[leave]:
        mesh = soap_films.irregular_disk(rings)
        if not even:
            mesh = shapes.mesh_of(*shapes.disk_points(rings, jitter=0.15))
        point = leave(mesh)
        frame = frame_of(point, mesh)
        for column, value in zip((forces, pulls), imbalance(point, frame), strict=True):
            column.append(value)
        # Twisted, and far from flat: the net curvature is a sum that cancels.
        bent = np.abs(frame.kappa_n) @ frame.mean_lengths
        assert bent > 0.7
        assert abs(frame.kappa_n @ frame.mean_lengths) < bent / mesh.n_b
        assert point.stability.n_unstable > 0
    sizes = [1 / rings for rings in RINGS[leave]]
    assert shapes.fitted_order(sizes, forces) == pytest.approx(2.0, abs=0.2)
    assert shapes.fitted_order(sizes, pulls) == pytest.approx(2.0, abs=0.2)


def test_moments_of_the_rod_balance_on_every_loop() -> None:
    """m_v = 2 t_v x K_v, m' = -t x F: an identity of the discrete rod, for any lambda."""
    mesh = soap_films.irregular_disk(6)
    point = disk(mesh)
    loop = loop_of(point)
    tangent = loop.chords(point.x) / loop.rest_lengths[:, None]
    bend = (tangent - np.roll(tangent, 1, axis=0)) / loop.mean_lengths[:, None]
    moment = 2 * np.cross(tangent, bend)
    ahead = 2 * np.cross(tangent, np.roll(bend, -1, axis=0))
    # At vertex v + 1 the moment is the same from either of its edges.
    np.testing.assert_allclose(ahead, np.roll(moment, -1, axis=0), atol=1e-11)
    turn = np.cross(loop.chords(point.x), stress_resultant(point))
    np.testing.assert_allclose(ahead - moment, -turn, atol=1e-11)
