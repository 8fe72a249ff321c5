"""What runs without a mesh: harmonics in place of meshes.

In space that is `conformal`, in the plane `tangent angle`. Both keep the symmetry of start
and film, n half-turns, and make use of it; the other solvers do not know of it. Their start
is the others': the vertices of the rest polygon.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.conformal import ConformalFilm, relax
from eulerplateau.exact.conformal.sector import make_sector
from eulerplateau.exact.tangent_angle.relaxation import PlaneLoop, relax_in_plane
from eulerplateau.solvers import Status
from scripts.studies.error_vs_time.measure import distance, timed
from scripts.studies.error_vs_time.scenes import SADDLE, Scene, chain, gyration

CONFORMAL, TANGENT_ANGLE = "conformal", "tangent angle"
# Harmonics of the whole loop; in the plane those of a lobe.
_LADDER = (4, 6, 8, 12, 16, 24, 32, 48, 64)
_LADDER_IN_PLANE = (2, 3, 4, 6, 8, 12, 16, 24, 32)
# Vertices of the start for each harmonic, divisible by the lobes.
_VERTICES = 6
# Edges of the loop that the shape is measured on; points per edge to find them.
_EDGES, _FINER = 288, 16


def mesh_free(scene: Scene) -> str:
    """Return the solver's name."""
    return TANGENT_ANGLE if scene.in_plane else CONFORMAL


def ladder(scene: Scene) -> tuple[int, ...]:
    """Return the harmonics to compute a scene with."""
    return _LADDER_IN_PLANE if scene.in_plane else _LADDER


def mesh_free_repeats(scene: Scene, harmonics: int) -> Iterator[dict[str, Any]]:
    """Yield what each repeat of a point cost and came to; tables are made anew in each."""
    assert scene.lobes is not None
    vertices = _VERTICES * harmonics * (scene.lobes if scene.in_plane else 1)
    start = polygon(scene, vertices)
    # Loads the compiled kernels.
    relaxed(scene, start, 1.0, harmonics)

    def run() -> tuple[ConformalFilm | PlaneLoop | None, float, float]:
        wall = time.perf_counter()
        film = relaxed(scene, start, scene.load, harmonics)
        return film, 0.0, time.perf_counter() - wall

    return timed(run, partial(what, scene))


def relaxed(
    scene: Scene, start: FloatArray, load: float, harmonics: int
) -> ConformalFilm | PlaneLoop | None:
    """Return the film that a start (vertices, 3) relaxes to, None if it does not."""
    assert scene.lobes is not None
    if scene.in_plane:
        return relax_in_plane(start, load, harmonics, scene.lobes)
    return relax(start, load, harmonics, scene.lobes)


def unknowns(scene: Scene, harmonics: int) -> int:
    """Return how many numbers a film is."""
    assert scene.lobes is not None
    return harmonics if scene.in_plane else make_sector(harmonics, scene.lobes).size


def polygon(scene: Scene, vertices: int) -> FloatArray:
    """Return the start (vertices, 3), of length 1: Scene.start of a mesh, its loop only."""
    corners = chain(dict(scene.polygon), vertices)
    length = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1).sum()
    x = np.pad(corners / length, ((0, 0), (0, 1)))
    if not scene.in_plane:
        x[:, 2] = SADDLE * x[:, 0] * x[:, 1]
    return x


def what(scene: Scene, film: ConformalFilm | PlaneLoop | None) -> dict[str, Any]:
    """Return the part of a record that says what was found."""
    if film is None:
        numbers = dict.fromkeys(("value", "gyration", "shape_error"), math.nan)
        return {**numbers, "iterations": 0, "status": Status.STALLED.value}
    loop, lengths = equal_edges(film)
    return {
        "value": film.energy,
        "iterations": film.steps if isinstance(film, PlaneLoop) else film.corrections,
        "gyration": gyration(lengths, loop),
        "shape_error": distance(scene, lengths, loop),
        "status": Status.CONVERGED.value,
        **scene.parts(film.area, film.energy - scene.load * film.area),
    }


def equal_edges(film: ConformalFilm | PlaneLoop) -> tuple[FloatArray, FloatArray]:
    """Return points (n, 3), equidistant along the loop, and their spacing (n,)."""
    if isinstance(film, PlaneLoop):
        flat = film.positions(np.arange(_EDGES) / _EDGES)
        return np.pad(flat, ((0, 0), (0, 1))), np.full(_EDGES, 1 / _EDGES)
    phi = 2 * np.pi * np.arange(_EDGES * _FINER + 1) / (_EDGES * _FINER)
    speed = np.linalg.norm(film.basis.at(film.coefficients, phi).x1, axis=1)
    length = CubicSpline(phi, speed, bc_type="periodic").antiderivative()(phi)
    places = length[-1] * np.arange(_EDGES) / _EDGES
    at = CubicSpline(length, phi)(places)
    loop = film.basis.at(film.coefficients, at).x
    return loop, np.full(_EDGES, length[-1] / _EDGES)
