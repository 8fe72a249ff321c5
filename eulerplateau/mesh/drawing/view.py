"""Where films are seen from: one view and one scale for all pictures of a run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh.shape import Shape

UP = np.array([0.0, 0.0, 1.0])
# From above, the y axis up in the picture; by so little aslant that nobody sees it.
ABOVE: FloatArray = np.array([0.0, -1e-3, 1.0]) / np.hypot(1.0, 1e-3)
LOOP_RADIUS = 0.0035
# Height over width of a picture lies between these.
_LOWEST, _HIGHEST = 0.35, 0.75
# A film is flat if in a picture as wide as it is no pixel of a thousand shows its depth.
_FLAT = 1e-3
# Where the eye is if nothing is edge-on to it: slanted, from the front.
_EYE = np.array([0.2, -0.75, 0.65])
_SLANTED = 0.4
# Eyes that see this part of what the best one sees, or more, count as equally good.
_ALMOST = 0.85
# Part of half its larger extent that is left free on every side of a shape.
_MARGIN = 0.16
# A film that turns is seen from this height above its equator, in degrees.
_TURN_HEIGHT = 35.0


@dataclass(frozen=True)
class View:
    """A camera without perspective, so that sizes compare.

    Attributes
    ----------
    eye : (3,) float, unit vector from the film towards the camera
    focus : (3,) float, the middle of the picture, in units of L
    half : half the width and height of the picture, in units of L
    """

    eye: FloatArray
    focus: FloatArray
    half: tuple[float, float]

    def height(self, shape: Shape) -> int:
        """Return how high above the mean plane of a shape's loop the eye is, in degrees."""
        sine = min(1.0, abs(float(self.eye @ mean_normal(shape.x_loop))))
        return round(float(np.degrees(np.arcsin(sine))))

    def words(self, shape: Shape) -> str:
        """Say from where a shape is seen."""
        height = self.height(shape)
        return "seen from above" if height == 90 else f"{height}° above its plane"

    def size(self, width: int) -> tuple[int, int]:
        """Return width and height of its picture in pixels; both are even, for films."""
        across, up = self.half
        return width, 2 * round(0.5 * width * up / across)


def mean_normal(x_loop: FloatArray) -> FloatArray:
    """Return the unit normal (3,) of the plane nearest to a loop (n_b, 3), either one."""
    x = x_loop - x_loop.mean(axis=0)
    normal: FloatArray = np.linalg.svd(x, full_matrices=False)[2][2]
    return normal


def is_flat(shape: Shape) -> bool:
    """Whether a shape lies in a plane z = const, as far as a picture can show it."""
    across, _, depth = np.ptp(shape.x, axis=0)
    return bool(depth < _FLAT * across)


def common_view(shapes: Sequence[Shape]) -> View:
    """Return a view that holds all shapes and sees about the most of the worst seen.

    If all are flat it is from above. Of films that turn over little by little, in an
    animation, no view sees all: each eye has a lobe of one of them edge-on.
    """
    return _holding(shapes, _common_eye(shapes))


def own_views(shapes: Sequence[Shape]) -> list[View]:
    """Return a view for each shape, at one scale: a flat film is seen from above.

    So it has its true outline. All others have the eye of their common view.
    """
    eye = _common_eye([shape for shape in shapes if not is_flat(shape)])
    views = [_holding([shape], ABOVE if is_flat(shape) else eye) for shape in shapes]
    half = _proportioned(*np.max([view.half for view in views], axis=0))
    return [replace(view, half=half) for view in views]


def view_from(shapes: Sequence[Shape], eye: FloatArray) -> View:
    """Return a view from the unit vector `eye` (3,) that holds all shapes."""
    return _holding(shapes, eye)


def turning_views(shapes: Sequence[Shape], count: int) -> list[View]:
    """Return `count` views once around the vertical axis; each could hold all shapes."""
    height = np.radians(_TURN_HEIGHT)
    turns = 2 * np.pi * np.arange(count) / count - np.pi / 2
    eyes = np.stack(
        [
            np.cos(height) * np.cos(turns),
            np.cos(height) * np.sin(turns),
            np.full(count, np.sin(height)),
        ],
        axis=1,
    )
    views = [_holding(shapes, eye) for eye in eyes]
    # One focus, or the film would sway as it turns, and room for it on every side.
    focus = np.mean([view.focus for view in views], axis=0)
    swayed = [float(np.linalg.norm(view.focus - focus)) for view in views]
    halves = np.array([view.half for view in views]) + np.array(swayed)[:, None]
    half = _proportioned(*halves.max(axis=0))
    return [replace(view, focus=focus, half=half) for view in views]


def _common_eye(shapes: Sequence[Shape]) -> FloatArray:
    if all(is_flat(shape) for shape in shapes):
        return ABOVE
    eyes = _candidate_eyes()
    seen = np.array([_visible_part(shape, eyes) for shape in shapes])
    # Against the best there is for each shape: a closed one is seen in part from anywhere.
    worst = (seen / seen.max(axis=1, keepdims=True)).min(axis=0)
    good = eyes[worst >= _ALMOST * worst.max()]
    eye: FloatArray = good[np.argmax(good @ _EYE)]
    return eye


def _holding(shapes: Sequence[Shape], eye: FloatArray) -> View:
    axes = _screen(eye)
    flat = np.concatenate([shape.x for shape in shapes]) @ axes
    low, high = flat.min(axis=0), flat.max(axis=0)
    across, up = 0.5 * (high - low) + LOOP_RADIUS
    margin = _MARGIN * max(across, up)
    return View(
        eye, axes @ (0.5 * (low + high)), _proportioned(across + margin, up + margin)
    )


def _proportioned(across: float, up: float) -> tuple[float, float]:
    """Return half a width and height that hold both and suit a picture."""
    across = max(float(across), float(up) / _HIGHEST)
    return across, max(float(up), _LOWEST * across)


def _screen(eye: FloatArray) -> FloatArray:
    """Return the directions (3, 2) of a picture's width and height, as columns."""
    right = np.cross(UP, eye)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(eye, right)], axis=1)


def _candidate_eyes() -> FloatArray:
    """Return directions (n, 3) around the front (-y), 25 to 75 degrees above z = 0."""
    turn, height = np.radians(
        np.meshgrid(np.arange(-30, 31, 10), np.arange(25, 76, 10))
    ).reshape(2, -1)
    across = np.cos(height)
    return np.stack([across * np.sin(turn), -across * np.cos(turn), np.sin(height)], axis=1)


def _visible_part(shape: Shape, eyes: FloatArray) -> FloatArray:
    """Return how much of a film's worse half (0 to _SLANTED) each eye (n, 3) sees.

    The halves are left and right, like the lobes of an eight, of which an eye may face one
    and miss the other. A part seen slanted reads better than one faced: beyond _SLANTED it
    counts no more.
    """
    a, b, c = shape.x[shape.triangles].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    areas = np.linalg.norm(normals, axis=1)
    seen = np.minimum(np.abs(normals @ eyes.T), _SLANTED * areas[:, None])
    left = (a + b + c)[:, 0] < 0.0
    halves = [seen[half].sum(axis=0) / areas[half].sum() for half in (left, ~left)]
    worse: FloatArray = np.minimum(*halves)
    return worse
