"""Where an exploration goes on: files of arrays beside its rows, each with a checksum.

Two take turns, so that one that is damaged leaves the one before it.
"""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from contextlib import suppress
from hashlib import sha256
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from eulerplateau.mesh import sync, write_whole
from eulerplateau.runs.rows import Record
from eulerplateau.runs.series_file import SPECIAL
from eulerplateau.runs.table import read_special

Arrays = Mapping[str, NDArray[Any]]

CHECKPOINTS = ".checkpoint_0", ".checkpoint_1"
_ROWS = "rows"


def write_checkpoint(path: Path, turn: int, rows: int, arrays: Arrays) -> None:
    """Write how a run goes on after its first `rows`, in place of the last but one.

    All that it goes on from should be synced before. Raises OutputError.
    """
    file = io.BytesIO()
    np.savez(file, **{**arrays, _ROWS: np.array(rows)})  # type: ignore[arg-type]
    content = file.getvalue()
    target = path / CHECKPOINTS[turn % 2]
    write_whole(target, sha256(content).hexdigest().encode() + b"\n" + content)
    sync(target)


def remove_checkpoints(path: Path) -> None:
    """Remove them, as far as that can be done."""
    for name in CHECKPOINTS:
        with suppress(OSError):
            (path / name).unlink()


def last_checkpoint(path: Path, rows: Sequence[Record]) -> tuple[int, Arrays] | None:
    """Return how many of the rows are kept, and how the run goes on; None if it cannot.

    A checkpoint counts if it is whole, and with it all rows and special points before it.
    """
    whole = [found for name in CHECKPOINTS if (found := _read(path / name)) is not None]
    for kept, arrays in sorted(whole, key=lambda pair: -pair[0]):
        told = {getattr(row, "special", None) for row in rows[:kept]} - {None}
        if kept <= len(rows) and told <= read_special(path / SPECIAL).keys():
            return kept, arrays
    return None


def _read(path: Path) -> tuple[int, Arrays] | None:
    """Return the number of rows and the arrays of a checkpoint, None if it is damaged."""
    try:
        digest, content = path.read_bytes().split(b"\n", 1)
        if sha256(content).hexdigest().encode() != digest:
            return None
        with np.load(io.BytesIO(content), allow_pickle=False) as stored:
            arrays = dict(stored)
        return int(arrays.pop(_ROWS)), arrays
    except (OSError, ValueError, KeyError, BadZipFile):
        return None
