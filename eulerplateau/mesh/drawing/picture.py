"""A film in a window, or as a picture; a child process draws it, since VTK may crash."""

from __future__ import annotations

import functools
import os
import pickle
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import MissingLibraryError, OutputError, SpecError
from eulerplateau.mesh.drawing.child import failure_of_child
from eulerplateau.mesh.whole_files import write_whole

_CHILD = "eulerplateau.mesh.drawing"
# Seconds after which a driver that hangs is given up.
_PATIENCE = 120.0
# What pyvista needs to draw without a display on Debian, which knows them after an update.
_PACKAGES = "libegl1 libegl-mesa0 libgl1 libgl1-mesa-dri"


@dataclass(frozen=True, repr=False)
class Picture:
    """The picture of a film, which a notebook shows; `png` is the content of a file."""

    png: bytes

    def __repr__(self) -> str:
        return f"<Picture: PNG, {len(self.png)} bytes>"

    def _repr_png_(self) -> bytes:
        return self.png

    def write(self, path: str | Path) -> None:
        """Write the picture to a .png file; raises OutputError if that cannot be done."""
        write_whole(Path(path), self.png)


def draw_film(
    x: FloatArray,
    triangles: IntArray,
    loop: IntArray,
    *,
    window: bool,
    options: Mapping[str, Any],
) -> Picture:
    """Draw a film, first in a window that waits to be closed if `window`.

    `options` go to pyvista's add_mesh for the film. Raises MissingLibraryError where films
    cannot be drawn at all, and SpecError if this one, or its options, is the reason.

    Parameters
    ----------
    x : (n_v, 3) float
    triangles : (n_t, 3) int
    loop : (n_b,) int, cyclic
    """
    if _failure_of_drawing.cache_info().currsize:  # another film has failed before
        check_drawing()
    try:
        with TemporaryDirectory(prefix="eulerplateau-") as folder:
            content = pickle.dumps((x, triangles, loop, dict(options)))
            Path(folder, "film.pickle").write_bytes(content)
            arguments = [folder, "--window"] if window else [folder]
            patience = None if window else _PATIENCE
            failure = failure_of_child(_CHILD, *arguments, timeout=patience)
            if failure:
                check_drawing()
                raise SpecError("plot", f"this film cannot be drawn: {failure}")
            return Picture(Path(folder, "film.png").read_bytes())
    except OSError as error:
        problem = f"cannot be written: {error.strerror}"
        raise OutputError(error.filename or "the picture", problem) from None


def check_drawing() -> None:
    """Raise MissingLibraryError, which says what to install, if no film can be drawn here.

    A child process finds out, once: where a driver is missing VTK crashes.
    """
    failure = _failure_of_drawing()
    if failure:
        raise MissingLibraryError(
            f"films cannot be drawn here ({failure}): pyvista needs OpenGL; on Debian: "
            f"apt-get update && apt-get install {_PACKAGES}"
        )


@functools.cache
def _failure_of_drawing() -> str:
    return failure_of_child(_CHILD, timeout=_PATIENCE)


def windows_open() -> bool:
    """Whether to show a film in a window: there is a display, and this is no notebook."""
    display = sys.platform in ("darwin", "win32") or bool(os.environ.get("DISPLAY"))
    return display and "ipykernel" not in sys.modules
