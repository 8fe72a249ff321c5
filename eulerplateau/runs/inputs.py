"""What a run reads: its mesh, and the contents of the files that it names."""

from __future__ import annotations

from functools import lru_cache
from hashlib import sha256
from pathlib import Path

from eulerplateau.mesh import Disk, MeshSpec, generate, read_disk
from eulerplateau.runs.spec import RunSpec, StoredMesh


def make_mesh(spec: RunSpec) -> Disk:
    """Read or generate the mesh of a run; the last ones are kept, for runs that share them.

    What was read is known by its contents.
    """
    stored = spec.mesh.file if isinstance(spec.mesh, StoredMesh) else None
    return _made(spec.mesh, contents(stored))


def contents(path: str | None) -> str | None:
    """Return the SHA-256 of a file's contents; None without one, or if it is not there."""
    if path is None:
        return None
    try:
        about = Path(path).stat()
        return _digest(path, about.st_mtime_ns, about.st_size, about.st_ino)
    except OSError:
        return None


@lru_cache(maxsize=2)
def _made(mesh: StoredMesh | MeshSpec, _contents: str | None) -> Disk:
    if isinstance(mesh, StoredMesh):
        return read_disk(Path(mesh.file))
    return generate(mesh)


@lru_cache(maxsize=64)
def _digest(path: str, *_version: int) -> str:
    """Return the SHA-256 of a file, read once while its time, size and number stay."""
    return sha256(Path(path).read_bytes()).hexdigest()
