"""Tables of points of an outline, as `eulerplateau fit` reads them."""

from __future__ import annotations

from math import isfinite, nan
from pathlib import Path

from eulerplateau.cli.area_table import Line, numbered_lines
from eulerplateau.errors import SpecError


def read_points(path: Path) -> list[tuple[float, float]]:
    """Read the points of an outline: a line for each, x and y first; # begins a comment.

    The first line may name the columns; named x and y they may stand among others. They
    are separated by commas, semicolons, tabs or spaces. Raises SpecError that names the
    file, the line and what would be right, OutputError if the file cannot be read.
    """
    lines = numbered_lines(path, "x, y")
    _, first = lines[0]
    names = [cell.strip('"').lower().partition(" ")[0] for cell in first]
    places = 0, 1
    if not all(isfinite(_number(cell)) for cell in first[:2]):
        if {"x", "y"} <= set(names):
            places = names.index("x"), names.index("y")
        del lines[0]
    if not lines:
        raise SpecError(str(path), "has no points; should have lines of x, y")
    return [_point(line, places) for line in lines]


def _point(line: Line, places: tuple[int, int]) -> tuple[float, float]:
    where, cells = line
    found = [_number(cells[place]) if place < len(cells) else nan for place in places]
    if not all(map(isfinite, found)):
        said = ", ".join(cells)
        raise SpecError(where, f"found {said}; should be x, y of a point, as 12.5, -3.1")
    return found[0], found[1]


def _number(cell: str) -> float:
    try:
        return float(cell)
    except ValueError:
        return nan
