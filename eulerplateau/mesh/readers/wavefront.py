"""Read .obj files: Wavefront's, whose faces name vertices, textures and normals."""

from __future__ import annotations

from pathlib import Path

from eulerplateau.mesh.readers.content import (
    Content,
    ForeignError,
    NotWholeError,
    polygons,
    rows,
)


def read_obj(path: Path) -> Content:
    """Read the vertices and faces; the file does not say how many there should be."""
    text = path.read_bytes().replace(b"\\\r\n", b" ").replace(b"\\\n", b" ")
    if b"\0" in text:
        raise ForeignError("is no .obj file: it is no text")
    places: list[list[bytes]] = []
    faces: list[list[int]] = []
    for line in text.splitlines():
        words = line.partition(b"#")[0].split()
        if words[:1] == [b"v"]:
            if len(words) < 4:
                raise NotWholeError(
                    f"vertex {len(places) + 1} has {len(words) - 1} coordinates"
                )
            places.append(words[1:4])
        elif words[:1] == [b"f"]:
            faces.append([_vertex(word, len(places)) for word in words[1:]])
    if not places:
        raise ForeignError("is no .obj file: it has no line of a vertex (v x y z)")
    points = rows([float(word) for place in places for word in place])
    return Content(points, *polygons(faces))


def _vertex(word: bytes, so_far: int) -> int:
    """Return the vertex, from 0, of a corner such as 7/3/9; -1 is the last one so far."""
    number = int(word.partition(b"/")[0])
    return number - 1 if number > 0 else so_far + number if number else -1
