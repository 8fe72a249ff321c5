"""Shapes follow each other: no rigid motion, no mirror, no jump."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.drawing import settled
from tests.helpers.shapes import disk_points, fitted_order, mesh_of, rotation
from tests.pictures.test_gallery import twisted


@pytest.fixture(scope="module")
def mesh() -> Disk:
    return mesh_of(*disk_points(6, jitter=0.2))


def test_alignment_undoes_every_rigid_motion(mesh: Disk) -> None:
    x = np.array([twisted(mesh, t) for t in (0.3, 0.4, 0.9)])
    turn = rotation()
    moved = np.array([x[0] @ turn, x[1] @ turn.T + 3.0, x[2] @ turn @ turn - 1.0])
    before = [None, 0, 1]
    still = settled(x, before, mesh.loop)
    assert np.abs(settled(moved, before, mesh.loop) - still).max() < 1e-12
    # None is deformed or mirrored.
    for place in range(3):
        assert np.allclose(gram(still[place]), gram(x[place]), atol=1e-12)
        assert volume(still[place], mesh) == pytest.approx(volume(x[place], mesh))


def gram(x: FloatArray) -> FloatArray:
    centred = x - x.mean(axis=0)
    products: FloatArray = centred @ centred.T
    return products


def volume(x: FloatArray, mesh: Disk) -> float:
    """Triple product of three loop chords: changes sign in the mirror."""
    p = x[mesh.loop[[0, 5, 17, 29]]]
    return float(np.linalg.det(p[1:] - p[0]))


def test_alignment_follows_a_film_that_turns_over_without_a_jump(mesh: Disk) -> None:
    """The longest move between neighbours is of first order in the step, to the end.

    On the way from disk to flat eight the two shorter principal axes change places.
    """
    sizes, moves = [], []
    for count in (10, 20, 40, 80):
        x = np.array([twisted(mesh, t) for t in np.linspace(0.0, 1.0, count + 1)])
        followed = settled(x, [None, *range(count)], mesh.loop)
        sizes.append(1.0 / count)
        moves.append(float(np.abs(np.diff(followed, axis=0)).max()))
    assert fitted_order(sizes, moves) == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("t", [0.05, 0.5, 0.9])
def test_a_film_and_its_mirror_image_stay_mirror_images(mesh: Disk, t: float) -> None:
    """Turned close to its mirror image a film keeps its hand: the sign of its volumes."""
    x = twisted(mesh, t) @ rotation()
    mirror = x * [1.0, 1.0, -1.0]
    for pair in ([x, mirror], [mirror, x]):
        followed = settled(np.array(pair), [None, 0], mesh.loop)
        for before, after in zip(pair, followed, strict=True):
            assert volume(after, mesh) == pytest.approx(volume(before, mesh))
            assert np.allclose(gram(after), gram(before), atol=1e-12)


def test_planar_films_are_turned_and_not_mirrored(mesh: Disk) -> None:
    """Distances do not tell a planar film's mirror image from half a turn of it."""
    flat = mesh.x * [1.0, 0.8, 0.0]
    followed = settled(np.array([flat, flat @ rotation()]), [None, 0], mesh.loop)
    assert np.abs(followed[1] - followed[0]).max() < 1e-12
