"""What files a run folder holds, and which folders are runs."""

from __future__ import annotations

import json
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from eulerplateau.errors import OutputError
from eulerplateau.mesh import write_whole
from eulerplateau.runs.checkpoint import CHECKPOINTS
from eulerplateau.runs.series_file import LOOPS, SHAPES, SPECIAL, SPECIAL_SHAPES

# In run.json: without it a folder is not ours, and nothing in it is ever removed.
_MARK = {"program": "eulerplateau"}
_SECTIONS = "spec", "mesh", "totals"
WRITER = ".writer"
TABLES = "sweep", "branches", "catalogue"
# In a folder that holds another run: where one that replaces it has its first row.
NEW = ".new"
# The folder of shapes that `eulerplateau live` saves: nobody else writes or removes them.
LIVE = "live"
_OUR_FILES = (
    *(f"{table}.{form}" for table in TABLES for form in ("csv", "pvd", "png")),
    "counts.csv",
    SPECIAL,
    SPECIAL_SHAPES,
    *CHECKPOINTS,
    "diagram.png",
    "shapes/shape_*.vtp",
    "loops/loop_*.vtp",
    "pictures/shape_*.png",
    "pictures/sheet*.png",
    "pictures/turn_*.gif",
    "pictures/sweep*.gif",
)
FOLDERS = SHAPES, LOOPS


def write_summary(path: Path, summary: Mapping[str, object]) -> None:
    """Write a folder's run.json: plain data, all floats finite."""
    text = json.dumps({**_MARK, **summary}, indent=2, allow_nan=False)
    write_whole(path / "run.json", f"{text}\n".encode())


def check_is_run(path: Path) -> None:
    """Raise OutputError for a folder with files that is no run."""
    ours = WRITER, NEW
    names = (file.name for file in path.iterdir() if file.name != LIVE)
    files = [name for name in names if not name.startswith(ours)]
    if files and not read_summary(path).items() >= _MARK.items():
        problem = "holds something else than a run: name an empty or a new folder"
        raise OutputError(path, problem)


def remove_run(path: Path) -> None:
    """Remove what there is of a run but its run.json, and nothing else."""
    for pattern in _OUR_FILES:
        for file in path.glob(pattern):
            file.unlink()


def read_summary(path: Path) -> Mapping[str, Any]:
    """Return what the run.json of a folder says; empty if there is none or a broken one.

    What should be a section and is none is left out.
    """
    # Anything but an object has no items.
    with suppress(OSError, ValueError, RecursionError, AttributeError):
        said = json.loads((path / "run.json").read_bytes()).items()
        return {k: v for k, v in said if k not in _SECTIONS or isinstance(v, dict)}
    return {}
