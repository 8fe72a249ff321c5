"""`eulerplateau doctor`: it says what is there, what is not, and what to do about it."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

import pytest

from eulerplateau.cli.doctor import Finding
from tests.helpers.command import run_here

# Not the command of this name, which the package shows.
doctor = import_module("eulerplateau.cli.doctor")
ROOT = Path(__file__).parents[2]


@pytest.mark.slow
def test_it_finds_all_that_the_tests_beside_this_one_use() -> None:
    """In children of its own: a mesh by Gmsh, a film by VTK, a figure by matplotlib."""
    result = run_here("doctor", cwd=ROOT)
    assert (result.returncode, result.stderr) == (0, "")
    lines = result.stdout.splitlines()
    assert not [line for line in lines if line.startswith("MISSING")]
    found = [line for line in lines if line.startswith("ok ")]
    for part in ("Python", "stored meshes", "polygons", "diagrams", "renders", "--dask"):
        assert [line for line in found if part in line], part


def findings(monkeypatch: pytest.MonkeyPatch, **replaced: Finding) -> None:
    """Let every check find its part, but those replaced."""
    for name in (
        "python", "folder", "solving", "meshing", "diagrams", "renders", "clone", "browser",
        "live", "cores", "dask", "parquet", "pandas", "evolver",
    ):  # fmt: skip
        found = replaced.get(name, Finding(name, ""))
        monkeypatch.setattr(doctor, f"_{name}", lambda found=found: found)


@pytest.mark.parametrize("needed", [True, False])
def test_only_what_the_two_commands_need_is_an_error(
    monkeypatch: pytest.MonkeyPatch, needed: bool
) -> None:
    findings(monkeypatch, renders=Finding("renders", "apt-get install libegl1", "", needed))
    result = run_here("doctor")
    assert result.returncode == needed
    (line,) = [text for text in result.stdout.splitlines() if not text.startswith("ok")]
    assert line.startswith("MISSING" if needed else "without")
    assert "apt-get install libegl1" in line


def test_a_crash_is_told_and_survived() -> None:
    kill = "import os; os.kill(os.getpid(), 11)"
    assert doctor._failure(kill) == "killed by SIGSEGV"
    assert (
        doctor._failure("raise ImportError('no libGL.so.1')")
        == "ImportError: no libGL.so.1"
    )
    assert doctor._failure("") == ""


@pytest.mark.parametrize(
    ("code", "cure"),
    [
        ("import gmsh_of_nobody.part", "pip install gmsh_of_nobody"),
        (
            "raise RuntimeError('cannot cache function: no locator available')",
            "NUMBA_CACHE",
        ),
        (
            "from eulerplateau.errors import MissingLibraryError as E; raise E('get it')",
            "get it",
        ),
    ],
)
def test_what_to_do_is_said(code: str, cure: str) -> None:
    assert cure in doctor._failure(code)
    assert "MissingLibraryError" not in doctor._failure(code)


def test_folder_that_cannot_be_written_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir("/proc")
    assert "/proc cannot be written" in doctor._folder().problem
    monkeypatch.chdir(tmp_path)
    assert doctor._folder().problem == ""
    assert list(tmp_path.iterdir()) == []
