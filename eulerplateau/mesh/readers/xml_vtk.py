"""Read VTK's XML files, .vtp and .vtu: text or binary, in line or appended, compressed."""

from __future__ import annotations

import base64
import lzma
import re
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

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
    "Int8": "i1", "UInt8": "u1", "Int16": "i2", "UInt16": "u2", "Int32": "i4",
    "UInt32": "u4", "Int64": "i8", "UInt64": "u8", "Float32": "f4", "Float64": "f8",
}  # fmt: skip
# What polygons are stored as, with VTK's number of such cells.
_SECTIONS = {"Polys": 7, "Strips": 6, "Lines": 4, "Verts": 2}
_BASE64 = re.compile(rb"[A-Za-z0-9+/]+={0,2}")


def read_xml(path: Path) -> Content:
    """Read the polygons of a .vtp or a .vtu file."""
    return XmlFile(path.read_bytes()).surface()


class XmlFile:
    """A VTK file of polygons or of an unstructured grid, in one piece or several."""

    def __init__(self, content: bytes) -> None:
        begin = content.find(b"<AppendedData")
        head = content if begin < 0 else content[:begin] + b"</VTKFile>"
        if b"<VTKFile" not in content[:2000]:
            raise ForeignError("is no XML file of VTK: it does not begin with <VTKFile")
        if not content.rstrip().endswith(b"</VTKFile>"):
            raise NotWholeError("it has no end")
        root = ElementTree.fromstring(head)
        self.kind = root.get("type", "")
        if self.kind not in ("PolyData", "UnstructuredGrid"):
            raise ForeignError(f"holds a {self.kind}; a film is a surface of triangles")
        self._order = ">" if root.get("byte_order") == "BigEndian" else "<"
        self._head = self._order + ("u8" if root.get("header_type") == "UInt64" else "u4")
        self._compressor = root.get("compressor", "")
        (self._data,) = root.findall(self.kind)
        self.pieces = self._data.findall("Piece")
        if begin >= 0:
            start = content.index(b"_", begin) + 1
            self._raw = b'"raw"' in content[begin:start]
            self._appended = content[start : content.rindex(b"</AppendedData>")]
            offsets = {int(a.get("offset", 0)) for a in root.iter("DataArray")}
            self._offsets = sorted({*offsets, len(self._appended)})

    def surface(self) -> Content:
        """Return the polygons."""
        if self.kind == "UnstructuredGrid":
            corners, ends = self.cells("Cells")
            found = [self._array(piece, "Cells", "types") for piece in self.pieces]
            kinds = np.concatenate([np.zeros(0, dtype=np.int64), *found]).astype(np.int64)
            promise(len(kinds) == len(ends), f"{len(ends)} cells, not {len(kinds)} types")
            return of_cells(self.points(), corners, ends, kinds)
        parts = [(*self.cells(section), kind) for section, kind in _SECTIONS.items()]
        corners = np.concatenate([corners for corners, _, _ in parts])
        sizes = np.concatenate([np.diff(ends, prepend=0) for _, ends, _ in parts])
        kinds = np.concatenate([np.full(len(ends), kind) for _, ends, kind in parts])
        return of_cells(self.points(), corners, np.cumsum(sizes), kinds)

    def points(self) -> FloatArray:
        """Return the points (n, 3) of all pieces."""
        found = [np.zeros((0, 3))]
        for piece in self.pieces:
            promised = int(piece.get("NumberOfPoints", 0))
            arrays = piece.findall("Points/DataArray")
            values = self.values(arrays[0]) if arrays else np.zeros(0)
            held = values.size // 3
            promise(3 * promised == values.size, f"{promised} points and holds {held}")
            found.append(rows(values.astype(np.float64)))
        return np.concatenate(found)

    def cells(self, section: str) -> tuple[IntArray, IntArray]:
        """Return the corners of the cells of all pieces, and where each ends."""
        corners, ends = [np.zeros(0, dtype=np.int64)], [np.zeros(0, dtype=np.int64)]
        before = passed = 0
        for piece in self.pieces:
            promised = int(piece.get(f"NumberOf{section}", 0))
            if promised and piece.find(section) is not None:
                here = self._array(piece, section, "connectivity")
                stops = self._array(piece, section, "offsets")
                what = f"{promised} {section.lower()} and holds {len(stops)}"
                promise(len(stops) == promised, what)
                if (np.diff(stops, prepend=0) < 0).any() or stops[-1] != len(here):
                    raise ValueError("its offsets do not fit its cells")
                corners.append(here + before)
                ends.append(stops + passed)
                passed += len(here)
            elif promised:
                raise NotWholeError(
                    f"it promises {promised} {section.lower()} and holds none"
                )
            before += int(piece.get("NumberOfPoints", 0))
        return np.concatenate(corners), np.concatenate(ends)

    def point_fields(self) -> dict[str, NDArray[Any]]:
        """Return the arrays of numbers that all pieces have of their points, by name."""
        found = [self._fields(piece.find("PointData")) for piece in self.pieces]
        shared = [name for name in found[0] if all(name in one for one in found)]
        return {name: np.concatenate([one[name] for one in found]) for name in shared}

    def field_data(self) -> dict[str, NDArray[Any]]:
        """Return the arrays of numbers that belong to no point, by name."""
        return self._fields(self._data.find("FieldData"))

    def values(self, array: ElementTree.Element) -> NDArray[Any]:
        """Return the numbers of an array, as they come; raises NotWholeError."""
        kind = self._order + _TYPES[array.get("type", "")]
        if array.get("format") == "ascii":
            words = _text(array).split()
            number = float if "f" in kind else int
            return np.array([number(word) for word in words], dtype=kind[1:])
        content = self._content(array)
        promise(len(content) % int(kind[2]) == 0, "numbers that end in the middle")
        return np.frombuffer(content, kind).astype(kind[1:])

    def _array(self, piece: ElementTree.Element, section: str, name: str) -> IntArray:
        for array in piece.findall(f"{section}/DataArray"):
            if array.get("Name") == name:
                return self.values(array).astype(np.int64)
        raise NotWholeError(f"its {section} have no {name}")

    def _fields(self, parent: ElementTree.Element | None) -> dict[str, NDArray[Any]]:
        found = {}
        for array in parent if parent is not None else ():
            if array.tag == "DataArray" and array.get("type") in _TYPES:
                width = int(array.get("NumberOfComponents", 1))
                values = self.values(array)
                shaped = values.reshape(-1, width) if width > 1 else values
                found[array.get("Name", "")] = shaped
        return found

    def _content(self, array: ElementTree.Element) -> bytes:
        """Return the bytes of an array that is not text."""
        if array.get("format") == "appended":
            start = int(array.get("offset", 0))
            after = [place for place in self._offsets if place > start]
            content = self._appended[start : after[0] if after else start]
            stored = content if self._raw else _from_base64(content)
        else:
            stored = _from_base64(_text(array).encode("ascii"))
        size = int(self._head[-1])
        if not stored:
            return b""
        promise(len(stored) >= size, "an array that has no length")
        first = int(np.frombuffer(stored, self._head, 1)[0])
        if not self._compressor:
            promise(
                first <= len(stored) - size, f"an array of {first} bytes, and ends before"
            )
            return stored[size : size + first]
        promise((first + 3) * size <= len(stored), f"{first} blocks, and ends before")
        if not first:
            return b""
        _, block, last, *packed = np.frombuffer(stored, self._head, first + 3).tolist()
        place = (first + 3) * size
        promise(place + sum(packed) <= len(stored), "blocks that it does not hold")
        return b"".join(self._blocks(stored[place:], block, last, packed))

    def _blocks(
        self, stored: bytes, block: int, last: int, packed: list[int]
    ) -> Iterator[bytes]:
        place = 0
        for number, size in enumerate(packed):
            ends = number == len(packed) - 1
            wanted = last if ends and last else block
            found = self._unpacked(stored[place : place + size], wanted)
            promise(len(found) == wanted, "more than a block holds")
            place += size
            yield found

    def _unpacked(self, packed: bytes, size: int) -> bytes:
        # Never more than promised: a block may be made to swell.
        if "ZLib" in self._compressor:
            return zlib.decompressobj().decompress(packed, size or 1)
        if "LZMA" in self._compressor:
            return lzma.LZMADecompressor().decompress(packed, size)
        promise(size <= 256 * len(packed), "more than a block holds")
        return _from_lz4(packed, size)


def _text(array: ElementTree.Element) -> str:
    """Return the text of an array, without what else VTK says of it inside."""
    return (array.text or "") + "".join(child.tail or "" for child in array)


def _from_base64(text: bytes) -> bytes:
    # Lengths and data are encoded apart, each with its own end.
    parts = _BASE64.findall(b"".join(text.split()))
    return b"".join(base64.b64decode(part) for part in parts)


def _from_lz4(packed: bytes, size: int) -> bytes:
    from vtkmodules.vtkCommonCore import vtkObject
    from vtkmodules.vtkIOCore import vtkLZ4DataCompressor

    compressor: Any = vtkLZ4DataCompressor()
    given, found = np.frombuffer(packed, np.uint8), np.zeros(size, np.uint8)
    before = vtkObject.GetGlobalWarningDisplay()
    vtkObject.SetGlobalWarningDisplay(0)
    try:
        held = compressor.Uncompress(given, len(given), found, size)
    finally:
        vtkObject.SetGlobalWarningDisplay(before)
    return found[:held].tobytes()
