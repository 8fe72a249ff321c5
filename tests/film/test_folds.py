"""Films on meshes that lie in folds are laid anew: their area is that of a sound mesh."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.film.folds import is_folded, laid_anew
from eulerplateau.film.tiling import Tiling
from eulerplateau.mesh import Disk, measure, polygon_area
from eulerplateau.solvers import Problem, Status, solve
from tests.helpers import shapes
from tests.helpers.marks import quick_with


def twins(rings: int, aspect: float, seed: int) -> tuple[Disk, Disk]:
    """Return a disk, and the same with its vertices inside thrown about."""
    points, triangles = shapes.disk_points(rings, jitter=0.1)
    points = points * [aspect, 1.0]
    sound = shapes.mesh_of(points, triangles)
    thrown = points.copy()
    shape = (len(sound.interior), 2)
    thrown[sound.interior] += np.random.default_rng(seed).normal(0.0, 1.5 / rings, shape)
    return sound, shapes.mesh_of(thrown, triangles)


@pytest.mark.parametrize("load", [2.0, 500.0, 1200.0])
@pytest.mark.parametrize(
    ("rings", "aspect"), quick_with([(3, 1.0), (4, 1.5)], [(3, 1.0), (4, 1.5), (5, 2.5)])
)
def test_folded_mesh_gives_the_film_of_its_sound_twin(
    rings: int, aspect: float, load: float
) -> None:
    sound, folded = (solve(Problem(mesh, "area"), load) for mesh in twins(rings, aspect, 0))
    assert sound.converged
    assert folded.converged
    # Flat films have no discretisation error, whatever their triangles.
    assert folded.energy == pytest.approx(sound.energy, rel=1e-9)


def test_film_in_its_plane_has_the_area_of_its_polygon() -> None:
    _, mesh = twins(4, 1.5, 1)
    found = solve(Problem(mesh, "area", in_plane=True), 300.0)
    assert found.converged
    area = measure(mesh, found.shape).area
    assert area == pytest.approx(found.film_energy / 300.0, rel=1e-12)
    assert area == pytest.approx(polygon_area(found.shape.x_loop[:, :2]), rel=1e-12)


def tiling_of(mesh: Disk) -> Tiling:
    return Tiling(mesh.triangles, mesh.loop, mesh.interior)


def test_folds_are_told_from_a_curved_film() -> None:
    sound, folded = twins(4, 1.0, 0)
    assert is_folded(tiling_of(folded), folded.x)
    assert not is_folded(tiling_of(sound), sound.x)
    # Half a sphere, then a whole one but for a hole: no two triangles lie on each other.
    for depth in (0.5 * np.pi, 0.9 * np.pi):
        radius = np.linalg.norm(sound.x, axis=1) / np.linalg.norm(sound.x, axis=1).max()
        outwards = np.arctan2(sound.x[:, 1], sound.x[:, 0])
        height = np.cos(depth * radius)
        width = np.sin(depth * radius)
        x = np.stack([width * np.cos(outwards), width * np.sin(outwards), height], axis=1)
        assert not is_folded(tiling_of(sound), x)


def test_film_is_laid_anew_without_folds_on_the_same_loop() -> None:
    _, folded = twins(6, 2.0, 2)
    tiling, x = laid_anew(tiling_of(folded), folded.x)
    assert not is_folded(tiling, x)
    np.testing.assert_array_equal(x[folded.loop], folded.x[folded.loop])
    flat = x[:, :2]
    areas = tiling.sides(x).areas
    assert areas.sum() == pytest.approx(polygon_area(flat[folded.loop]), rel=1e-12)


def test_film_across_a_loop_with_three_arms_in_space_is_laid_anew_and_mended() -> None:
    """Even weights alone leave folds there, where the loop bends inwards."""
    points, triangles = shapes.disk_points(4, jitter=0.1)
    radius, angle = np.hypot(*points.T), np.arctan2(points[:, 1], points[:, 0])
    height = 0.4 * radius**2 * np.cos(2 * angle)
    points = points * (1 + 0.5 * np.cos(3 * angle))[:, None]
    mesh = shapes.mesh_of(np.column_stack([points, height]), triangles)
    thrown = mesh.x.copy()
    size = (len(mesh.interior), 3)
    thrown[mesh.interior] += np.random.default_rng(0).normal(0.0, 0.05, size)
    assert is_folded(tiling_of(mesh), thrown)
    tiling, x = laid_anew(tiling_of(mesh), thrown)
    assert not is_folded(tiling, x)
    np.testing.assert_array_equal(x[mesh.loop], mesh.x[mesh.loop])


def test_film_that_lies_in_folds_is_not_called_converged() -> None:
    # Solvers lay such films anew: one has to be folded by hand.
    sound, folded = twins(4, 1.0, 0)
    problem = Problem(sound, "area")
    found = solve(problem, 10.0)
    bent = found.shape.moved(folded.x - folded.x.mean(axis=0))
    record = problem.equilibrium(bent, found.tensions, 10.0, Status.CONVERGED)
    assert problem.classified(record).status is Status.FOLDED
    assert problem.classified(found).status is Status.CONVERGED
