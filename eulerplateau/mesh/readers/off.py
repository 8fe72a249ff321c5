"""Read .off files: Geomview's, with normals and colours or without, as text."""

from __future__ import annotations

import re
from pathlib import Path

from eulerplateau.mesh.readers.content import Content, ForeignError, polygons, promise, rows

# Texture, colour, normal; homogeneous or other dimensions are not of this space.
_KEYWORD = re.compile(rb"(ST)?C?N?(4?n?)OFF")


def read_off(path: Path) -> Content:
    """Read a surface; what follows a vertex's place and a face's corners is left out."""
    split = (line.partition(b"#")[0].split() for line in path.read_bytes().splitlines())
    lines = [words for words in split if words]
    if not lines:
        raise ForeignError("holds nothing but comments")
    keyword = _KEYWORD.fullmatch(lines[0][0])
    if keyword:
        if keyword[2]:
            raise ForeignError("holds points that are not of three dimensions")
        if lines[0][1:2] == [b"BINARY"]:
            raise ForeignError("is a binary .off file: write it as text")
        lines[0] = lines[0][1:]
        lines = lines if lines[0] else lines[1:]
    elif not lines[0][0].isdigit():
        raise ForeignError("is no .off file: it does not begin with OFF")
    promise(bool(lines) and len(lines[0]) >= 2, "no counts yet")
    n, count = int(lines[0][0]), int(lines[0][1])
    found = len(lines) - 1
    promise(
        n >= 0 and count >= 0 and n + count <= found, f"{n} + {count} lines, not {found}"
    )
    if n + count < found:
        raise ValueError(f"it promises {n} + {count} lines and holds {found}")
    places, faces = lines[1 : n + 1], lines[n + 1 :]
    promise(all(len(place) >= 3 for place in places), "three coordinates a vertex")
    sizes = [int(face[0]) for face in faces]
    full = (len(face) > size for face, size in zip(faces, sizes, strict=True))
    promise(all(full), "more corners of a face than it holds")
    points = rows([float(word) for place in places for word in place[:3]])
    chosen = zip(faces, sizes, strict=True)
    return Content(points, *polygons([[*map(int, f[1 : s + 1])] for f, s in chosen]))
