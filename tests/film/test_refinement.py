"""Finer triangles where strands cross: against a helicoid, whose area is exact."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.film import AreaFilm
from eulerplateau.film.area import AreaFilm
from eulerplateau.film.refinement import EdgeSizes, refined
from eulerplateau.film.tiling import Tiling
from eulerplateau.mesh import Disk, Shape
from eulerplateau.solvers import Problem
from tests.helpers import shapes

# The strands are the helicoid's rulings at both ends of its turn, so far apart on its axis;
# both are so long, and the turn between them is so large.
APART, LONG, TURN = 0.004, 0.3, 1.2
AXIS = np.zeros((1, 3))


def helicoid(mesh: Disk, apart: float) -> FloatArray:
    """The loop (n_b, 3) of a helicoid: two rulings, two arcs of a helix, by arclength."""
    along = np.linspace(0.0, 1.0, 400)
    r = 0.5 * LONG * np.concatenate([0 * along + 1, 1 - 2 * along, 0 * along - 1, 2 * along - 1])
    turn = TURN * np.concatenate([along - 0.5, 0 * along + 0.5, 0.5 - along, 0 * along - 0.5])
    curve = np.column_stack([r * np.cos(turn), r * np.sin(turn), apart / TURN * turn])
    steps = np.linalg.norm(np.diff(curve, axis=0, append=curve[:1]), axis=1)
    s = np.concatenate([[0.0], np.cumsum(steps)[:-1]])
    t = np.cumsum(mesh.rest_lengths) * steps.sum()
    return np.column_stack([np.interp(t, s, x, period=steps.sum()) for x in curve.T])


def pull(apart: float) -> float:
    """The derivative of the helicoid's area by the distance of its rulings."""
    pitch, half = apart / TURN, 0.5 * LONG
    return 2 * pitch * np.arcsinh(half / pitch)
