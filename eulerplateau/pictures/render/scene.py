"""The window that nobody sees and VTK draws in: film and loop in, pixels out."""

from __future__ import annotations

from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh import Shape
from eulerplateau.mesh.drawing import (
    GLOSS,
    View,
    load_pyvista,
    loop_stripe,
    loop_tube,
    point_camera,
)
from eulerplateau.pictures.figure import load_matplotlib
from eulerplateau.pictures.render.colours import PaintedFilm
from eulerplateau.pictures.wire import Wire

_STRIPE = "#F7F7F7"

Pixels = NDArray[np.uint8]


class Scene:
    """A window that nobody sees; it is opened once for many pictures, in a `with`.

    It is as high as suits a view; all others have its scale.

    Needs an off-screen OpenGL: without one VTK crashes the process instead of raising.
    """

    def __init__(self, width: int, view: View) -> None:
        # First, since pyvista imports it whatever MPLBACKEND says.
        load_matplotlib()
        pyvista = load_pyvista()
        size = list(view.size(width))
        plotter: Any = pyvista.Plotter(off_screen=True, window_size=size, lighting="none")
        plotter.set_background("white")
        plotter.enable_anti_aliasing("ssaa")
        plotter.add_light(pyvista.Light(light_type="headlight", intensity=1.0))
        self._plotter = plotter

    def __enter__(self) -> Scene:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._plotter.close()

    def pixels(
        self,
        shape: Shape,
        film: PaintedFilm,
        loop_rgb: FloatArray,
        wire: Wire,
        view: View,
    ) -> Pixels:
        """Return an image (height, width, 3) of the film and its loop (n_b, 3 colours).

        Where the wire has marks a stripe runs along it.
        """
        plotter = self._plotter
        # Or each change would be rendered at once.
        plotter.suppress_rendering = True
        plotter.clear_actors()
        plotter.add_mesh(_surface(film), scalars="rgba", rgb=True, lighting=False)
        tube = loop_tube(shape.x_loop, {"rgb": _bytes(loop_rgb)}, wire.radius)
        plotter.add_mesh(tube, scalars="rgb", rgb=True, smooth_shading=True, **GLOSS)
        if wire.marks is not None:
            stripe = loop_stripe(shape.x_loop, wire.marks, wire.radius)
            plotter.add_mesh(stripe, color=_STRIPE, **GLOSS)
        point_camera(plotter, view)
        plotter.suppress_rendering = False
        plotter.render()
        # VTK's own files end up empty on a full disk, in silence: take the pixels instead.
        pixels: Pixels = plotter.screenshot(return_img=True)
        return pixels


def _surface(film: PaintedFilm) -> Any:
    import pyvista

    triangles: Any = np.arange(len(film.corners)).reshape(-1, 3)
    surface = pyvista.PolyData.from_regular_faces(film.corners, triangles)
    opaque = bool((film.rgba[:, 3] == 1.0).all())
    surface["rgba"] = _bytes(film.rgba[:, :3] if opaque else film.rgba)
    return surface


def _bytes(colours: FloatArray) -> Pixels:
    return np.rint(255.0 * np.clip(colours, 0.0, 1.0)).astype(np.uint8)
