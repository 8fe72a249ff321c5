"""The child in which Gmsh reads: `python -m eulerplateau.mesh.readers FILE.msh TO.npz`."""

from __future__ import annotations

import contextlib
import sys
from pathlib import Path

import numpy as np

from eulerplateau.mesh.gmsh_library import started_gmsh

# Of addresses, before the file's size: what Gmsh's library itself takes, and as much again.
_ROOM = 4 << 30
_ROOM_PER_BYTE = 500


def _read(path: Path, target: Path) -> None:
    _limit_memory(path)
    with started_gmsh() as gmsh:
        mesh = gmsh.model.mesh
        gmsh.logger.start()
        gmsh.merge(str(path))
        wrong = [line for line in gmsh.logger.get() if line.startswith("Error")]
        if wrong:
            raise SystemExit(wrong[0].removeprefix("Error").lstrip(" :"))
        tags, places, _ = mesh.getNodes()
        tags, first = np.unique(tags, return_index=True)
        names, corners, sizes, order, every, curved = [], [], [], [], [], 0
        for kind in mesh.getElementTypes():
            name, dimension, _, n, _, n_corners = mesh.getElementProperties(kind)
            elements, nodes = mesh.getElementsByType(kind)
            every.append(nodes)
            if dimension == 3:
                names.append(name)
            elif dimension == 2 and "Polygon" not in name:
                curved += len(elements) if n > n_corners else 0
                corners += [*nodes.reshape(-1, n)[:, :n_corners]]
                sizes += [n_corners] * len(elements)
                order += [*elements]
        # As in the file, where they are numbered so.
        ranked = np.argsort(np.array(order, dtype=np.uint64), kind="stable")
        flat = [corners[place] for place in ranked]
        none = np.zeros(0, np.uint64)
        np.savez(
            target,
            points=places.reshape(-1, 3)[first],
            corners=np.searchsorted(tags, np.concatenate([none, *flat])),
            beside=np.searchsorted(tags, np.concatenate([none, *every])),
            sizes=np.array(sizes, dtype=np.int64)[ranked],
            curved=curved,
            solids=np.array(names, dtype=str),
        )


def _limit_memory(path: Path) -> None:
    # A file may promise more than any machine holds.
    import resource

    room = _ROOM + _ROOM_PER_BYTE * path.stat().st_size
    with contextlib.suppress(ValueError, OSError):
        resource.setrlimit(resource.RLIMIT_AS, (room, room))


if __name__ == "__main__":
    _read(Path(sys.argv[1]), Path(sys.argv[2]))
