"""Fixtures shared by the tests; everything here is made once."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

# Loaded before the threads are counted: scipy brings a BLAS of its own.
import scipy.linalg  # noqa: F401
from threadpoolctl import threadpool_limits

from eulerplateau.mesh import read_disk
from eulerplateau.mesh.disk import Disk
from eulerplateau.solvers.problem import Problem
from tests.helpers import shapes

ROOT = Path(__file__).parents[1]


# The longest files, so that on several cores none is left over at the end.
LONGEST = (
    "test_rod_balance",
    "test_generation",
    "test_docs",
    "test_comparison",
    "test_conjugate_gradient",
    "test_render",
    "test_main",
    "test_soap_branches",
    "test_exploration",
    "test_sweep",
    "test_extreme_meshes",
    "test_conformal_eight",
)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with the longest files."""
    items.sort(key=lambda item: item.path.stem not in LONGEST)


@pytest.fixture(scope="session", autouse=True)
def _one_blas_thread() -> Iterator[None]:
    """Two threads that wait for each other slow small matrices down a hundredfold."""
    with threadpool_limits(1, user_api="blas"):
        yield


@pytest.fixture(scope="session")
def elongated() -> Disk:
    """The stored mesh of the paper's first experiment."""
    return read_disk(ROOT / "meshes" / "elongated.vtp")


@pytest.fixture(scope="session")
def hexagon() -> Disk:
    """The stored mesh of the paper's second experiment."""
    return read_disk(ROOT / "meshes" / "hexagon.vtp")


@pytest.fixture(scope="session")
def oval() -> Disk:
    """127 vertices without any symmetry, once and a half as long as wide."""
    points, triangles = shapes.disk_points(6, jitter=0.2)
    return shapes.mesh_of(points * [1.5, 1.0], triangles)


@pytest.fixture(scope="session")
def oval_problem(oval: Disk) -> Problem:
    return Problem(oval)
