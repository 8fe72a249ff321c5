"""The contractile cell: a film's tension against its edge's bending, held by adhesions."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.cells.adhesion_sites import Sites
from eulerplateau.errors import SpecError
from eulerplateau.film import PolygonArea
from eulerplateau.loop import (
    Adhesions,
    EqualEdges,
    FreeBending,
    LineTension,
    LoopEnergy,
    Term,
    differences,
    edges_of,
)


@dataclass(frozen=True, repr=False)
class Cell:
    """A cell whose edge is a polygon, `edges_per_side` equal edges between adhesions.

    E = sum_v phi_v^2 / s_v + sigma_hat A + beta_hat P + ks_hat sum_i w_i |r_i - p_i|^2,

    with exterior angles phi, area A and perimeter P (eq. cfm, made discrete). Edges of one
    side are equal: longer ones would bend more cheaply, and gain energy by sliding past
    the adhesions. The length of each side is free, so that an adhesion slides
    along the edge. What resists is its spring; one much softer than the error of the
    discretisation, about the bending energy times the square of an edge in units of the
    radius of curvature, lets sides grow at their neighbours' expense.

    Attributes
    ----------
    edges_per_side : int, even, 4 or more
    beta_hat : float, not negative
    """

    sites: Sites
    edges_per_side: int = 32
    beta_hat: float = 0.0

    def __post_init__(self) -> None:
        """Refuse a cell that no edge or no energy belongs to."""
        m = self.edges_per_side
        if m < 4 or m % 2:
            raise SpecError("edges_per_side", f"found {m}; should be even, 4 or more")
        if not (np.isfinite(self.beta_hat) and self.beta_hat >= 0):
            raise SpecError("beta_hat", f"found {self.beta_hat:g}; should be 0 or more")

    def __repr__(self) -> str:
        """Return one line: sites, edges, line tension."""
        n, m = len(self.sites.points), self.edges_per_side
        return f"<Cell: {n} sites, {m} edges a side, beta_hat {self.beta_hat:g}>"

    @property
    def size(self) -> int:
        """How many vertices n its edge has."""
        return len(self.sites.points) * self.edges_per_side

    @cached_property
    def vertices(self) -> IntArray:
        """The vertices (N,) that adhere."""
        return self.edges_per_side * np.arange(len(self.sites.points))

    @cached_property
    def edge(self) -> float:
        """The perimeter of the sites' polygon over the number of edges."""
        gaps = differences(self.sites.points)
        return float(np.hypot(gaps[:, 0], gaps[:, 1]).sum()) / self.size

    @cached_property
    def shares(self) -> FloatArray:
        """The part (N,) of the sites' polygon that each of its sides is."""
        gaps = differences(self.sites.points)
        lengths = np.hypot(gaps[:, 0], gaps[:, 1])
        shares: FloatArray = lengths / lengths.sum()
        return shares

    def energy(
        self, sigma_hat: float, ks_hat: float, edge: float | None = None
    ) -> LoopEnergy:
        """Return the energy at a contractility and a stiffness of the adhesions.

        It is good near loops whose shortest edge is about `edge` long, by default that of
        the sites' polygon.
        """
        short = self.edge if edge is None else edge
        terms: dict[str, Term] = {
            "bending": FreeBending(short),
            "film": PolygonArea(sigma_hat),
        }
        if self.beta_hat:
            terms["line_tension"] = LineTension(self.beta_hat, short)
        terms["adhesions"] = self.adhesions(ks_hat)
        weights = np.full(self.size, self.edge)
        return LoopEnergy(terms, EqualEdges(self.edges_per_side), weights, _no_free_motions)

    def adhesions(self, ks_hat: float) -> Adhesions:
        """Return the springs."""
        return Adhesions(self.vertices, self.sites.points, self.sites.weights, ks_hat)

    def straight_start(self) -> FloatArray:
        """Return the polygon of the sites (n, 2); between two sites alone, a lens."""
        return self._arcs(0.0 if len(self.sites.points) > 2 else 0.25 * np.pi)

    def round_start(self) -> FloatArray:
        """Return arcs (n, 2) outwards from site to site, a circle round a regular polygon.

        It may cross itself where the polygon is far from convex.
        """
        return self._arcs(np.pi / len(self.sites.points))

    def _arcs(self, half_angle: float) -> FloatArray:
        """Return the loop (n, 2) of arcs that leave their chords at `half_angle` (rad)."""
        part = np.arange(self.edges_per_side) / self.edges_per_side
        along, out = part, np.zeros_like(part)
        if half_angle:
            turned = half_angle * (2 * part - 1)
            along = 0.5 * (1 + np.sin(turned) / np.sin(half_angle))
            out = 0.5 * (np.cos(turned) - np.cos(half_angle)) / np.sin(half_angle)
        chords = differences(self.sites.points)
        outwards = np.column_stack([chords[:, 1], -chords[:, 0]])
        bent = along[:, None] * chords[:, None] + out[:, None] * outwards[:, None]
        return (self.sites.points[:, None] + bent).reshape(-1, 2)

    def tangents(self, x: FloatArray) -> FloatArray:
        """Return the unit tangents (N, 2) of the edge at the adhesions.

        Edges have the direction of the curve at their middles, and sides have edges of
        different lengths: of the turning at a vertex the part l_{v-1} / (l_{v-1} + l_v)
        is behind it.
        """
        edges = edges_of(x)
        here, before = self.vertices, self.vertices - 1
        behind = edges.lengths[before] / (edges.lengths[before] + edges.lengths[here])
        angle = edges.turning[here] * behind
        along, across = edges.tangents[before], edges.normals[before]
        return np.cos(angle)[:, None] * along + np.sin(angle)[:, None] * across


def _no_free_motions(x: FloatArray) -> FloatArray:
    """Return no motions (2 n, 0): adhesions hold the cell."""
    return np.zeros((x.size, 0))


def shortest_edge(x: FloatArray) -> float:
    """Return the length of the shortest edge of a loop (n, 2)."""
    return float(edges_of(x).lengths.min())
