"""What a .vtp file says, in VTK's XML: every bit of a surface, compressed.

Written here and not by VTK, which takes longer to load than a short sweep to carry out.
"""

from __future__ import annotations

import base64
import struct
import zlib
from collections.abc import Mapping
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray, IntArray

Fields = Mapping[str, NDArray[Any]]

_KINDS = {"f": "Float", "i": "Int", "u": "UInt"}
# The fastest of zlib's levels; coordinates would lose a twenty-fifth of their size to it,
# and take longer than all else.
_LEVEL, _STORED = 1, 0
# So many bytes are stored as they are: to set up zlib takes longer than to write them.
_FEW = 2048
_NO_CELLS = np.empty((0, 1), dtype=np.int64)


def vtp_content(
    x: FloatArray,
    triangles: IntArray,
    loop: IntArray | None = None,
    point_fields: Fields | None = None,
    field_data: Fields | None = None,
) -> bytes:
    """Return what `write_vtp` writes."""
    lines = _NO_CELLS if loop is None else np.append(loop, loop[:1])[None]
    # In this order, which is the one of their numbers.
    cells = {"Verts": _NO_CELLS, "Lines": lines, "Strips": _NO_CELLS, "Polys": triangles}
    counts = "".join(f' NumberOf{name}="{len(rows)}"' for name, rows in cells.items())
    text = [
        '<?xml version="1.0"?>',
        '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" '
        'header_type="UInt64" compressor="vtkZLibDataCompressor">',
        "<PolyData>",
        *_section("FieldData", field_data or {}),
        f'<Piece NumberOfPoints="{len(x)}"{counts}>',
        *_section("PointData", point_fields or {}),
        "<Points>",
        _array("Points", x, _STORED),
        "</Points>",
    ]
    for name, rows in cells.items():
        text += _cells(name, rows)
    text += ["</Piece>", "</PolyData>", "</VTKFile>", ""]
    return "\n".join(text).encode("ascii", "xmlcharrefreplace")


def _section(name: str, arrays: Fields) -> list[str]:
    return [f"<{name}>", *(_array(*each) for each in arrays.items()), f"</{name}>"]


def _cells(name: str, vertices: IntArray) -> list[str]:
    """Return a section of cells of equal size, one row of vertex numbers each."""
    return _same_cells(name, vertices.astype("<i8").tobytes(), vertices.shape)


@lru_cache(maxsize=8)
def _same_cells(name: str, content: bytes, shape: tuple[int, int]) -> list[str]:
    """Return the same; one shape after another has the same cells."""
    flat, (count, size) = np.frombuffer(content, "<i8"), shape
    ends = size * np.arange(1, count + 1)
    return _section(name, {"connectivity": flat, "offsets": ends})


def _array(name: str, values: NDArray[Any], level: int = _LEVEL) -> str:
    """Return an array (n,) or (n, k) of numbers, or words (n,), as an element of XML."""
    if values.dtype.kind == "U":
        return _words(name, values.tolist())
    number = values.dtype.newbyteorder("<")
    content = np.ascontiguousarray(values, number).tobytes()
    width = values.shape[1] if values.ndim > 1 else 1
    return (
        f'<DataArray type="{_KINDS[number.kind]}{8 * number.itemsize}" Name="{name}" '
        f'NumberOfComponents="{width}" NumberOfTuples="{len(values)}" format="binary">'
        f"{_packed(content, level)}</DataArray>"
    )


def _words(name: str, words: list[str]) -> str:
    """Return words as VTK has them: the numbers of their letters, a zero after each."""
    letters = " ".join(str(letter) for word in words for letter in (*word.encode(), 0))
    return (
        f'<Array type="String" Name="{name}" NumberOfTuples="{len(words)}" '
        f'format="ascii">{letters}</Array>'
    )


def _packed(content: bytes, level: int) -> str:
    """Return bytes as VTK has them: lengths, and then all in one block, in base64."""
    if not content:
        return _base64(bytes(24))
    packed = _stored(content) if len(content) <= _FEW else zlib.compress(content, level)
    # How many blocks, their size, that of a last one that is smaller, and compressed.
    sizes = struct.pack("<4Q", 1, len(content), 0, len(packed))
    return _base64(sizes) + _base64(packed)


def _stored(content: bytes) -> bytes:
    """Return up to 65535 bytes in zlib's format, as they are (RFC 1950, 1951 3.2.4)."""
    size = len(content)
    head = struct.pack("<2sBHH", b"\x78\x01", 1, size, size ^ 0xFFFF)
    return head + content + struct.pack(">I", zlib.adler32(content))


def _base64(content: bytes) -> str:
    return base64.b64encode(content).decode("ascii")
