"""Read .ply files: the Stanford triangle format, text or binary of either byte order."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh.readers.content import (
    Content,
    ForeignError,
    NotWholeError,
    Words,
    polygons,
    promise,
    rows,
    strips,
)

_TYPES = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4",
    "float": "f4", "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2",
    "uint16": "u2", "int32": "i4", "uint32": "u4", "float32": "f4", "float64": "f8",
}  # fmt: skip
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}


@dataclass
class _Element:
    """A table: so many rows of properties, each (name, type, type of its length or "")."""

    name: str
    count: int
    properties: list[tuple[str, str, str]] = field(default_factory=list)


def read_ply(path: Path) -> Content:
    """Read the vertices and faces; other elements and properties are left out."""
    content = path.read_bytes()
    order, elements, body = _header(content)
    source = _Text(body) if order == "" else _Binary(body, order)
    tables = {element.name: source.table(element) for element in elements}
    if source.left:
        raise ValueError("it holds more than its header promises")
    vertices = tables.get("vertex", {})
    if not {"x", "y", "z"} <= vertices.keys():
        raise ForeignError("holds no vertices with x, y and z")
    points = rows(np.array([vertices[axis] for axis in "xyz"], dtype=np.float64).T)
    face = tables.get("face", {})
    faces = face.get("vertex_indices", face.get("vertex_index", []))
    for strip in tables.get("tristrips", {}).get("vertex_indices", []):
        ends = [-1, *(place for place, v in enumerate(strip) if v == -1), len(strip)]
        parts = [strip[a + 1 : b] for a, b in itertools.pairwise(ends)]
        faces = [*faces, *strips(parts)]
    return Content(points, *polygons(faces))


def _header(content: bytes) -> tuple[str, list[_Element], bytes]:
    """Return the byte order ("" of text), the elements and what follows the header."""
    if content[:3] != b"ply":
        raise ForeignError("is no .ply file: it does not begin with ply")
    order, elements, place = None, [], 0
    while True:
        end = content.find(b"\n", place)
        words = content[place : end if end >= 0 else len(content)].decode("latin-1").split()
        if words[:1] == ["end_header"]:
            break
        if end < 0:
            raise NotWholeError("its header has no end")
        place = end + 1
        if words[:1] == ["format"]:
            order = _ORDERS.get(words[1])
        elif words[:1] == ["element"]:
            elements.append(_Element(words[1], int(words[2])))
        elif words[:2] == ["property", "list"]:
            elements[-1].properties.append((words[4], _TYPES[words[3]], _TYPES[words[2]]))
        elif words[:1] == ["property"]:
            elements[-1].properties.append((words[2], _TYPES[words[1]], ""))
    if order is None:
        raise ValueError("its header names no format that is known")
    return order, elements, content[end + 1 :] if end >= 0 else b""


class _Text:
    def __init__(self, body: bytes) -> None:
        self._words = Words(body.split())

    @property
    def left(self) -> int:
        return self._words.left

    def table(self, element: _Element) -> dict[str, list[Any]]:
        what = f"rows of {element.name}"
        columns: dict[str, list[Any]] = {name: [] for name, _, _ in element.properties}
        promise(element.count <= self.left or not columns, f"more {what} than it holds")
        for _ in range(element.count if columns else 0):
            for name, kind, length in element.properties:
                count = self._words.whole(what) if length else 1
                number = float if kind[0] == "f" else int
                found = [*map(number, self._words.take(count, what))]
                columns[name].append(found if length else found[0])
        return columns


class _Binary:
    def __init__(self, body: bytes, order: str) -> None:
        self._body, self._order = body, order
        self._place = 0

    @property
    def left(self) -> int:
        return len(self._body[self._place :].strip())

    def table(self, element: _Element) -> dict[str, list[Any]]:
        """Rows that are all as long as the first are read at once, others one by one."""
        if not element.count or not element.properties:
            return {}
        what = f"more rows of {element.name} than it holds"
        promise(element.count <= len(self._body) - self._place, what)
        start = self._place
        sizes: list[int | None] = []
        first = self._row(element, what, sizes)
        kind = self._kind(element, sizes)
        if start + element.count * kind.itemsize <= len(self._body):
            table = np.frombuffer(self._body, kind, element.count, start)
            lengths = [table[f"{place}"] for place, n in enumerate(sizes) if n is not None]
            alike = zip(lengths, [n for n in sizes if n is not None], strict=True)
            if all((found == n).all() for found, n in alike):
                self._place = start + element.count * kind.itemsize
                names = [name for name, _, _ in element.properties]
                return {name: table[f"_{i}"].tolist() for i, name in enumerate(names)}
        every = [first, *(self._row(element, what, []) for _ in range(element.count - 1))]
        names = [name for name, _, _ in element.properties]
        return {name: [row[i] for row in every] for i, name in enumerate(names)}

    def _kind(self, element: _Element, sizes: list[int | None]) -> np.dtype[Any]:
        fields: list[Any] = []
        for place, (_, kind, length) in enumerate(element.properties):
            if length:
                fields.append((f"{place}", self._order + length))
                fields.append((f"_{place}", self._order + kind, (sizes[place] or 0,)))
            else:
                fields.append((f"_{place}", self._order + kind))
        return np.dtype(fields)

    def _row(self, element: _Element, what: str, sizes: list[int | None]) -> list[Any]:
        found: list[Any] = []
        for _, kind, length in element.properties:
            count = int(self._take(length, 1, what)[0]) if length else 1
            values = self._take(kind, count, what).tolist()
            sizes.append(count if length else None)
            found.append(values if length else values[0])
        return found

    def _take(self, kind: str, count: int, what: str) -> FloatArray:
        size = int(kind[1]) * count
        promise(0 <= size <= len(self._body) - self._place, what)
        self._place += size
        start = self._place - size
        values: FloatArray = np.frombuffer(self._body, self._order + kind, count, start)
        return values
