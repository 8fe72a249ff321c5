"""The child that draws one film: `python -m eulerplateau.mesh.drawing FOLDER [--window]`.

FOLDER holds what `picture` has put there, and is where the picture goes. Without FOLDER it
draws a sphere, to find out whether that works here.
"""

from __future__ import annotations

import os
import pickle
import sys
from pathlib import Path
from typing import Any

from eulerplateau.mesh.drawing.film import film_plotter, load_pyvista
from eulerplateau.mesh.shape import Shape


def _draw(arguments: list[str]) -> None:
    # Of a notebook; matplotlib, which pyvista loads, need not have it here.
    os.environ.pop("MPLBACKEND", None)
    if not arguments:
        _draw_anything()
        return
    folder = Path(arguments[0])
    x, triangles, loop, options = pickle.loads((folder / "film.pickle").read_bytes())
    shape = Shape(x, triangles, loop)
    plotter = film_plotter(shape, False, options)
    plotter.screenshot(folder / "film.png")
    plotter.close()
    if "--window" in arguments:
        film_plotter(shape, True, options).show(title="eulerplateau")


def _draw_anything() -> None:
    pyvista = load_pyvista()
    plotter: Any = pyvista.Plotter(off_screen=True, window_size=[64, 64])
    plotter.add_mesh(pyvista.Sphere())
    plotter.screenshot(return_img=True)


if __name__ == "__main__":
    _draw(sys.argv[1:])
