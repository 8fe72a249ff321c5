"""Which curve of special points is asked for, and the curve as it was written."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from eulerplateau.runs.rows import LoadName


@dataclass(frozen=True)
class Asked:
    """Which curve is asked for.

    Attributes
    ----------
    run : folder of the branches that the special point is one of
    number : of that point
    second : name of the second parameter
    low, high : where its window ends, by default as far from its own value as that is
        from zero, or 1 if that is further
    """

    run: Path
    number: int
    second: str
    low: float | None = None
    high: float | None = None


@dataclass(frozen=True)
class Locus:
    """A curve of special points, as it was written.

    Attributes
    ----------
    names : of both parameters
    rows : dicts by column
    breaks : the symmetries that its bifurcations live on, or that its folds have lost
    """

    folder: Path
    names: tuple[LoadName, LoadName]
    rows: tuple[dict[str, Any], ...]
    seconds: float
    breaks: tuple[str, ...] = ()

    @property
    def special(self) -> tuple[dict[str, Any], ...]:
        """The rows of what is special on the way."""
        return tuple(row for row in self.rows if row["special"] and row["arclength"])
