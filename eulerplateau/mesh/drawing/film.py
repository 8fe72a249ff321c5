"""What pyvista draws of a shape: the film, blue in front and orange behind, and its loop.

Runs in child processes only: where there is no OpenGL, VTK crashes instead of raising.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh.drawing.alignment import aligned
from eulerplateau.mesh.drawing.view import LOOP_RADIUS, UP, View, common_view
from eulerplateau.mesh.shape import Shape

# A blue and an orange, front and back of the film: in grey the front is the darker one.
FRONT, BACK, LOOP = (0.357, 0.643, 0.851), (0.980, 0.816, 0.612), (0.10, 0.10, 0.10)
GLOSS = {"ambient": 0.35, "diffuse": 0.65, "specular": 0.3}
_WIDTH = 800


def load_pyvista() -> Any:
    """Return pyvista, kept from writing on the error stream.

    VTK writes that there is no X server before it finds that it needs none.
    """
    import pyvista
    from vtkmodules.vtkCommonCore import vtkLogger

    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    return pyvista


def film_plotter(shape: Shape, window: bool, options: Mapping[str, Any]) -> Any:
    """Return a pyvista Plotter, in a window or off-screen, with a film and its loop.

    The film lies as in the pictures of a run: its longest axis along x, its front towards
    the viewer. `options` go to pyvista's add_mesh for the film.
    """
    pyvista = load_pyvista()
    (turned,) = aligned([shape])
    view = common_view([turned])
    size = list(view.size(_WIDTH))
    plotter: Any = pyvista.Plotter(off_screen=not window, window_size=size)
    plotter.set_background("white")
    plotter.enable_anti_aliasing("ssaa")
    film = pyvista.PolyData.from_regular_faces(turned.x, turned.triangles)
    plain = {"color": FRONT, "backface_params": {"color": BACK}}
    painted = {} if "scalars" in options else plain
    plotter.add_mesh(film, **{"smooth_shading": True, **painted, **options})
    plotter.add_mesh(loop_tube(turned.x_loop), color=LOOP, smooth_shading=True, **GLOSS)
    point_camera(plotter, view)
    return plotter


def loop_tube(
    x_loop: FloatArray,
    colours: Mapping[str, NDArray[Any]] | None = None,
    radius: float = LOOP_RADIUS,
) -> Any:
    """Return the tube (PolyData) of a radius round a closed loop (n_b, 3).

    `colours` are values (n_b,) or (n_b, 3) on the loop, by name.
    """
    pyvista = load_pyvista()
    # The wire passes its first edge twice: where the ends of VTK's tube meet end to end,
    # they are twisted against each other and pinch it.
    around = np.resize(np.arange(len(x_loop)), len(x_loop) + 2)
    points = x_loop[around]
    wire = pyvista.PolyData(points, lines=np.append(len(points), np.arange(len(points))))
    for name, values in (colours or {}).items():
        wire[name] = values[around]
    return wire.tube(radius=radius, n_sides=24)


def loop_stripe(x_loop: FloatArray, across: FloatArray, radius: float = LOOP_RADIUS) -> Any:
    """Return a stripe (PolyData) along the tube of `loop_tube`, from the first edge on.

    It lies where directions (n_b, 3) across the edges point, and runs from the first vertex
    round to it. It is open: where the rod was welded its ends need not meet.
    """
    pyvista = load_pyvista()
    ends = 1.5 * across[[0, -1]] - 0.5 * across[[1, -2]]
    ends /= np.linalg.norm(ends, axis=1)[:, None]
    middles = 0.5 * (x_loop + np.roll(x_loop, -1, axis=0))
    weld = x_loop[:1]
    along = np.concatenate([weld, middles, weld])
    directions = np.concatenate([ends[:1], across, ends[1:]])
    points = along + 0.8 * radius * directions
    line = pyvista.PolyData(points, lines=np.append(len(points), np.arange(len(points))))
    return line.tube(radius=0.4 * radius, n_sides=12)


def point_camera(plotter: Any, view: View) -> None:
    """Let a plotter see what a view shows."""
    plotter.camera.parallel_projection = True
    plotter.camera.focal_point = tuple(view.focus)
    plotter.camera.position = tuple(view.focus + 5 * view.eye)
    plotter.camera.up = tuple(UP)
    plotter.camera.parallel_scale = view.half[1]
    plotter.reset_camera_clipping_range()
