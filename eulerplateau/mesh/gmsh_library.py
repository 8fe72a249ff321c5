"""Gmsh, started and ended: with nobody's configuration, and without a word."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from types import ModuleType

from eulerplateau.errors import MissingLibraryError

_PACKAGES = "libgl1 libglu1-mesa libxft2 libxcursor1 libxinerama1 libgomp1"


@contextmanager
def started_gmsh() -> Iterator[ModuleType]:
    """Yield Gmsh, silent and on one thread; raises MissingLibraryError."""
    try:
        import gmsh
    except OSError as error:
        raise MissingLibraryError(
            f"Gmsh cannot be loaded ({error}); on Debian: "
            f"apt-get update && apt-get install {_PACKAGES}"
        ) from None
    # A user's ~/.gmshrc must not change the mesh; signals only work in the main thread.
    gmsh.initialize(readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("General.NumThreads", 1)
        yield gmsh
    finally:
        gmsh.finalize()
