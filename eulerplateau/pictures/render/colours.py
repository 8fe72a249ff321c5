"""The colours of film and loop: by the film's side, like soap, or by a field.

The film is lit and coloured here, corner by corner, and only painted by VTK, whose depth
peeling shows the wrong side of translucent two-sided films, by triangles.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import SpecError
from eulerplateau.mesh import Shape
from eulerplateau.mesh.drawing import BACK, FRONT, LOOP
from eulerplateau.pictures.figure import FieldLook, load_matplotlib

SIDES, SOAP = "sides", "soap"
_GREY_FRONT, _GREY_BACK = np.full(3, 0.93), np.full(3, 0.72)
# The back of a film coloured by a field is this much darker.
_DARKER = 0.8
# So much that the back, the lighter colour, is lighter in grey too however it lies.
_AMBIENT, _SHINE = 0.7, 25
# Light changes the colours of a field less, or they could not be read off the bar.
_AMBIENT_OF_FIELD = 0.75
# Opacity of soap film seen straight on; seen aslant there is more of it in the way.
_THIN = 0.38
# Nothing in units of L is coloured on a finer scale than this: it would show rounding.
_FINEST = 1e-6


@dataclass(frozen=True)
class Scale:
    """What colour a value has, the same in all pictures made together.

    Attributes
    ----------
    label : str, the field as it is written beside the colour bar
    low, high : float; values beyond take the colours of the ends
    colours : str, matplotlib's name of the map, of one that ascends in lightness
    """

    label: str
    low: float
    high: float
    colours: str

    def rgb(self, values: FloatArray) -> FloatArray:
        """Return the colours (n, 3) of `values` (n,)."""
        load_matplotlib()
        from matplotlib import colormaps

        part = np.clip((values - self.low) / (self.high - self.low), 0.0, 1.0)
        colours: FloatArray = colormaps[self.colours](part)[:, :3]
        return colours


def scale_of(
    name: str, fields: Sequence[FloatArray], look: FieldLook | None = None
) -> Scale:
    """Return the scale for the values of a field (n_v,) on several shapes, NaN left out.

    It spans the middle 90 % of them on every shape, symmetrically for one that has a sign.
    Raises SpecError if there is no finite value.
    """
    look = look or FieldLook(name.replace("_", " "))
    finite = [values[np.isfinite(values)] for values in fields]
    ranges = [np.percentile(values, [5, 95]) for values in finite if len(values)]
    if not ranges:
        raise SpecError("--colour", f"{name} has no finite value on these shapes")
    low, high = float(np.min(ranges)), float(np.max(ranges))
    if look.signed:
        half = max(-low, high, _FINEST)
        # Blue, grey at zero, yellow; in grey from dark to light.
        return Scale(look.label, -half, half, "cividis")
    return Scale(look.label, low, max(high, low + _FINEST), "viridis")


@dataclass(frozen=True)
class PaintedFilm:
    """A film ready to be painted, farthest triangle first.

    Attributes
    ----------
    corners : (3 n_t, 3) float, three in a row per triangle
    rgba : (3 n_t, 4) float, 0 to 1
    """

    corners: FloatArray
    rgba: FloatArray


def coloured_film(
    shape: Shape,
    eye: FloatArray,
    colour: str,
    values: FloatArray | None,
    scale: Scale | None,
) -> PaintedFilm:
    """Return the film as seen, and lit, from the direction `eye` (3,).

    `colour` is SIDES, SOAP or the name of a field with its `values` (n_v,) and `scale`; a
    field that is NaN inside the film (one on the loop) leaves the film grey.
    """
    triangles, order = shape.triangles, _far_to_near(shape, eye)
    normals = _vertex_normals(shape.x, triangles)
    side = np.sign(_triangle_normals(shape.x, triangles) @ eye)
    # A corner beyond the horizon of its triangle's side counts as edge-on.
    facing = np.clip(side[:, None] * (normals @ eye)[triangles], 0.0, 1.0)
    base = _base(shape, colour, values, scale, side > 0)
    ambient = _AMBIENT if scale is None else _AMBIENT_OF_FIELD
    rgb = base * (ambient + (1.0 - ambient) * facing[..., None])
    opacity = np.ones_like(facing)
    if colour == SOAP:
        shine = facing**_SHINE * 0.25
        opacity = 1.0 - (1.0 - _THIN) ** (1.0 / np.maximum(facing, 0.2))
        rgb += (1.0 - rgb) * shine[..., None]
    rgba = np.concatenate([rgb, opacity[..., None]], axis=2)[order]
    return PaintedFilm(shape.x[triangles[order]].reshape(-1, 3), rgba.reshape(-1, 4))


def loop_colours(
    shape: Shape, values: FloatArray | None, scale: Scale | None
) -> FloatArray:
    """Return the loop's colours (n_b, 3): those of a field that lives there, or dark."""
    if values is None or scale is None or not _on_loop_only(shape, values):
        return np.tile(LOOP, (len(shape.loop), 1))
    return scale.rgb(values[shape.loop])


def _base(
    shape: Shape,
    colour: str,
    values: FloatArray | None,
    scale: Scale | None,
    front: np.ndarray[tuple[int], np.dtype[np.bool_]],
) -> FloatArray:
    """Return the colours (n_t, 3, 3) of the triangles' corners before they are lit."""
    pair: Mapping[bool, FloatArray] = {True: np.array(FRONT), False: np.array(BACK)}
    if values is not None and scale is not None:
        if not _on_loop_only(shape, values):
            rgb = scale.rgb(_continued(shape, values))[shape.triangles]
            return np.where(front[:, None, None], rgb, _DARKER * rgb)
        pair = {True: _GREY_FRONT, False: _GREY_BACK}
    plain = np.where(front[:, None], pair[True], pair[False])
    return np.repeat(plain[:, None, :], 3, axis=1)


def _on_loop_only(shape: Shape, values: FloatArray) -> bool:
    inside = np.ones(len(values), dtype=bool)
    inside[shape.loop] = False
    return not bool(np.isfinite(values[inside]).any())


def _continued(shape: Shape, values: FloatArray) -> FloatArray:
    """Return `values` (n_v,), the missing ones replaced by the mean of their neighbours.

    So a field that exists inside only fills the triangles at the loop too. Two rounds: a
    loop vertex at the end of a single triangle has no neighbour inside.
    """
    filled = values.astype(float)
    ends = shape.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    start, end = np.concatenate([ends, ends[:, ::-1]]).T
    for _ in range(2):
        known = np.isfinite(filled)
        use = known[end]
        count = np.bincount(start[use], minlength=len(filled))
        total = np.bincount(start[use], filled[end[use]], minlength=len(filled))
        new = ~known & (count > 0)
        filled[new] = total[new] / count[new]
    return np.where(np.isfinite(filled), filled, 0.0)


def _far_to_near(shape: Shape, eye: FloatArray) -> IntArray:
    depth = shape.x[shape.triangles].mean(axis=1) @ eye
    order: IntArray = np.argsort(depth, kind="stable")
    return order


def _triangle_normals(x: FloatArray, triangles: IntArray) -> FloatArray:
    """Return normals (n_t, 3) as long as twice the area."""
    a, b, c = x[triangles].transpose(1, 0, 2)
    normals: FloatArray = np.cross(b - a, c - a)
    return normals


def _vertex_normals(x: FloatArray, triangles: IntArray) -> FloatArray:
    """Return unit normals (n_v, 3), those of the triangles weighted by their areas."""
    normals = np.zeros_like(x)
    np.add.at(normals, triangles.ravel(), np.repeat(_triangle_normals(x, triangles), 3, 0))
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    unit: FloatArray = normals / np.maximum(length, np.finfo(float).tiny)
    return unit
