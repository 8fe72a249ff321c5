"""Read .msh files of any version by Gmsh, in a child process: a broken one may kill it."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path

import numpy as np

from eulerplateau.errors import MissingLibraryError
from eulerplateau.mesh.drawing.child import failure_of_child
from eulerplateau.mesh.readers.content import (
    Content,
    ForeignError,
    NotWholeError,
    promise,
    rows,
)

_CHILD = "eulerplateau.mesh.readers"
_PATIENCE = 600.0
# What sections are called: the last names are those of version 1.
_SECTIONS = {"nodes": rb"Nodes|ParametricNodes|NOD", "elements": rb"Elements|ELM"}
# No node and no element takes less of a file.
_FEWEST_BYTES = 4


def read_msh(path: Path) -> Content:
    """Read the surface elements, those of higher order by their corners."""
    _check(path.read_bytes())
    with tempfile.TemporaryDirectory() as folder:
        # In a folder of its own: Gmsh carries out the commands in path.opt.
        alone, target = Path(folder) / "mesh.msh", Path(folder) / "content.npz"
        alone.symlink_to(path.absolute())
        failure = failure_of_child(_CHILD, str(alone), str(target), timeout=_PATIENCE)
        _, missing, problem = failure.partition("MissingLibraryError: ")
        if missing:
            raise MissingLibraryError(problem)
        if failure:
            raise NotWholeError(f"Gmsh: {failure.removeprefix('Exception: ')}")
        with np.load(target) as found:
            held = {name: found[name] for name in found.files}
    if len(held["solids"]):
        raise ForeignError(
            f"holds {held['solids'][0].lower()}; a film is a surface of triangles"
        )
    points, curved = rows(held["points"]), int(held["curved"])
    return Content(points, held["corners"], held["sizes"], curved, held["beside"])


def _check(content: bytes) -> None:
    """Compare what is promised with the file's size, before Gmsh takes the memory.

    Gmsh would also carry out a file that is no mesh, as a script.
    """
    if not content.lstrip().startswith((b"$MeshFormat", b"$NOD", b"$Comments")):
        raise ForeignError("is no .msh file of Gmsh: it does not begin with $MeshFormat")
    for what, names in _SECTIONS.items():
        begun = re.search(rb"^\$(%s)[ \t\r]*\n" % names, content, re.MULTILINE)
        ended = re.search(rb"^\$E(?i:nd)(%s)\b" % names, content, re.MULTILINE)
        if begun is None or ended is None:
            raise NotWholeError(f"it has no end of its {what}")
        count = _count(content, begun.end())
        promise(0 <= count <= len(content) // _FEWEST_BYTES, f"{count} {what}")


def _count(content: bytes, start: int) -> int:
    """Return how many nodes or elements a section promises."""
    head = re.match(
        rb"\s*\$MeshFormat\s+([\d.]+)\s+(\d)\s+(\d)[^\n]*\n(.{4})", content, re.S
    )
    line = content[start : content.find(b"\n", start)].split()
    if head is None or float(head[1]) < 4:  # one number, as text, in binary files too
        return int(line[0])
    if head[2] == b"0":
        return int(line[1])
    order = "<" if head[4] == b"\1\0\0\0" else ">"
    size = int(head[3]) if float(head[1]) > 4.05 else 8
    return int(np.frombuffer(content, f"{order}u{size}", 2, start)[1])
