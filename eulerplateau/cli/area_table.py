"""Tables of cell areas over substrate stiffness, as `eulerplateau cell fit` reads them."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from pathlib import Path

from eulerplateau.errors import OutputError, SpecError

NAMES = ("stiffness", "area", "error")
_SEPARATORS = ";\t,"

# Where a line stands, and its cells.
Line = tuple[str, list[str]]


@dataclass(frozen=True)
class AreaTable:
    """Columns of numbers, all finite and positive; `error` is None where there is none."""

    stiffness: list[float]
    area: list[float]
    error: list[float] | None


def read_areas(path: Path) -> AreaTable:
    """Read a table; its first line may name the columns, and # begins a comment.

    Without names the columns are stiffness, area and, if there is a third one, error. With
    names they are in any order, among others, and a name may be followed by a unit:
    `area (um^2)`. They are separated by commas, semicolons or tabs.

    Raises SpecError that names the file, the line and what would be right, OutputError if
    the file exists and cannot be read.
    """
    rows = numbered_lines(path, "stiffness, area")
    where, first = rows[0]
    if any(_number(cell) is None for cell in first):
        places, rows = _places(where, first), rows[1:]
    else:
        places = _unnamed(where, first)
    columns: dict[str, list[float]] = {name: [] for name in places}
    for where, cells in rows:
        if len(cells) != len(first):
            raise SpecError(
                where,
                f"found {len(cells)} columns; should be {len(first)}, as in the first",
            )
        for name, place in places.items():
            columns[name].append(_checked(where, name, cells[place]))
    return AreaTable(columns["stiffness"], columns["area"], columns.get("error"))


def numbered_lines(path: Path, columns: str) -> list[Line]:
    """Return the lines of a table that say something, each with its place and its cells.

    `columns` are what a line should have. Raises SpecError, and OutputError.
    """
    lines = [
        (number, text)
        for number, line in enumerate(_text(path).splitlines(), 1)
        if (text := line.partition("#")[0].strip())
    ]
    if not lines:
        raise SpecError(str(path), f"has no data; should have lines of {columns}")
    separator = next((s for s in _SEPARATORS if s in lines[0][1]), None)
    return [
        (f"{path}, line {number}", [cell.strip() for cell in text.split(separator)])
        for number, text in lines
    ]


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise SpecError(str(path), "there is no such file") from None
    except OSError as error:
        raise OutputError(path, f"cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise SpecError(str(path), "is no text; should be a table in UTF-8") from None


def _places(where: str, names: list[str]) -> dict[str, int]:
    """Return where the columns are, from the line that names them."""
    words = [(name.strip('"').lower().split() or [""])[0] for name in names]
    bare = [word.partition("(")[0].partition("[")[0] for word in words]
    for name in NAMES:
        if bare.count(name) > 1 or (name != "error" and name not in bare):
            raise SpecError(
                where,
                f"found columns {', '.join(names)}; should be numbers, or name one column "
                "stiffness, one area and at most one error",
            )
    return {name: bare.index(name) for name in NAMES if name in bare}


def _unnamed(where: str, cells: list[str]) -> dict[str, int]:
    """Return where the columns are if they have no names."""
    if len(cells) not in (2, 3):
        raise SpecError(
            where, f"found {len(cells)} columns without names; should be {', '.join(NAMES)}"
        )
    return {name: place for place, name in enumerate(NAMES[: len(cells)])}


def _number(cell: str) -> float | None:
    try:
        return float(cell)
    except ValueError:
        return None


def _checked(where: str, name: str, cell: str) -> float:
    value = _number(cell)
    if value is None or not (isfinite(value) and value > 0):
        raise SpecError(
            where, f"found {name} {cell or 'empty'}; should be a finite, positive number"
        )
    return value
