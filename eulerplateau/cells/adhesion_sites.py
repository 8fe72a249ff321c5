"""Where a cell adheres: points in the plane, made or read, each with its stiffness."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.cells.touching import crosses_itself
from eulerplateau.errors import SpecError
from eulerplateau.loop import edges_of
from eulerplateau.mesh import polygon_area

# Neighbours closer than this, relative to the extent of all points, are one point.
_COINCIDENT = 1e-9
# Turning by this much less than a half turn (rad), a polygon goes back the way it came.
_BACK = 1e-9


@dataclass(frozen=True, eq=False, repr=False)
class Sites:
    """Adhesion sites, corners of a polygon that does not cross itself.

    Attributes
    ----------
    points : (N, 2) float, counter-clockwise, in units of R0
    weights : (N,) float, positive: stiffness relative to k_s
    """

    points: FloatArray
    weights: FloatArray

    def __repr__(self) -> str:
        """Return one line: how many they are, and how stiff."""
        low, high = self.weights.min(), self.weights.max()
        stiff = "equally stiff" if low == high else f"stiffness {low:g} to {high:g}"
        return f"<Sites: {len(self.points)} points, {stiff}>"


def regular_sites(n: int) -> Sites:
    """Return the n corners of a regular polygon of circumradius 1, the first at (1, 0)."""
    if n < 2:
        raise SpecError("sites", f"found {n} points; should be 2 or more")
    angle = 2 * np.pi * np.arange(n) / n
    return Sites(np.column_stack([np.cos(angle), np.sin(angle)]), np.ones(n))


def read_sites(path: str | Path) -> Sites:
    """Return the sites of a CSV file: x, y and, if wanted, relative stiffness a line.

    The first line may name the columns, and a # starts a comment. Points that run
    clockwise are reversed. Raises SpecError, which says which line is wrong and what would
    be right.
    """
    rows = _numbers(Path(path), _lines(Path(path)))
    points = np.array([row[:2] for _, row in rows])
    weights = np.array([row[2] if len(row) == 3 else 1.0 for _, row in rows])
    numbers = [number for number, _ in rows]
    _check(str(path), points, weights, numbers)
    if len(points) > 2 and polygon_area(points) < 0:
        points, weights = points[::-1].copy(), weights[::-1].copy()
    return Sites(points, weights)


def _lines(path: Path) -> list[tuple[int, list[str]]]:
    """Return the lines that are not empty, each with its number and its fields.

    What follows a # is a comment.
    """
    try:
        with path.open(newline="", encoding="utf-8-sig") as file:
            reader = csv.reader(line.partition("#")[0] for line in file)
            lines = [(reader.line_num, [f.strip() for f in fields]) for fields in reader]
    except OSError as error:
        raise SpecError(str(path), f"cannot be read: {error.strerror}") from None
    except (UnicodeDecodeError, csv.Error):
        raise SpecError(str(path), "is no text; should be lines x,y[,stiffness]") from None
    return [line for line in lines if any(line[1])]


def _numbers(
    path: Path, lines: list[tuple[int, list[str]]]
) -> list[tuple[int, list[float]]]:
    """Return the numbers of each line; a first line without any is a header."""
    if lines and not any(_is_number(field) for field in lines[0][1]):
        lines = lines[1:]
    rows = []
    for number, fields in lines:
        if len(fields) not in (2, 3) or len(fields) != len(lines[0][1]):
            wanted = "2 (x,y) or 3 (x,y,stiffness), the same on each line"
            what = f"line {number}: has {len(fields)} fields; should be {wanted}"
            raise SpecError(str(path), what)
        for field in fields:
            if not _is_number(field):
                what = f"line {number}: found {field!r}; should be a number"
                raise SpecError(str(path), what)
        row = [float(field) for field in fields]
        if not np.isfinite(row).all():
            raise SpecError(str(path), f"line {number}: is not finite; should be numbers")
        if len(row) == 3 and row[2] <= 0:
            what = f"line {number}: stiffness {row[2]:g} should be positive"
            raise SpecError(str(path), what)
        rows.append((number, row))
    if len(rows) < 2:
        raise SpecError(str(path), f"has {len(rows)} points; should be 2 or more")
    return rows


def _is_number(field: str) -> bool:
    try:
        float(field)
    except ValueError:
        return False
    return True


def _check(path: str, points: FloatArray, weights: FloatArray, numbers: list[int]) -> None:
    """Raise SpecError unless the points are corners of a polygon that is simple."""
    ahead = np.roll(points, -1, axis=0)
    gaps = np.hypot(*(ahead - points).T)
    extent = float(np.ptp(points, axis=0).max())
    near = np.flatnonzero(gaps <= _COINCIDENT * extent)
    if len(near):
        here, after = numbers[near[0]], numbers[(near[0] + 1) % len(numbers)]
        what = f"line {after}: is the same point as line {here}: leave one out"
        raise SpecError(path, what)
    if len(points) == 2:
        return
    back = np.flatnonzero(np.abs(edges_of(points).turning) > np.pi - _BACK)
    if len(back):
        what = f"line {numbers[back[0]]}: the polygon turns back on itself there"
        raise SpecError(path, f"{what}: give the points in order round the cell")
    if crosses_itself(points):
        what = "the polygon of the points crosses itself"
        raise SpecError(path, f"{what}: give them in order round the cell")
