"""Pictures of the film; `python -m eulerplateau.render DIR STEP...` makes them.

The film is blue on the side its normal points to and orange on the other, so that it is
seen to turn over; the loop is a tube. All pictures of a run have one view and one scale.
"""

from __future__ import annotations

import io
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eulerplateau.errors import OutputError
from eulerplateau.mesh import FloatArray
from eulerplateau.output.child import draw_in_child
from eulerplateau.output.files import write_whole
from eulerplateau.output.folder import picture_name, shape_name
from eulerplateau.output.vtk import Shape, read_shape

_FRONT, _BACK, _LOOP = "#6FB1DE", "#F0A35E", "#2B2B2B"
# Opaque: VTK's depth peeling shows the wrong side of translucent films, by triangles.
_GLOSS: dict[str, Any] = {
    "ambient": 0.5,
    "diffuse": 0.55,
    "specular": 0.12,
    "specular_power": 15,
}
_LOOP_RADIUS = 0.0035
_SIZE = (1200, 900)
_DPI = 150
# From here the film is seen, if nothing is edge-on to it: slanted, from the front.
_EYE = np.array([0.2, -0.75, 0.65])
_UP = np.array([0.0, 0.0, 1.0])
_SLANTED = 0.7
_ALMOST = 0.03
_MARGIN = 1.2
_SECONDS = 600.0


def draw_shapes(folder: Path, steps: Sequence[int]) -> bool:
    """Render the shapes of `steps` in a child process; return whether all were drawn."""
    if not steps:
        return True
    chosen = [str(step) for step in steps]
    return draw_in_child("eulerplateau.render", str(folder), *chosen, timeout=_SECONDS)


def render_shapes(folder: Path, steps: Sequence[int]) -> None:
    """Render the shapes of `steps` of a run folder to pictures/shape_*.png.

    There must be a step. Needs an off-screen OpenGL; without one VTK crashes the process
    instead of raising: call `draw_shapes` where that matters. Raises OutputError if a
    shape cannot be read or a picture not written.
    """
    shapes = aligned([read_shape(folder / shape_name(step)) for step in steps])
    try:
        (folder / "pictures").mkdir(exist_ok=True)
    except OSError as error:
        problem = f"cannot be made: {error.strerror}"
        raise OutputError(folder / "pictures", problem) from None
    view = _common_view(shapes)
    for shape in shapes:
        write_whole(folder / picture_name(shape.step), _picture(shape, view))


def aligned(shapes: Sequence[Shape]) -> list[Shape]:
    """Return the shapes free of the rigid motion an equilibrium leaves undetermined.

    Each loop is centred at the origin, its longest principal axis along x and its
    shortest along z, and then turned by half a turn about an axis, or not, to lie as close
    to its predecessor as it can. (Turning it there all the way, by Kabsch's method, would
    stand the flat eight on edge: the two halves of the film it comes from turn by a
    quarter each, in opposite senses.) The first loop has its normal along +z. A tie, which
    only symmetric films can have, falls either way.
    """
    turned: list[Shape] = []
    for shape in shapes:
        x = shape.x - shape.x[shape.loop].mean(axis=0)
        choices = [x @ axes for axes in _principal_axes(x[shape.loop])]
        if turned:
            before = turned[-1].x[shape.loop]
            away = [np.linalg.norm(choice[shape.loop] - before) for choice in choices]
        else:
            away = [-_area_vector(choice[shape.loop])[2] for choice in choices]
        turned.append(replace(shape, x=choices[int(np.argmin(away))]))
    return turned


def _principal_axes(loop: FloatArray) -> list[FloatArray]:
    """Return the four right-handed sets of axes, as columns (3, 3), longest axis first."""
    axes = np.linalg.svd(loop, full_matrices=False)[2].T
    axes[:, 2] = np.cross(axes[:, 0], axes[:, 1])
    signs = ((1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1))
    return [axes * np.array(sign) for sign in signs]


def _area_vector(loop: FloatArray) -> FloatArray:
    area: FloatArray = 0.5 * np.cross(loop, np.roll(loop, -1, axis=0)).sum(axis=0)
    return area


@dataclass(frozen=True)
class _View:
    """One camera for all pictures of a run: no perspective, so that sizes compare."""

    eye: FloatArray  # (3,) unit vector from the film towards the camera
    focus: FloatArray  # (3,)
    half_height: float


def _common_view(shapes: Sequence[Shape]) -> _View:
    """Return a view that holds all shapes and sees none of them edge-on."""
    eyes = _candidate_eyes()
    worst = np.min([_visible_part(shape, eyes) for shape in shapes], axis=0)
    good = eyes[worst > worst.max() - _ALMOST]
    eye = good[np.argmax(good @ _EYE)]
    right = np.cross(_UP, eye)
    right /= np.linalg.norm(right)
    axes = np.stack([right, np.cross(eye, right)], axis=1)
    flat = np.concatenate([shape.x for shape in shapes]) @ axes
    low, high = flat.min(axis=0), flat.max(axis=0)
    half_width, half_height = 0.5 * (high - low) + _LOOP_RADIUS
    half = float(max(half_height, half_width * _SIZE[1] / _SIZE[0]))
    return _View(eye, axes @ (0.5 * (low + high)), _MARGIN * half)


def _candidate_eyes() -> FloatArray:
    """Return directions (n, 3) around the front (-y), 25 to 75 degrees above z = 0."""
    turn, height = np.radians(
        np.meshgrid(np.arange(-30, 31, 10), np.arange(25, 76, 10))
    ).reshape(2, -1)
    across = np.cos(height)
    return np.stack([across * np.sin(turn), -across * np.cos(turn), np.sin(height)], axis=1)


def _visible_part(shape: Shape, eyes: FloatArray) -> FloatArray:
    """Return how much of a film (0 to _SLANTED) each eye sees, part by part.

    A part seen slanted reads better than one faced: beyond _SLANTED it counts no more, so
    that an eye that sees both lobes aslant beats one that faces one and misses the other.
    """
    a, b, c = shape.x[shape.triangles].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    areas = np.linalg.norm(normals, axis=1)
    facing = np.abs(normals @ eyes.T) / areas[:, None]
    part: FloatArray = areas @ np.minimum(facing, _SLANTED) / areas.sum()
    return part


def _picture(shape: Shape, view: _View) -> bytes:
    """Return the PNG of one shape with its load written below."""
    from matplotlib.figure import Figure

    width, height = _SIZE
    figure = Figure(figsize=(width / _DPI, height / _DPI), dpi=_DPI)
    figure.figimage(_pixels(shape, view))
    figure.text(0.03, 0.04, rf"$kL^3/\alpha = {shape.load:.6g}$", fontsize=13)
    content = io.BytesIO()
    figure.savefig(content, format="png")
    return content.getvalue()


def _pixels(shape: Shape, view: _View) -> NDArray[np.uint8]:
    """Return the rendered film and loop as an image (height, width, 3)."""
    import pyvista

    plotter: Any = pyvista.Plotter(
        off_screen=True, window_size=list(_SIZE), lighting="none"
    )
    plotter.set_background("white")
    plotter.enable_anti_aliasing("ssaa")
    plotter.add_light(pyvista.Light(light_type="headlight", intensity=1.0))
    sides: Any = shape.triangles
    film = pyvista.PolyData.from_regular_faces(shape.x, sides)
    plotter.add_mesh(
        film,
        color=_FRONT,
        backface_params={"color": _BACK, **_GLOSS},
        smooth_shading=True,
        **_GLOSS,
    )
    plotter.add_mesh(_tube(shape), color=_LOOP, smooth_shading=True, specular=0.3)
    plotter.camera.focal_point = tuple(view.focus)
    plotter.camera.position = tuple(view.focus + 5 * view.eye)
    plotter.camera.up = tuple(_UP)
    plotter.camera.parallel_projection = True
    plotter.camera.parallel_scale = view.half_height
    plotter.reset_camera_clipping_range()
    # VTK's own files end up empty on a full disk, in silence: take the pixels instead.
    pixels: NDArray[np.uint8] = plotter.screenshot(return_img=True)
    plotter.close()
    return pixels


def _tube(shape: Shape) -> Any:
    import pyvista

    # The wire passes its first edge twice: where the ends of VTK's tube meet end to end,
    # they are twisted against each other and pinch it.
    points = shape.x[np.resize(shape.loop, len(shape.loop) + 2)]
    wire = pyvista.PolyData(points, lines=np.append(len(points), np.arange(len(points))))
    return wire.tube(radius=_LOOP_RADIUS, n_sides=24)


if __name__ == "__main__":
    render_shapes(Path(sys.argv[1]), [int(step) for step in sys.argv[2:]])
