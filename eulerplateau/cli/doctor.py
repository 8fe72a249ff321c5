"""`eulerplateau doctor`: what this machine has and lacks for each part of the program."""

from __future__ import annotations

import os
import platform
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

import click

from eulerplateau.errors import MissingLibraryError

# The Pythons for which all that is pinned has wheels.
_PYTHONS = ((3, 11), (3, 14))

# Seconds; a machine that takes longer to load a library has another problem.
_PATIENCE = 120.0

# Gigabytes below which a word is said: a sweep's folder takes a few megabytes.
_ROOM = 0.5

_CLONE = Path(__file__).parents[2]
_BROWSERS = ("firefox", "chromium", "chromium-browser", "google-chrome", "xdg-open", "open")

# Carried out by a child, which a library that is missing may crash.
_SOLVE = "import eulerplateau.solvers.newton"
_MESH = """
from eulerplateau.mesh import mesh_polygon
mesh_polygon("ellipse", aspect=1.5, vertices=60)
"""
_DIAGRAM = """
import io
from matplotlib.figure import Figure
Figure().savefig(io.BytesIO())
"""
_RENDER = """
from eulerplateau.mesh.drawing import check_drawing
check_drawing()
"""


@dataclass(frozen=True)
class Finding:
    """What is there of a part of the program.

    Attributes
    ----------
    part : str, what one would want to do
    problem : str, what is missing and what to do about it; empty if nothing is
    has : str, what there is
    needed : bool, whether the README's two commands need it
    """

    part: str
    problem: str
    has: str = ""
    needed: bool = True

    def __str__(self) -> str:
        if not self.problem:
            return f"ok        {self.part}{self.has and f': {self.has}'}"
        return f"{'MISSING' if self.needed else 'without':9} {self.part}: {self.problem}"


@click.command()
def doctor() -> int:
    """Say what this machine has and lacks for each part of the program.

    A line for each: `ok`; `without` for what the README's two commands go without;
    `MISSING` for what they need, which makes the exit code 1. Each says what to install.
    """
    checks: Sequence[Callable[[], Finding]] = (
        _python, _folder, _solving, _meshing, _diagrams, _renders, _clone, _browser,
        _mp4, _live, _cores, _dask, _parquet, _pandas, _evolver,
    )  # fmt: skip
    code = 0
    with ThreadPoolExecutor() as pool:  # most of them wait for a child
        for finding in pool.map(lambda check: check(), checks):
            click.echo(str(finding))
            if finding.problem and finding.needed:
                code = MissingLibraryError.exit_code
    return code


def _python() -> Finding:
    low, high = (".".join(map(str, numbers)) for numbers in _PYTHONS)
    inside = _PYTHONS[0] <= sys.version_info[:2] <= _PYTHONS[1]
    has = f"{platform.python_version()}, {sys.executable}"
    return Finding("Python", "" if inside else f"{has}: install {low} to {high}", has)


def _folder() -> Finding:
    """Look whether run folders can be written here."""
    here = Path.cwd()
    part = "run folders"
    try:
        with tempfile.TemporaryDirectory(prefix="eulerplateau-", dir=here):
            free = shutil.disk_usage(here).free / 1e9
    except OSError as error:
        problem = f"{here} cannot be written: {error.strerror}; name another by --out"
        return Finding(part, problem)
    if free < _ROOM:
        problem = f"{here} has {free:.2f} GB left: make room, or name another by --out"
        return Finding(part, problem)
    return Finding(part, "", f"{here} has {free:.0f} GB left")


def _solving() -> Finding:
    cache = os.environ.get("NUMBA_CACHE_DIR", "beside the program, or in the home")
    has = f"{_versions('numpy', 'scipy', 'numba')}; compiled code is kept {cache}"
    return Finding("sweeps and branches on stored meshes", _failure(_SOLVE), has)


def _meshing() -> Finding:
    return Finding("meshes of polygons", _failure(_MESH), _versions("gmsh"))


def _diagrams() -> Finding:
    return Finding("diagrams and plots", _failure(_DIAGRAM), _versions("matplotlib"))


def _renders() -> Finding:
    has = f"{_versions('vtk', 'pyvista')}, without a display"
    return Finding("renders of shapes", _failure(_RENDER), has)


def _clone() -> Finding:
    """Look for what scripts/sweep and scripts/test make their environment with."""
    part = "scripts/sweep and scripts/test"
    if not (_CLONE / "scripts/test").is_file():
        return Finding(part, "come with a clone of the repository", needed=False)
    programs = [name for name in ("bash", "git") if shutil.which(name) is None]
    if programs:
        return Finding(part, _apt(programs))
    if find_spec("ensurepip") is None and not (_CLONE / ".venv").is_dir():
        return Finding(part, _apt([f"python{sys.version_info[0]}-venv"]))
    return Finding(part, "", "they install what they need into .venv")


def _browser() -> Finding:
    found = next((name for name in _BROWSERS if shutil.which(name)), "")
    problem = "no browser here: open the page on another machine, it is one file"
    return Finding("the gallery in a browser", "" if found else problem, found, False)


def _mp4() -> Finding:
    return _extra("animations as MP4", "av", "'eulerplateau[mp4]'")


def _live() -> Finding:
    return _extra("a film that follows (live)", "aiohttp", "'eulerplateau[live]'")


def _cores() -> Finding:
    return Finding("many runs: --workers", "", f"{os.cpu_count()} cores")


def _dask() -> Finding:
    return _extra("many runs: --dask", "distributed", "'eulerplateau[dask]'")


def _parquet() -> Finding:
    return _extra("tables as Parquet", "pyarrow", "'eulerplateau[parquet]'")


def _pandas() -> Finding:
    return _extra("tables in Python (Run.table)", "pandas", "pandas")


def _evolver() -> Finding:
    found = shutil.which("evolver-nox-d") or shutil.which("evolver") or ""
    problem = "" if found else _apt(["evolver-nox"])
    return Finding("Surface Evolver (scripts/error_vs_time)", problem, found, False)


def _extra(part: str, package: str, name: str) -> Finding:
    missing = _version(package) is None
    problem = f"pip install {name}" if missing else ""
    return Finding(part, problem, _versions(package), needed=False)


def _failure(code: str) -> str:
    """Return what stands against some code, in a line; "" if a child carries it out."""
    try:
        done = subprocess.run(
            [sys.executable, "-P", "-c", code],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=_PATIENCE,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return f"no answer after {_PATIENCE:g} s"
    if done.returncode == 0:
        return ""
    if done.returncode < 0:
        return f"killed by {signal.Signals(-done.returncode).name}"
    last = (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1]
    return _with_cure(last)


def _with_cure(error: str) -> str:
    """Return the last line of what a child said, and what to do about it."""
    absent = re.search("No module named '([^'.]+)", error)
    if absent:
        return f"{error}: pip install {absent[1]}"
    if "no locator available" in error:  # Numba's words
        return f"{error}: set NUMBA_CACHE_DIR to a folder that can be written"
    # An error of the program's own says it itself.
    return error.removeprefix("eulerplateau.errors.MissingLibraryError: ")


def _apt(packages: Sequence[str]) -> str:
    return f"on Debian: apt-get update && apt-get install {' '.join(packages)}"


def _version(package: str) -> str | None:
    # Loaded here, and not by everybody who asks for help.
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version(package)
    except PackageNotFoundError:
        return None


def _versions(*packages: str) -> str:
    return ", ".join(f"{name} {_version(name) or 'missing'}" for name in packages)
