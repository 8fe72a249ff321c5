"""Read .msh files of any version by Gmsh, in a child process: a broken one may kill it."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path

import numpy as np

from eulerplateau.errors import MissingLibraryError
from eulerplateau.mesh.drawing.child import failure_of_child
from eulerplateau.mesh.readers.content import Content, Foreign, NotWhole, promise, rows

_CHILD = "eulerplateau.mesh.readers"
_PATIENCE = 600.0
_SECTION = re.compile(rb"^\$(Nodes|Elements|NOD|ELM)[ \t\r]*\n", re.MULTILINE)
_END = re.compile(rb"^\$(?:End(Nodes|Elements)|END(NOD|ELM))\b", re.MULTILINE)
# No node and no element takes less of a file.
_FEWEST_BYTES = 4


def read_msh(path: Path) -> Content:
    """Read the surface elements, those of higher order by their corners."""
    _check(path.read_bytes())
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "content.npz"
        words = str(path.absolute()), str(target)
        failure = failure_of_child(_CHILD, *words, timeout=_PATIENCE)
        _, missing, problem = failure.partition("MissingLibraryError: ")
        if missing:
            raise MissingLibraryError(problem)
        if failure:
            raise NotWhole(f"Gmsh: {failure.removeprefix('Exception: ')}")
        with np.load(target) as found:
            held = {name: found[name] for name in found.files}
    if len(held["solids"]):
        raise Foreign(f"holds {held['solids'][0].lower()}; a film is a surface of triangles")
    points, curved = rows(held["points"]), int(held["curved"])
    return Content(points, held["corners"], held["sizes"], curved, held["beside"])


def _check(content: bytes) -> None:
    """Compare what is promised with the file's size, before Gmsh takes the memory.

    Gmsh would also carry out a file that is no mesh, as a script.
    """
    if not content.lstrip().startswith((b"$MeshFormat", b"$NOD", b"$Comments")):
        raise Foreign("is no .msh file of Gmsh: it does not begin with $MeshFormat")
    begun = {match[1].upper()[:3]: match for match in _SECTION.finditer(content)}
    ended = {(match[1] or match[2]).upper()[:3] for match in _END.finditer(content)}
    for name, alike in ((b"NOD", "nodes"), (b"ELE", "elements")):
        name = name if name in begun else b"ELM" if name == b"ELE" else name
        if name not in begun or name not in ended:
            raise NotWhole(f"it has no end of its {alike}")
        count = _count(content, begun[name].end())
        promise(0 <= count <= len(content) // _FEWEST_BYTES, f"{count} {alike}")


def _count(content: bytes, start: int) -> int:
    """Return how many nodes or elements a section promises."""
    head = re.match(rb"\s*\$MeshFormat\s+([\d.]+)\s+(\d)\s+(\d)[^\n]*\n(.{4})", content, re.S)
    line = content[start : content.find(b"\n", start)].split()
    if head is None or float(head[1]) < 4:  # one number, as text, in binary files too
        return int(line[0])
    if head[2] == b"0":
        return int(line[1])
    order = "<" if head[4] == b"\1\0\0\0" else ">"
    size = int(head[3]) if float(head[1]) > 4.05 else 8
    return int(np.frombuffer(content, f"{order}u{size}", 2, start)[1])
