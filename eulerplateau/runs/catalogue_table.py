"""Catalogues on disk: their rows and counts, read back."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

from eulerplateau.errors import OutputError
from eulerplateau.runs.kinds import FILM
from eulerplateau.runs.rows import CatalogueRow
from eulerplateau.runs.run_files import read_summary
from eulerplateau.runs.table import read_rows

COUNT_COLUMNS = "load", "search", "by_starts", "by_deflation", "together"


@dataclass(frozen=True)
class Catalogue:
    """What a catalogue came to; `finished` if an earlier call had come to it.

    `before` says in a line what was done with what lay in the folder.

    Attributes
    ----------
    counts : dictionaries of COUNT_COLUMNS
        How many distinct equilibria so many searches of each kind had found.
    """

    folder: Path
    rows: tuple[CatalogueRow, ...]
    counts: tuple[dict[str, float], ...]
    seconds: float
    finished: bool = False
    before: str = ""


def read_catalogue(folder: Path) -> Catalogue:
    """Read a folder that `run_catalogue` has written; raises OutputError."""
    column = FILM.load(read_summary(folder)).column
    rows = read_rows(folder / "catalogue.csv", CatalogueRow, column)
    return Catalogue(folder, tuple(rows), read_counts(folder), 0.0, True)


def read_counts(folder: Path) -> tuple[dict[str, float], ...]:
    """Read counts.csv of a folder; raises OutputError if it cannot be read."""
    path = folder / "counts.csv"
    try:
        with path.open(newline="", encoding="utf-8") as file:
            lines = list(csv.DictReader(file))
        return tuple({name: float(line[name]) for name in COUNT_COLUMNS} for line in lines)
    except OSError as error:
        raise OutputError(path, f"cannot be read: {error.strerror}") from None
    except (KeyError, ValueError, TypeError):
        raise OutputError(path, "is no table of counts") from None
