"""Read .stl files: triangles that share no vertices, binary or text."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from eulerplateau.mesh.readers.content import Content, ForeignError, promise, rows

_HEADER, _TRIANGLE = 84, 50
_PLACE = re.compile(rb"^\s*vertex\s+(\S+)\s+(\S+)\s+(\S+)\s*$", re.MULTILINE)
_PLACE_BEGUN = re.compile(rb"^\s*vertex\b", re.MULTILINE)
_FACET = re.compile(rb"^\s*facet\b", re.MULTILINE)
_END = re.compile(rb"^\s*endsolid\b", re.MULTILINE)
_BEGIN = re.compile(rb"^\s*solid\b", re.MULTILINE)


def read_stl(path: Path) -> Content:
    """Read a soup of triangles."""
    content = path.read_bytes()
    places = _text(content) if _is_text(content) else _binary(content)
    n = len(places)
    return Content(places, np.arange(n), np.full(n // 3, 3))


def _is_text(content: bytes) -> bool:
    # A binary file's header may begin with "solid" too.
    return content.lstrip()[:5] == b"solid" and b"\0" not in content[:1000]


def _binary(content: bytes) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    promise(len(content) >= _HEADER, "a header of 84 bytes")
    count = int.from_bytes(content[80:_HEADER], "little")
    held = (len(content) - _HEADER) // _TRIANGLE
    text = sum(32 <= byte < 127 or byte in b"\t\r\n" for byte in content) == len(content)
    if text:
        raise ForeignError("is no .stl file: it does not begin with solid")
    promise(count <= held, f"{count} triangles and holds {held}")
    if len(content) != _HEADER + count * _TRIANGLE:
        raise ValueError(f"it promises {count} triangles and is longer than they are")
    kind = np.dtype([("normal", "<f4", 3), ("places", "<f4", 9), ("rest", "<u2")])
    return rows(np.frombuffer(content, kind, count, _HEADER)["places"].astype(np.float64))


def _text(content: bytes) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    places = _PLACE.findall(content)
    facets = len(_FACET.findall(content))
    ended = len(_END.findall(content)) == len(_BEGIN.findall(content))
    promise(ended and bool(content.rstrip()), "an endsolid for every solid")
    promise(len(_PLACE_BEGUN.findall(content)) == len(places), "three coordinates a vertex")
    promise(3 * facets == len(places), "three vertices a facet")
    return rows([float(word) for place in places for word in place])
