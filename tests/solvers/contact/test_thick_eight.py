"""The twisted eight in contact on meshes, against the one that needs no mesh."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.conformal import thick_eight
from eulerplateau.branches.conformal.contact_eight import touching
from eulerplateau.mesh import Shape, unit
from eulerplateau.solvers import Equilibrium, Problem, solve
from scripts.studies.contact_eight.on_meshes import (
    EDGES,
    along,
    eight_on,
    limit,
    off,
    orders,
    round_disk,
)
from tests.helpers import shapes

ROD = (2 / 3, 1.0)


def largest_fold(shape: Shape) -> float:
    """The largest angle between the normals of neighbouring triangles, degrees."""
    triangles, x = shape.triangles, shape.x
    a, b, c = x[triangles].transpose(1, 0, 2)
    normals = unit(np.cross(b - a, c - a))
    sides = np.sort(np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)]), 1)
    order = np.lexsort(sides.T)
    same = np.flatnonzero((np.diff(sides[order], axis=0) == 0).all(axis=1))
    one, other = (normals[order[same + k] % len(triangles)] for k in (0, 1))
    cosines: FloatArray = (one * other).sum(axis=1)
    return float(np.degrees(np.arccos(np.clip(cosines.min(), -1.0, 1.0))))


def test_strands_push_with_the_slope_of_the_mesh_s_energy_in_the_diameter() -> None:
    load, d, h = 2000.0, 0.08, 2e-4
    mesh = shapes.mesh_of(*shapes.disk_points(6))
    rough = touching({"load": load, "diameter": d, "twist_ratio": 0.0, "link": 0.0})
    loop = along(rough.family.film(rough.point), np.arange(mesh.n_b) / mesh.n_b)
    tied = Problem(mesh).tied_film()
    assert tied is not None

    def at(diameter: float, start: Shape | Equilibrium) -> Equilibrium:
        return solve(Problem(mesh, "area", diameter=diameter), load, start)

    found = at(d, tied.shape(loop))
    assert found.is_minimum
    assert found.contacts is not None
    assert len(found.contacts) == 1
    slope = (at(d + h, found).energy - at(d - h, found).energy) / (2 * h)
    assert found.contacts.force == pytest.approx(slope, rel=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("rod", [(0.0, 0.0), ROD])
@pytest.mark.parametrize(("diameter", "load"), [(0.05, 1700), (0.05, 2500), (0.02, 1700)])
def test_meshes_converge_to_the_film_without_one(
    diameter: float, load: float, rod: tuple[float, float]
) -> None:
    exact = thick_eight(load, diameter, *rod)
    rows = [off(eight_on(round_disk(edges), exact), exact) for edges in EDGES]
    assert {row.n_unstable for row in rows} == {exact.n_unstable}
    np.testing.assert_allclose(orders(rows), 2.0, atol=0.1)
    assert abs(rows[-1].force) < 1e-2
    assert abs(rows[-1].angle) < 0.3
    energy, force, angle = limit(rows)
    assert abs(energy) < 1e-5
    assert abs(force) < 1e-3
    assert abs(angle) < 0.01


@pytest.mark.slow
@pytest.mark.parametrize("edges", [60, 120])
def test_where_vertices_lie_at_the_contact_hardly_matters(edges: int) -> None:
    """Strands touch at vertices, between them, or in the middle of edges."""
    exact, mesh = thick_eight(1700.0, 0.02), round_disk(edges)
    rows = [off(eight_on(mesh, exact, shift), exact) for shift in (0.0, 0.3, 0.5)]
    assert {row.n_unstable for row in rows} == {exact.n_unstable}
    errors = np.array([row.numbers for row in rows])
    # The same error, of the loop's bends and of its film, not of the place of contact.
    assert (np.ptp(errors, axis=0) < 0.05 * np.abs(errors).min(axis=0)).all()


@pytest.mark.slow
@pytest.mark.parametrize("diameter", [0.05, 0.02])
def test_the_film_between_the_strands_is_no_crumple(diameter: float) -> None:
    """Triangles of a smooth surface meet at angles as small as they are."""
    exact = thick_eight(1700.0, diameter)
    films = [eight_on(round_disk(edges), exact) for edges in (60, 120)]
    coarse, fine = (largest_fold(film.shape) for film in films)
    assert fine < 0.75 * coarse
    areas = [film.film_energy / film.load / exact.film.area - 1 for film in films]
    assert abs(areas[1]) < 0.3 * abs(areas[0])
