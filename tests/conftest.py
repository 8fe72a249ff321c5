"""Fixtures shared by the tests; everything here is made once.

What they need is imported in them: the process that only hands tests to others reads this.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from eulerplateau.mesh.disk import Disk
    from eulerplateau.solvers.problem import Problem

ROOT = Path(__file__).parents[1]

# Of what is imported and collected nothing is garbage, yet all of it would be looked at
# again and again; to look as often as Python does takes a hundredth of the time.
gc.disable()
gc.set_threshold(20_000)

# Files that ask one exploration, or the syntax trees of all files, a few seconds' work: one
# process has them all.
SHARING = (
    "test_exploration",
    "test_special",
    "test_continuation",
    "test_layers",
    "test_requirements",
    "test_seam",
)
# The longest files, so that on several cores none is left over at the end.
LONGEST = (
    "test_docs",
    "test_site",
    *SHARING,
    "test_comparison",
    "test_extreme_area",
    "test_render",
    "test_extreme_loads",
    "test_conjugate_gradient",
    "test_scaling",
    "test_generation",
    "test_pictures",
    "test_main",
    "test_extreme_meshes",
    "test_extreme_units",
    "test_extreme_starts",
    "test_shape",
    "test_variants",
    "test_conformal_film",
    "test_soap_branches",
    "test_rod_balance",
    "test_planar",
)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with the longest files."""
    gc.freeze()
    gc.enable()
    order = {stem: place for place, stem in enumerate(LONGEST)}
    items.sort(key=lambda item: order.get(item.path.stem, len(order)))


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Hand out tests by files, and files that share something together."""
    from xdist.scheduler import LoadFileScheduling

    class ByFiles(LoadFileScheduling):
        def _split_scope(self, nodeid: str) -> str:
            path = Path(super()._split_scope(nodeid))
            return str(path.parent if path.stem in SHARING else path)

    return ByFiles(config, log) if config.getoption("dist") == "loadfile" else None


@pytest.fixture(scope="session", autouse=True)
def _one_blas_thread() -> Iterator[None]:
    """Two threads that wait for each other slow small matrices down a hundredfold."""
    # Loaded before the threads are counted: scipy brings a BLAS of its own.
    import scipy.linalg  # noqa: F401
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1, user_api="blas"):
        yield


@pytest.fixture(scope="session")
def coarse_pictures() -> Iterator[None]:
    """Figures have fewer pixels from now on, and a text is parsed once for all of them.

    By itself matplotlib remembers 50 texts, of one figure's PNG or of PDFs and SVGs, and at
    one resolution: here it is that of PDF and SVG for all.
    """
    from matplotlib import rc_context
    from matplotlib.mathtext import MathTextParser

    from eulerplateau.pictures import figure

    dpi = 72
    parse = MathTextParser._parse_cached.__wrapped__
    parsed = lru_cache(None)(lambda kind, *text: parse(MathTextParser(kind), *text))
    # Of what a parser parses nothing depends on but its kind of output.
    kinds = {"vector": "path", "raster": "agg"}

    def parse_once(parser: Any, *text: Any) -> Any:
        return parsed(kinds[parser._output_type], *text)

    with pytest.MonkeyPatch.context() as patch, rc_context({"figure.dpi": dpi}):
        patch.setattr(figure, "_DPI", dpi)
        patch.setattr(MathTextParser, "_parse_cached", parse_once)
        yield


@pytest.fixture(scope="session")
def elongated() -> Disk:
    """The stored mesh of the paper's first experiment."""
    from eulerplateau.mesh import read_disk

    return read_disk(ROOT / "meshes" / "elongated.vtp")


@pytest.fixture(scope="session")
def hexagon() -> Disk:
    """The stored mesh of the paper's second experiment."""
    from eulerplateau.mesh import read_disk

    return read_disk(ROOT / "meshes" / "hexagon.vtp")


@pytest.fixture(scope="session")
def oval() -> Disk:
    """127 vertices without any symmetry, once and a half as long as wide."""
    from tests.helpers import shapes

    points, triangles = shapes.disk_points(6, jitter=0.2)
    return shapes.mesh_of(points * [1.5, 1.0], triangles)


@pytest.fixture(scope="session")
def oval_problem(oval: Disk) -> Problem:
    from eulerplateau.solvers.problem import Problem

    return Problem(oval)
