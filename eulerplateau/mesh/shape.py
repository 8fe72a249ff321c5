"""A shape: where the vertices of a triangulated surface are, and what joins them."""

from __future__ import annotations

import logging
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import EulerPlateauError

if TYPE_CHECKING:
    from eulerplateau.mesh.drawing.picture import Picture

_log = logging.getLogger(__name__)


@dataclass(frozen=True, eq=False, repr=False)
class Shape:
    """A triangulated surface bounded by a loop; lengths in units of L.

    Attributes
    ----------
    x : (n_v, 3) float
    triangles : (n_t, 3) int
        Counter-clockwise seen from the side the film's normal points to.
    loop : (n_b,) int
        Its boundary vertices, cyclic, with the film on the left.
    """

    x: FloatArray
    triangles: IntArray
    loop: IntArray

    def __repr__(self) -> str:
        """Return one line: how many vertices, triangles and loop vertices."""
        sizes = f"{len(self.x)} vertices, {len(self.triangles)} triangles"
        return f"<Shape: {sizes}, {len(self.loop)} vertices on the loop>"

    @property
    def x_loop(self) -> FloatArray:
        """Positions of the loop (n_b, 3)."""
        return self.x[self.loop]

    def moved(self, x: FloatArray) -> Shape:
        """Return the surface with its vertices at x (n_v, 3)."""
        return replace(self, x=x)

    def write(self, path: str | Path) -> None:
        """Write the surface, lengths in units of L, to a file; whole or not at all.

        The extension says how: .vtp, exactly and with the loop as a closed line, or what
        `write_mesh` knows. Raises MeshError for another extension, OutputError if the file
        cannot be written.
        """
        from eulerplateau.mesh.writing import write_triangles, write_vtp

        if Path(path).suffix.lower() == ".vtp":
            write_vtp(Path(path), self.x, self.triangles, loop=self.loop)
        else:
            write_triangles(Path(path), self.x, self.triangles)

    def plot(self, *, window: bool | None = None, **options: Any) -> Picture:
        """Show the film, blue where its normal points to, and its loop; return a picture.

        Where there is a display it opens in a `window`, to be turned and closed, unless
        that is False; a notebook shows the picture that is returned, and its `write` saves
        it. Window and picture are made by pyvista in a child process. `options` are those
        of its `add_mesh` for the film: opacity=0.5, show_edges=True, scalars=(n_v,) values.

        Raises MissingLibraryError, which says what to install, where drawing does not work,
        and SpecError if pyvista cannot draw this film with these options.
        """
        from eulerplateau.mesh.drawing.picture import draw_film, windows_open

        shown = windows_open() if window is None else window
        surface = self.x, self.triangles, self.loop
        return draw_film(*surface, window=shown, options=options)

    def _repr_png_(self) -> bytes | None:
        """Return what a notebook shows: a picture, or None where none can be drawn."""
        from eulerplateau.mesh.drawing.picture import draw_film

        surface = self.x, self.triangles, self.loop
        try:
            return draw_film(*surface, window=False, options={}).png
        except EulerPlateauError as error:
            _log.warning("%s", error)
            return None
