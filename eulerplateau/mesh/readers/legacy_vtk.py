"""Read legacy .vtk files: polygons and unstructured grids, text or binary, old or 5.1."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.mesh.readers.content import (
    Content,
    ForeignError,
    NotWholeError,
    promise,
    rows,
)
from eulerplateau.mesh.readers.vtk_cells import of_cells

_TYPES = {
    "char": "i1", "unsigned_char": "u1", "short": "i2", "unsigned_short": "u2",
    "int": "i4", "unsigned_int": "u4", "long": "i8", "unsigned_long": "u8",
    "vtkidtype": "i4", "vtktypeint64": "i8", "vtktypeuint64": "u8", "float": "f4",
    "double": "f8", "vtktypeint32": "i4", "vtktypeuint32": "u4",
}  # fmt: skip
# Sections of polygons, with VTK's number of what is in them.
_SECTIONS = {"VERTICES": 2, "LINES": 4, "POLYGONS": 7, "TRIANGLE_STRIPS": 6, "CELLS": 0}


def read_legacy(path: Path) -> Content:
    """Read a surface; the data of its points and cells are left out."""
    content = path.read_bytes()
    if content[:14] != b"# vtk DataFile":
        raise ForeignError("is no legacy .vtk file: it does not begin with # vtk DataFile")
    file = _File(content)
    dataset = file.dataset()
    points: FloatArray | None = None
    found: list[tuple[IntArray, IntArray]] = []
    kinds: list[IntArray] = []
    while (words := file.words()) and words[0].upper() not in ("POINT_DATA", "CELL_DATA"):
        section = words[0].upper()
        if section == "POINTS":
            flat = file.numbers(3 * int(words[1]), words[2], "points")
            points = rows(flat.astype(np.float64))
        elif section in _SECTIONS:
            cells = file.cells(int(words[1]), int(words[2]))
            found.append(cells)
            if section != "CELLS":
                kinds.append(np.full(len(cells[1]), _SECTIONS[section]))
        elif section == "CELL_TYPES":
            kinds.append(file.numbers(int(words[1]), "int", "types of cells").astype(int))
        elif section == "METADATA":
            file.skip_to_blank()
        elif section == "FIELD":
            file.skip_field(int(words[2]))
        else:
            raise ValueError(f"{section[:20]!r} is no section that is known")
    if points is None:
        raise NotWholeError(f"its {dataset} has no points yet")
    sizes = [np.diff(ends, prepend=0) for _, ends in found]
    count, typed = sum(map(len, sizes)), sum(map(len, kinds))
    promise(count == typed, f"{count} cells and has the types of {typed}")
    empty = np.zeros(0, dtype=np.int64)
    corners = np.concatenate([empty, *(corners for corners, _ in found)])
    ends = np.cumsum(np.concatenate([empty, *sizes]))
    return of_cells(points, corners, ends, np.concatenate([empty, *kinds]))


class _File:
    def __init__(self, content: bytes) -> None:
        self._content, self._place = content, 0
        self._version = self._line().split()[-1]
        self._line()  # the title
        self._text = self._line().strip().upper() == b"ASCII"

    def dataset(self) -> str:
        """Return the kind of data set; raises ForeignError for one that is no surface."""
        words = self.words()
        while words[:1] == ["FIELD"]:
            self.skip_field(int(words[2]))
            words = self.words()
        if len(words) < 2:
            raise NotWholeError("it has no DATASET yet")
        if words[1].upper() not in ("POLYDATA", "UNSTRUCTURED_GRID"):
            raise ForeignError(f"holds a {words[1]}; a film is a surface of triangles")
        return words[1]

    def words(self) -> list[str]:
        """Return the words of the next line that has any; none at the end."""
        while self._place < len(self._content):
            if words := self._line().decode("latin-1").split():
                return words
        return []

    def cells(self, count: int, size: int) -> tuple[IntArray, IntArray]:
        """Return the corners of a section's cells, and where each ends."""
        before = self._place
        if self.words()[:1] == ["OFFSETS"]:
            self._place = before
            ends = self._named("OFFSETS", count)
            corners = self._named("CONNECTIVITY", size)
            if len(ends) and (
                ends[0] != 0 or ends[-1] != size or (np.diff(ends) < 0).any()
            ):
                raise ValueError("its offsets do not fit its cells")
            return corners, ends[1:]
        self._place = before
        flat = self.numbers(size, "int", "corners of cells").astype(np.int64)
        if size == 4 * count and (flat[::4] == 3).all():
            return flat.reshape(-1, 4)[:, 1:].ravel(), 3 * np.arange(1, count + 1)
        cells, place = [], 0
        while place < size:
            end = place + 1 + int(flat[place])
            promise(place < end <= size, "more corners of a cell than it holds")
            cells.append(flat[place + 1 : end])
            place = end
        promise(len(cells) == count, f"{count} cells and holds {len(cells)}")
        corners = np.concatenate([flat[:0], *cells])
        return corners, np.cumsum([len(cell) for cell in cells], dtype=np.int64)

    def numbers(self, count: int, kind: str, what: str) -> FloatArray:
        """Return the next `count` numbers of a type that VTK calls `kind`."""
        name = _TYPES[kind.lower()]
        more = f"{count} numbers of its {what} and ends before"
        if not self._text:
            size = count * int(name[1])
            promise(0 <= size <= len(self._content) - self._place, more)
            values: FloatArray = np.frombuffer(
                self._content, f">{name}", count, self._place
            )
            self._place += size
            return values
        promise(0 <= count <= len(self._content) - self._place, more)
        words: list[bytes] = []
        while len(words) < count and self._place < len(self._content):
            words += self._line().split()
        promise(len(words) >= count, more)
        if len(words) > count:
            raise ValueError(f"a line of its {what} has more numbers than it promises")
        number = float if name[0] == "f" else int
        return np.array([number(word) for word in words], dtype=name)

    def skip_to_blank(self) -> None:
        """Pass over lines until one that is blank."""
        while self._place < len(self._content) and self._line().strip():
            pass

    def skip_field(self, count: int) -> None:
        """Pass over `count` arrays that belong to no point."""
        for _ in range(count):
            words = self.words()
            while words[:1] == ["METADATA"]:
                self.skip_to_blank()
                words = self.words()
            promise(len(words) >= 4, "more fields than it holds")
            if words[3].lower() not in _TYPES:
                raise ForeignError(
                    "has fields of text before its points: write it without them"
                )
            self.numbers(int(words[1]) * int(words[2]), words[3], "fields")

    def _named(self, name: str, count: int) -> IntArray:
        words = self.words()
        promise(words[:1] == [name] and len(words) > 1, f"{name} of its cells")
        return self.numbers(count, words[1], "cells").astype(np.int64)

    def _line(self) -> bytes:
        end = self._content.find(b"\n", self._place)
        end = len(self._content) if end < 0 else end
        line = self._content[self._place : end]
        self._place = end + 1
        return line
