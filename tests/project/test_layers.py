"""The architecture: imports point only down the layers; what is not used is not loaded."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from graphlib import TopologicalSorter
from importlib.util import resolve_name
from pathlib import Path

import pytest

import eulerplateau
from tests.helpers.sources import statements, tree

# The rooms of docs/architecture.md from the ground up.
ROOMS = (
    "ground",
    "exact",
    "loop",
    "mesh",
    "film",
    "solvers",
    "branches",
    "cells",
    "runs",
    "pictures",
    "live",
)
LEVEL = {room: level for level, room in enumerate([*ROOMS, "cli"])}
GROUND = {
    "__init__",
    "__main__",
    "arrays",
    "compiling",
    "errors",
    "interruption",
    "lapack",
    "settings",
    "threads",
    "units",
}
# Compiled loops that other rooms call: numba wants what calls each other in one file.
SHARED_KERNELS = {"eulerplateau.loop.kernels", "eulerplateau.loop.slide_kernels"}

_FUNCTIONS = ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda
NUMERICS = {"numba", "numpy", "scipy"}
HEAVY = {
    "aiohttp",
    "gmsh",
    "matplotlib",
    "meshio",
    "pyvista",
    "trimesh",
    "vtk",
    "vtkmodules",
}

ROOT = Path(eulerplateau.__file__).parent


def module_name(path: Path) -> str:
    """Return the dotted name of a file of the package."""
    parts = path.relative_to(ROOT.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


FILES = {module_name(path): path for path in sorted(ROOT.rglob("*.py"))}


LIBRARY = ", ".join(module for module in FILES if not module.endswith("__main__"))

# Arguments of python, and what the run must not load.
LIGHT_RUNS = [
    pytest.param(["-c", "import eulerplateau"], NUMERICS | HEAVY, id="package"),
    pytest.param(["-c", f"import {LIBRARY}"], HEAVY, id="every module"),
    pytest.param(["-m", "eulerplateau", "--help"], NUMERICS | HEAVY, id="help"),
]


def room(module: str) -> str:
    """Return the room a dotted name of the package belongs to."""
    part = [*module.split("."), "__init__"][1]
    return "ground" if part in GROUND else part


def imports(node: ast.AST, package: str) -> Iterator[str]:
    """Yield the dotted names, module or not, that one statement imports."""
    if isinstance(node, ast.Import):
        yield from (alias.name for alias in node.names)
    elif isinstance(node, ast.ImportFrom):
        base = resolve_name("." * node.level + (node.module or ""), package)
        yield from (f"{base}.{alias.name}" for alias in node.names)


@cache
def targets(module: str) -> set[str]:
    """Return the modules of the package that `module` imports, in its functions too."""
    path = FILES[module]
    package = module if path.name == "__init__.py" else module.rpartition(".")[0]
    names = (
        name
        for node in statements(path)
        for name in imports(node, package)
        if name.split(".")[0] == "eulerplateau"
    )
    return {name if name in FILES else name.rpartition(".")[0] for name in names}


def loaded_at_import(node: ast.AST) -> Iterator[ast.AST]:
    """Yield what runs when a module is imported: not functions, not `if TYPE_CHECKING`."""
    for child in ast.iter_child_nodes(node):
        typing_only = isinstance(child, ast.If) and "TYPE_CHECKING" in ast.dump(child.test)
        if not isinstance(child, _FUNCTIONS) and not typing_only:
            yield child
            yield from loaded_at_import(child)


def test_rooms_are_the_folders_and_the_ground_is_nine_files() -> None:
    assert {room(module) for module in FILES} == LEVEL.keys()
    assert {path.stem for path in ROOT.glob("*.py")} == GROUND


def entrance(module: str) -> bool:
    """Whether this is where the program begins: it may call what stands above it."""
    return module == "eulerplateau.__main__"


def test_imports_never_point_up() -> None:
    for module in FILES:
        level = LEVEL[room(module)]
        above = {target for target in targets(module) if LEVEL[room(target)] > level}
        assert above == set() or entrance(module), module


def test_other_rooms_are_reached_through_their_faces() -> None:
    for module in FILES:
        others = {t for t in targets(module) if room(t) not in ("ground", room(module))}
        behind = {t for t in others - SHARED_KERNELS if FILES[t].name != "__init__.py"}
        assert behind == set(), module


def behind_the_faces() -> dict[str, set[str]]:
    """Return what every module imports, its functions included, faces looked through."""
    shown = {
        (".".join(path.parent.relative_to(ROOT.parent).parts), alias.name): node.module
        or ""
        for path in ROOT.rglob("__init__.pyi")
        for node in tree(path).body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }

    def home(module: str, name: str) -> str:
        while (module, name) in shown:
            module = f"{module}.{shown[module, name]}"
        return f"{module}.{name}" if f"{module}.{name}" in FILES else module

    def own(node: ast.AST) -> bool:
        named = node.module if isinstance(node, ast.ImportFrom) else None
        return (named or "").split(".")[0] == "eulerplateau"

    graph = {}
    for module, path in FILES.items():
        ours = [node for node in statements(path) if own(node)]
        homes = {home(node.module, alias.name) for node in ours for alias in node.names}
        graph[module] = homes - {module}
    return graph


def test_no_chain_of_imports_from_file_to_file_is_longer_than_16() -> None:
    graph = behind_the_faces()
    length: dict[str, int] = {}
    for module in TopologicalSorter(graph).static_order():
        below = [length[other] for other in graph.get(module, ()) if other in length]
        length[module] = 1 + max(below, default=0)
    assert max(length.values()) <= 16


def test_no_file_is_longer_than_300_lines() -> None:
    lines = {name: len(path.read_text().splitlines()) for name, path in FILES.items()}
    assert {name: length for name, length in lines.items() if length > 300} == {}


def test_imports_never_run_in_a_circle() -> None:
    # Raises CycleError, which names the circle.
    TopologicalSorter({module: targets(module) for module in FILES}).prepare()


def test_heavy_libraries_are_imported_where_they_are_used() -> None:
    for module, path in FILES.items():
        names = {
            name for node in loaded_at_import(tree(path)) for name in imports(node, module)
        }
        assert {name.split(".")[0] for name in names} & HEAVY == set(), module


@pytest.mark.parametrize(("arguments", "unwanted"), LIGHT_RUNS)
def test_a_run_does_not_load_what_it_does_not_use(
    arguments: list[str], unwanted: set[str]
) -> None:
    run = subprocess.run(
        [sys.executable, "-X", "importtime", *arguments],
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stderr
    # Lines of "import time: self [us] | cumulative | indented name".
    loaded = {
        line.rpartition("|")[2].strip().split(".")[0]
        for line in run.stderr.splitlines()
        if line.startswith("import time:")
    }
    assert "eulerplateau" in loaded
    assert loaded & unwanted == set()
