"""Discrete minimal surfaces: films whose area no displacement of a vertex inside changes.

Along its normals a film comes to rest in a chart (chart.py). What then remains of the
area's gradient lies in the film: the area of triangles depends, weakly, on where their
vertices lie. On a curved film it is least for certain places, denser where it is more
curved, and certain triangles. They are found here: by Newton's method on all coordinates
inside, the Hessian shifted until it is positive definite, and by flips to Delaunay's
triangles, without which some collapse.
"""

from __future__ import annotations

import numpy as np

from eulerplateau.area_film import AreaFilm, Sides
from eulerplateau.chart import ROUNDING
from eulerplateau.mesh import FloatArray
from eulerplateau.repair import flipped
from eulerplateau.variations import LEAST, STIFFER, STILL, Free

_STEPS, _HALVINGS = 300, 6
# The first stiffness against sliding; it grows where steps are short and shrinks where they
# are long.
_FIRST, _SOFTER, _SHORT, _LONG = 1e-5, 0.25, 0.1, 0.5
# A vertex moves at most this part of the shortest side at it, and no triangle turns farther
# than this cosine.
_FARTHEST, _TURNED = 0.3, 0.5
# Sine of the tilt up to which triangles count as flat: sliding then costs nothing.
_FLAT = 1e-6
# Degrees: thinner triangles are on their way to vanish.
_VANISHING = 5.0


def is_flat(film: AreaFilm, x: FloatArray) -> bool:
    """Return whether a film (n_v, 3) lies in a plane."""
    normals = film.sides(x).normals
    tilted = np.cross(normals, normals.mean(axis=0))
    return float(np.abs(tilted).max(initial=0.0)) < _FLAT


def minimal(film: AreaFilm, x: FloatArray) -> tuple[AreaFilm, FloatArray] | None:
    """Return the discrete minimal surface near a film (n_v, 3) on the same loop.

    With Delaunay's triangles; None where there is none but with vanishing triangles.
    """
    film = flipped(film, x)
    free, shift = Free(film), _FIRST
    for _ in range(_STEPS):
        sides = film.sides(x)
        force = free.work(film.gradient(sides))
        error = float(np.abs(force).max(initial=0.0))
        if error <= ROUNDING * float(np.abs(sides.edges).max()):
            return film, x
        if sides.smallest_angle < _VANISHING:
            return None
        inverse, shift = free.stiffened(sides, shift)
        step = -inverse.solve(force)
        x, part = _moved(film, x, sides, free.displaced(step), float(force @ step))
        if part < _SHORT:
            shift = max(STIFFER * shift, LEAST)
        elif part > _LONG:
            shift = max(_SOFTER * shift, STILL)
        better = flipped(film, x)
        if better is not film:
            film, free = better, Free(better)
    return None


def _moved(
    film: AreaFilm, x: FloatArray, sides: Sides, step: FloatArray, slope: float
) -> tuple[FloatArray, float]:
    """Return the film after the longest part of a step (n_i, 3) that makes it smaller.

    And that part, 0 if there is none.
    """
    room = _shortest_sides(film, sides)[film.interior]
    farthest = float((np.linalg.norm(step, axis=1) / room).max())
    part = min(1.0, _FARTHEST / farthest)
    negligible = 1e-15 * float(sides.areas.sum())
    for _ in range(_HALVINGS):
        after = x.copy()
        after[film.interior] += part * step
        moved = film.sides(after)
        turned = (moved.normals * sides.normals).sum(axis=1)
        if (moved.areas > 0).all() and (turned > _TURNED).all():
            gained = film.change(x, after)
            if gained <= 0.1 * part * slope or abs(part * slope) < negligible:
                return after, part
        part *= 0.5
    return x, 0.0


def _shortest_sides(film: AreaFilm, sides: Sides) -> FloatArray:
    """Return the length (n_v,) of the shortest side at each vertex."""
    lengths = np.linalg.norm(sides.edges, axis=2)
    room = np.full(film.n_v, np.inf)
    for corner in range(3):
        # Side j lies opposite corner j.
        at_corner = np.minimum(lengths[:, corner - 1], lengths[:, corner - 2])
        np.minimum.at(room, film.triangles[:, corner], at_corner)
    return room
