"""requirements.lock, pyproject.toml and the package's imports agree with each other."""

from __future__ import annotations

import ast
import sys
import tomllib
from importlib import metadata
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from tests.helpers.sources import statements

ROOT = Path(__file__).parents[2]
PYPROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
RUN: list[str] = PYPROJECT["project"]["dependencies"]
DEVELOP: list[str] = PYPROJECT["project"]["optional-dependencies"]["dev"]
BUILD: list[str] = PYPROJECT["build-system"]["requires"]
# Imported where there is one: what alone asks for it says so where it is missing.
OPTIONAL = {"aiohttp", "av", "distributed", "pandas", "pyarrow"}


def pins() -> dict[str, Requirement]:
    """Return the requirements of requirements.lock, those of this Python, by name."""
    lines = (ROOT / "requirements.lock").read_text().splitlines()
    found = [Requirement(line) for line in lines if not line.startswith("#")]
    return {
        canonicalize_name(pin.name): pin
        for pin in found
        if pin.marker is None or pin.marker.evaluate()
    }


def with_dependencies(wanted: list[str]) -> dict[str, list[Requirement]]:
    """Return all that `wanted` needs, in turn: each name with the demands made of it."""
    demands: dict[str, list[Requirement]] = {}
    waiting = [Requirement(text) for text in wanted]
    while waiting:
        demand = waiting.pop()
        if demand.marker is not None and not demand.marker.evaluate({"extra": ""}):
            continue
        name = canonicalize_name(demand.name)
        if name not in demands:
            waiting += [Requirement(text) for text in metadata.requires(name) or []]
        demands.setdefault(name, []).append(demand)
    return demands


def test_lock_pins_what_is_needed_and_nothing_else() -> None:
    demands = with_dependencies(RUN + DEVELOP + BUILD)
    assert pins().keys() == demands.keys()
    for name, pin in pins().items():
        (exact,) = pin.specifier
        assert exact.operator == "=="
        for demand in demands[name]:
            assert demand.specifier.contains(exact.version)


def test_package_imports_only_what_it_declares() -> None:
    named = []
    for path in (ROOT / "eulerplateau").rglob("*.py"):
        for node in statements(path):
            if isinstance(node, ast.Import):
                named += [alias.name for alias in node.names]
            else:
                named += [node.module or ""]
    foreign = {name.split(".")[0] for name in named} - sys.stdlib_module_names
    distributions = metadata.packages_distributions()
    assert foreign >= OPTIONAL
    imported = {
        canonicalize_name(distributions[name][0])
        for name in foreign - OPTIONAL - {"", "eulerplateau", "__future__"}
    }
    assert imported <= with_dependencies(RUN).keys()
