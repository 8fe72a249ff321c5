"""scripts/disk_thresholds: films on Gmsh's meshes against the theory of films.md."""

from __future__ import annotations

import numpy as np
import pytest

from scripts.studies.disk_thresholds.thresholds import CIRCLE, HEXAGON, Case, thresholds
from tests.helpers.marks import quick_with

PI3 = np.pi**3
SIZES = (0, 1, 2)


@pytest.mark.parametrize("mesh", quick_with(["Delaunay"], ["Delaunay", "Frontal-Delaunay"]))
def test_dirichlet_disk_converges_to_its_thresholds_at_second_order_on_any_mesh(
    mesh: str,
) -> None:
    """Across the plane to 96 pi^3, a soap film's; within it to 192 pi^3, four times it."""
    found = [thresholds(Case("dirichlet", CIRCLE, mesh, number)) for number in SIZES]
    sizes = np.log([t.n_b for t in found])
    for values, limit in (
        ([t.across for t in found], 96 * PI3),
        ([t.within for t in found], 192 * PI3),
    ):
        errors = np.log(np.abs(np.array(values) / limit - 1))
        assert -np.polyfit(sizes, errors, 1)[0] == pytest.approx(2.0, abs=0.15)
        assert errors[-1] < np.log(0.002)


def test_springs_on_a_lattice_are_the_dirichlet_film_with_2_sqrt_3_k() -> None:
    """In units of their effective tension they give way at the same threshold, exactly."""
    springs, exact = (
        thresholds(Case(film, HEXAGON, "lattice", 1)).across
        for film in ("springs", "dirichlet")
    )
    assert springs == pytest.approx(exact, rel=1e-9)
