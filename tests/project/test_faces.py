"""What the package and its rooms show: names that stay what they are."""

from __future__ import annotations

import ast
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

import eulerplateau

ROOT = Path(eulerplateau.__file__).parent
STUBS = {
    ".".join(path.parent.relative_to(ROOT.parent).parts): path
    for path in sorted(ROOT.rglob("__init__.pyi"))
}

# Each name is read twice and with the module behind it imported in between, or before. The
# package is loaded anew for each of the two and for the front door and the rooms, the
# libraries it uses once.
READ = """
import gc, importlib, itertools, sys, types
gc.disable()  # what is unloaded would be looked through again and again
words = [word.split("=") for word in sys.argv[1:]]
places = {
    "front door": [word for word in words if word[0] == "eulerplateau"],
    "rooms": [word for word in words if word[0] != "eulerplateau"],
}
for (place, shown), before in itertools.product(places.items(), ("nothing", "behind")):
    for module in [name for name in sys.modules if name.split(".")[0] == "eulerplateau"]:
        del sys.modules[module]
    if before == "behind":
        for face, _, module in shown:
            importlib.import_module(f"{face}.{module}")
    for face, name, module in shown:
        package = importlib.import_module(face)
        first = getattr(package, name)
        importlib.import_module(f"{face}.{module}")
        assert getattr(package, name) is first, name
        assert not isinstance(first, types.ModuleType), name
        assert name in package.__all__, name
    print(place, before, sep="-")
"""


def shown(face: str) -> dict[str, str]:
    """Return the names of a face, each with the module behind it."""
    statements = ast.parse(STUBS[face].read_text()).body
    return {
        alias.name: statement.module or ""
        for statement in statements
        if isinstance(statement, ast.ImportFrom)
        for alias in statement.names
    }


@cache
def read() -> subprocess.CompletedProcess[str]:
    """Read all names of all faces in a process of its own."""
    words = [
        f"{face}={name}={module}" for face in STUBS for name, module in shown(face).items()
    ]
    command = [sys.executable, "-c", READ, *words]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.mark.parametrize("before", ["nothing", "behind"])
@pytest.mark.parametrize("place", ["front door", "rooms"])
def test_every_name_stays_what_it_is(place: str, before: str) -> None:
    done = read()
    assert f"{place}-{before}" in done.stdout.splitlines(), done.stderr


@pytest.mark.parametrize("face", STUBS)
def test_no_name_is_that_of_a_file_or_a_room(face: str) -> None:
    files = [path for path in STUBS[face].parent.iterdir() if path.suffix in (".py", "")]
    beside = {path.stem for path in files}
    assert shown(face).keys() & beside == set()


def test_the_front_door_shows_about_twenty_names() -> None:
    assert 18 <= len(eulerplateau.__all__) <= 24
    assert set(dir(eulerplateau)) == set(eulerplateau.__all__)
