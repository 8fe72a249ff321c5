"""Where films are seen from: one view and one scale for all pictures of a run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh.shape import Shape

UP = np.array([0.0, 0.0, 1.0])
# Height over width of every picture.
ASPECT = 0.75
LOOP_RADIUS = 0.0035
# Where the eye is if nothing is edge-on to it: slanted, from the front.
_EYE = np.array([0.2, -0.75, 0.65])
_SLANTED = 0.4
# Eyes that see this part of what the best one sees, or more, count as equally good.
_ALMOST = 0.85
_MARGIN = 1.28
# The film is shown above the middle by this part of the half height: the caption is below.
_RAISED = 0.1
# A film that turns is seen from this height above its equator, in degrees.
_TURN_HEIGHT = 35.0


@dataclass(frozen=True)
class View:
    """A camera without perspective, so that sizes compare.

    Attributes
    ----------
    eye : (3,) float, unit vector from the film towards the camera
    focus : (3,) float, the middle of the picture, in units of L
    half_height : float, of the picture, in units of L
    """

    eye: FloatArray
    focus: FloatArray
    half_height: float


def common_view(shapes: Sequence[Shape], raised: float = _RAISED) -> View:
    """Return a view that holds all shapes and sees about the most of the worst seen.

    Of films that turn over little by little, in an animation, no view sees all: each eye
    has a lobe of one of them edge-on. The shapes are `raised` by this part of half the
    height, above what is written below.
    """
    eyes = _candidate_eyes()
    seen = np.array([_visible_part(shape, eyes) for shape in shapes])
    # Against the best there is for each shape: a closed one is seen in part from anywhere.
    worst = (seen / seen.max(axis=1, keepdims=True)).min(axis=0)
    good = eyes[worst >= _ALMOST * worst.max()]
    return _raised(_holding(shapes, good[np.argmax(good @ _EYE)]), raised)


def view_from(shapes: Sequence[Shape], eye: FloatArray, raised: float = _RAISED) -> View:
    """Return a view from the unit vector `eye` (3,) that holds all shapes, `raised`."""
    return _raised(_holding(shapes, eye), raised)


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
    half = max(
        view.half_height + _MARGIN * float(np.linalg.norm(view.focus - focus))
        for view in views
    )
    return [_raised(replace(view, focus=focus, half_height=half)) for view in views]


def _holding(shapes: Sequence[Shape], eye: FloatArray) -> View:
    axes = _screen(eye)
    flat = np.concatenate([shape.x for shape in shapes]) @ axes
    low, high = flat.min(axis=0), flat.max(axis=0)
    half_width, half_height = 0.5 * (high - low) + LOOP_RADIUS
    half = float(max(half_height, half_width * ASPECT))
    return View(eye, axes @ (0.5 * (low + high)), _MARGIN * half)


def _raised(view: View, part: float = _RAISED) -> View:
    down = -part * view.half_height * _screen(view.eye)[:, 1]
    return replace(view, focus=view.focus + down)


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
