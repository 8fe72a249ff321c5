"""The window that nobody sees and VTK draws in: film and loop in, pixels out."""

from __future__ import annotations

from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh import Shape
from eulerplateau.pictures.figure import load_matplotlib
from eulerplateau.pictures.render.colours import PaintedFilm
from eulerplateau.pictures.view import ASPECT, LOOP_RADIUS, UP, View

Pixels = NDArray[np.uint8]
_GLOSS = {"ambient": 0.35, "diffuse": 0.65, "specular": 0.3}


class Scene:
    """A window that nobody sees; it is opened once for many pictures, in a `with`.

    Needs an off-screen OpenGL: without one VTK crashes the process instead of raising.
    """

    def __init__(self, width: int) -> None:
        # First, since pyvista imports it whatever MPLBACKEND says.
        load_matplotlib()
        import pyvista
        from vtkmodules.vtkCommonCore import vtkLogger

        # VTK writes that there is no X server before it finds that it needs none.
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
        size = [width, round(ASPECT * width)]
        plotter: Any = pyvista.Plotter(off_screen=True, window_size=size, lighting="none")
        plotter.set_background("white")
        plotter.enable_anti_aliasing("ssaa")
        plotter.add_light(pyvista.Light(light_type="headlight", intensity=1.0))
        plotter.camera.parallel_projection = True
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
        self, shape: Shape, film: PaintedFilm, loop_rgb: FloatArray, view: View
    ) -> Pixels:
        """Return an image (height, width, 3) of the film and its loop (n_b, 3 colours)."""
        plotter = self._plotter
        # Or each change would be rendered at once.
        plotter.suppress_rendering = True
        plotter.clear_actors()
        plotter.add_mesh(_surface(film), scalars="rgba", rgb=True, lighting=False)
        tube = _tube(shape, loop_rgb)
        plotter.add_mesh(tube, scalars="rgb", rgb=True, smooth_shading=True, **_GLOSS)
        plotter.camera.focal_point = tuple(view.focus)
        plotter.camera.position = tuple(view.focus + 5 * view.eye)
        plotter.camera.up = tuple(UP)
        plotter.camera.parallel_scale = view.half_height
        plotter.reset_camera_clipping_range()
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


def _tube(shape: Shape, rgb: FloatArray) -> Any:
    import pyvista

    # The wire passes its first edge twice: where the ends of VTK's tube meet end to end,
    # they are twisted against each other and pinch it.
    around = np.resize(np.arange(len(shape.loop)), len(shape.loop) + 2)
    points = shape.x[shape.loop[around]]
    wire = pyvista.PolyData(points, lines=np.append(len(points), np.arange(len(points))))
    wire["rgb"] = _bytes(rgb[around])
    return wire.tube(radius=LOOP_RADIUS, n_sides=24)


def _bytes(colours: FloatArray) -> Pixels:
    return np.rint(255.0 * np.clip(colours, 0.0, 1.0)).astype(np.uint8)
