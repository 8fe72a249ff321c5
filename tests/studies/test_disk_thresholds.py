"""scripts/disk_thresholds.py: films on Gmsh's meshes against the theory of films.md."""

from __future__ import annotations

import sys
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

PI3 = np.pi**3
SIZES = (0, 1, 2)


@pytest.fixture(scope="module")
def script() -> ModuleType:
    path = Path(__file__).parents[2] / "scripts" / "disk_thresholds.py"
    spec = spec_from_file_location("disk_thresholds", path)
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    # A dataclass looks its module up by its name.
    sys.modules["disk_thresholds"] = module
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("mesh", ["Delaunay", "Frontal-Delaunay"])
def test_dirichlet_disk_converges_to_its_thresholds_at_second_order_on_any_mesh(
    script: ModuleType, mesh: str
) -> None:
    """Across the plane to 96 pi^3, a soap film's; within it to 192 pi^3, four times it."""
    found = [
        script.thresholds(script.Case("dirichlet", script.CIRCLE, mesh, number))
        for number in SIZES
    ]
    sizes = np.log([t.n_b for t in found])
    for values, limit in (
        ([t.across for t in found], 96 * PI3),
        ([t.within for t in found], 192 * PI3),
    ):
        errors = np.log(np.abs(np.array(values) / limit - 1))
        assert -np.polyfit(sizes, errors, 1)[0] == pytest.approx(2.0, abs=0.15)
        assert errors[-1] < np.log(0.002)


def test_springs_on_a_lattice_are_the_dirichlet_film_with_2_sqrt_3_k(
    script: ModuleType,
) -> None:
    """In units of their effective tension they give way at the same threshold, exactly."""
    springs, exact = (
        script.thresholds(script.Case(film, script.HEXAGON, "lattice", 1)).across
        for film in ("springs", "dirichlet")
    )
    assert springs == pytest.approx(exact, rel=1e-9)
