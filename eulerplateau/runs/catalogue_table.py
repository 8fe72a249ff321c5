"""Catalogues on disk: their rows and counts, read back."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from eulerplateau.errors import OutputError
from eulerplateau.runs.kinds import Kind
from eulerplateau.runs.own_columns import OfContact, with_own
from eulerplateau.runs.record import kind_of
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


def catalogue_row(kind: Kind) -> Any:
    """Return the type of a catalogue's rows: of contact too, where a sweep's are."""
    thick = issubclass(kind.row, OfContact)
    return with_own(OfContact, CatalogueRow) if thick else CatalogueRow


def read_catalogue(folder: Path) -> Catalogue:
    """Read a folder that `run_catalogue` has written; raises OutputError."""
    about = read_summary(folder)
    kind = kind_of(about)
    rows = read_rows(folder / "catalogue.csv", catalogue_row(kind), kind.quantity(about))
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
