"""Planar films by plain minimisation: polygons with n lobes alike, strands kept d apart.

What a film in contact looks like is not put in, nor that there is contact: the energy of a
polygon of equal edges is minimised over its angles, half a lobe of it by symmetry, under
inequalities. Its errors are of second order in the edge.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import pi

import numpy as np
from scipy.optimize import minimize

from eulerplateau.arrays import FloatArray


@dataclass(frozen=True)
class HalfLobe:
    """Half a lobe of n, of `edges` equal edges, from its tip on the axis of x.

    Unknown are the edges' angles with that axis and the tip's position x on it; energies
    are those of the whole loop, of length 1, and its film: lengths L, energies alpha/L.
    """

    lobes: int
    tension: float
    diameter: float
    edges: int

    @cached_property
    def edge(self) -> float:
        """The length of an edge."""
        return 1 / (2 * self.lobes * self.edges)

    @cached_property
    def start(self) -> FloatArray:
        """A lobe of a buckled loop, (edges + 1,)."""
        turn = 2 * pi * (np.arange(self.edges) + 0.5) * self.edge
        return np.append(pi / 2 + turn + 0.3 * np.sin(self.lobes * turn), 1 / (2 * pi))

    @cached_property
    def _far(self) -> FloatArray:
        """Vertices farther than pi d / 2, along the loop, from their mirror images."""
        return np.flatnonzero(
            np.arange(self.edges + 1) * self.edge > pi * self.diameter / 4
        )

    def _positions(self, unknown: FloatArray) -> tuple[FloatArray, FloatArray]:
        steps = self.edge * np.stack([np.cos(unknown[:-1]), np.sin(unknown[:-1])])
        x, y = np.cumsum(np.insert(steps, 0, [unknown[-1], 0.0], axis=1), axis=1)
        return x, y

    def energy(self, unknown: FloatArray) -> tuple[float, FloatArray]:
        """Return the energy, with its gradient (edges + 1,)."""
        angle, middle = unknown[:-1], pi / 2 + pi / self.lobes
        turn = np.diff(angle, prepend=pi - angle[0], append=2 * middle - angle[-1])
        # A vertex on an axis belongs to two halves; its turn counts its edge twice.
        weight = np.ones(len(turn))
        weight[[0, -1]] = 0.5
        bending = (weight * turn**2).sum() / self.edge
        moment = 2 * turn / self.edge
        gradient = np.append(moment[:-1] - moment[1:], 0.0)
        x, y = self._positions(unknown)
        area = (x[:-1] * y[1:] - x[1:] * y[:-1]).sum() / 2
        pull_x = np.append(y[1:], 0.0) - np.insert(y[:-1], 0, 0.0)
        pull_y = np.insert(x[:-1], 0, 0.0) - np.append(x[1:], 0.0)
        beyond_x, beyond_y = (np.cumsum(p[::-1])[::-1] / 2 for p in (pull_x, pull_y))
        turned = np.cos(angle) * beyond_y[1:] - np.sin(angle) * beyond_x[1:]
        gradient += self.tension * np.append(self.edge * turned, beyond_x[0])
        both = 2 * self.lobes
        return both * (bending + self.tension * area), both * gradient

    def gaps(self, unknown: FloatArray) -> FloatArray:
        """Return half the distances between the strands, less half a diameter."""
        return self._positions(unknown)[1][self._far] - self.diameter / 2

    def gap_gradient(self, unknown: FloatArray) -> FloatArray:
        """Return the gradient (gaps, edges + 1)."""
        steps = np.tri(self.edges + 1, self.edges, -1) * self.edge * np.cos(unknown[:-1])
        return np.pad(steps, ((0, 0), (0, 1)))[self._far]

    def off_axis(self, unknown: FloatArray) -> float:
        """Return the distance of the end from the ray between two lobes."""
        x, y = self._positions(unknown)
        return float(x[-1] * np.sin(pi / self.lobes) - y[-1] * np.cos(pi / self.lobes))

    def off_axis_gradient(self, unknown: FloatArray) -> FloatArray:
        """Return the gradient (edges + 1,)."""
        ray = pi / self.lobes
        return np.append(-self.edge * np.cos(unknown[:-1] - ray), np.sin(ray))


@dataclass(frozen=True)
class PolygonFilm:
    """The polygon of least energy.

    `forces` (contacts,) are those on the vertices in contact, over the loop;
    `misfit` is the largest component of the forces that is not balanced.
    """

    energy: float
    forces: FloatArray
    misfit: float


def relax_polygon(half: HalfLobe) -> PolygonFilm:
    """Return the polygon of least energy downhill from a buckled loop."""
    axis = {"type": "eq", "fun": half.off_axis, "jac": half.off_axis_gradient}
    apart = {"type": "ineq", "fun": half.gaps, "jac": half.gap_gradient}
    found = minimize(
        half.energy,
        half.start,
        jac=True,
        method="SLSQP",
        constraints=[axis, apart],
        options={"maxiter": 500, "ftol": 1e-13},
    ).x
    energy, gradient = half.energy(found)
    touching = half.gap_gradient(found)[half.gaps(found) < 1e-9]
    normals = np.vstack([half.off_axis_gradient(found), touching]).T
    multipliers = np.linalg.lstsq(normals, gradient)[0]
    misfit = float(np.abs(normals @ multipliers - gradient).max())
    # A gap is half a distance less d/2.
    return PolygonFilm(energy, multipliers[1:] / 2, misfit)
