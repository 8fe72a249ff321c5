"""A smooth loop through the vertices of one: the periodic quintic spline.

Its parameter s is the arc length at rest, s_v from vertex v to v + 1. On each edge it is a
polynomial of degree five, given by the curve, its first and its second derivative at both
ends (Hermite); these derivatives are such that the third and the fourth are continuous as
well. Interpolating a smooth curve, its second derivative errs by O(h^4), where a polygon's
and a cubic spline's err by O(h^2) (Ahlberg, Nilson and Walsh, The Theory of Splines, 1967).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import Polynomial
from scipy.linalg import LinAlgError
from scipy.linalg.lapack import dgbtrf, dgbtrs

from eulerplateau.arrays import FloatArray, IntArray

# What multiplies x, h x', h^2 x'' at the end of an edge of length h, by t = 0 ... 1.
_END = (
    Polynomial((0.0, 0.0, 0.0, 10.0, -15.0, 6.0)),
    Polynomial((0.0, 0.0, 0.0, -4.0, 7.0, -3.0)),
    Polynomial((0.0, 0.0, 0.0, 0.5, -1.0, 0.5)),
)
# At its beginning: t -> 1 - t, where odd derivatives change their sign.
_BEGINNING = tuple((-1) ** k * p(Polynomial((1.0, -1.0))) for k, p in enumerate(_END))
# Gauss points of an edge: exact for the squared second derivative, of degree 6.
_POINTS = 4
# Entries of a row beside the diagonal, on either side: two unknowns a vertex, two vertices.
_BAND = 5


def _hermite(t: FloatArray, order: int) -> FloatArray:
    """Return the derivatives (len(t), 6) of all that multiplies, at places t (n,)."""
    found = [p.deriv(order)(t) if order else p(t) for p in (*_BEGINNING, *_END)]
    return np.stack(found, axis=-1)


_T, _WEIGHTS = np.polynomial.legendre.leggauss(_POINTS)
_T, _WEIGHTS = 0.5 * (_T + 1), 0.5 * _WEIGHTS
_VALUE, _FIRST, _SECOND = (_hermite(_T, order) for order in range(3))
# By this (6, 6) data make up the gradient of the integral of |r''|^2 ds on a unit edge.
_BENDING = 2 * (_SECOND.T @ (_WEIGHTS[:, None] * _SECOND))
# By this, C (6, 6), data d make up the integral of r x r' ds: it is the sum of d x C d.
_AHEAD = 0.5 * (_VALUE.T @ (_WEIGHTS[:, None] * _FIRST))
_AHEAD -= _AHEAD.T.copy()
_MIDDLE = _hermite(np.array([0.5]), 0)
# Jumps of the third and the fourth derivative (2, 2, 2, 3): by order, the edge before a
# vertex and, negative, the one after it, its beginning and end, the power of its length.
_ORDERS, _POWERS = np.array([3, 4]), np.arange(3)
_JUMPS = np.stack(
    [[_hermite(np.ones(1), order)[0], -_hermite(np.zeros(1), order)[0]] for order in (3, 4)]
).reshape(2, 2, 2, 3)


@dataclass(frozen=True)
class Splines:
    """The splines through loops whose edges are s (n,) long at rest: a linear map."""

    lengths: FloatArray

    def through(self, x: FloatArray) -> SplineLoop:
        """Return the spline through a loop's vertices (n, 3)."""
        data, (_, order, place) = np.empty((6, *x.shape)), self._equations
        jumps = np.matmul(self._knots, x[self._around[order]])
        data[0] = x
        data[1:3] = self._solved(jumps)[place].swapaxes(0, 1)
        np.multiply(data[:3, self._around[:, 2]], self._powers, out=data[3:])
        data[:3] *= self._powers
        return SplineLoop(self, data)

    def pulled_back(self, by_data: FloatArray) -> FloatArray:
        """Return a gradient by the vertices (n, 3), given by Hermite's data (6, n, 3)."""
        (_, order, place), (before, _, after) = self._equations, self._around.T
        at_vertices = self._powers * by_data[:3]
        at_vertices += (self._powers * by_data[3:])[:, before]
        jumps = self._solved(at_vertices[1:, order].swapaxes(0, 1), adjoint=True)
        by_knots = np.matmul(self._knots.swapaxes(1, 2), jumps)[place]
        found: FloatArray = at_vertices[0]
        found += by_knots[:, 1] + by_knots[after, 0] + by_knots[before, 2]
        return found

    @cached_property
    def _powers(self) -> FloatArray:
        """1, h and h^2 (3, n, 1) of each edge."""
        h: FloatArray = self.lengths ** np.arange(3)[:, None]
        return h[:, :, None]

    @cached_property
    def _around(self) -> IntArray:
        """The vertex (n, 3) before each, itself, and the one after it."""
        n = len(self.lengths)
        around: IntArray = (np.arange(n)[:, None] + np.array([-1, 0, 1])) % n
        return around

    @cached_property
    def _jumps(self) -> FloatArray:
        """Jumps of the third and the fourth derivative at each vertex (n, 2, 3, 3).

        By what x, x' and x'' at the vertex before, there and after contribute to them.
        """
        before, after = self.lengths[self._around[:, 0]], self.lengths
        found = np.zeros((len(after), 2, 3, 3))
        for place, h in enumerate((before, after)):
            # Both in units of the edge after the vertex.
            scale = (after / h)[:, None] ** _ORDERS
            by_ends = scale[:, :, None, None] * _JUMPS[:, place]
            found[:, :, place : place + 2] += (
                by_ends * (h[:, None] ** _POWERS)[:, None, None]
            )
        return found

    @cached_property
    def _knots(self) -> FloatArray:
        """What the positions contribute to the equations (n, 2, 3), in their order."""
        return np.ascontiguousarray(-self._jumps[self._equations[1], ..., 0])

    def _solved(self, rhs: FloatArray, adjoint: bool = False) -> FloatArray:
        """Return the derivatives (n, 2, 3) that solve their equations, or the adjoint.

        Both in the order of the equations.
        """
        (factor, pivots), _, _ = self._equations
        rows = rhs.reshape(2 * len(rhs), -1)
        solved, _ = dgbtrs(factor, _BAND, _BAND, rows, pivots, trans=int(adjoint))
        found: FloatArray = solved.reshape(rhs.shape)
        return found

    @cached_property
    def _equations(self) -> tuple[tuple[FloatArray, IntArray], IntArray, IntArray]:
        """The equations of x' and x'' at the vertices, factorised; their order and places.

        In the order 0, n - 1, 1, n - 2, ... neighbours are two places apart at most, round
        the whole loop: the matrix is banded.
        """
        n = len(self.lengths)
        order = np.empty(n, dtype=np.int64)
        order[::2], order[1::2] = (
            np.arange((n + 1) // 2),
            np.arange(n - 1, n - 1 - n // 2, -1),
        )
        place = np.empty_like(order)
        place[order] = np.arange(n)
        unknown = np.arange(2)
        row = 2 * place[:, None, None, None] + unknown[:, None, None]
        column = 2 * place[self._around][:, None, :, None] + unknown
        matrix = np.zeros((3 * _BAND + 1, 2 * n))
        at = np.broadcast_arrays(2 * _BAND + row - column, column)
        np.add.at(matrix, tuple(at), self._jumps[..., 1:])
        factor, pivots, failed = dgbtrf(matrix, _BAND, _BAND)
        if failed:
            raise LinAlgError("the loop has edges without length")
        return (factor, pivots), order, place


@dataclass(frozen=True)
class SplineLoop:
    """One of them, r(s), by Hermite's data (6, n, 3) on its edges.

    Gradients are by these data; Splines.pulled_back makes them such by the vertices.
    """

    splines: Splines
    data: FloatArray

    @property
    def vertices(self) -> FloatArray:
        """The vertices (n, 3) it passes through."""
        vertices: FloatArray = self.data[0]
        return vertices

    @property
    def bending(self) -> float:
        """The integral of |r''|^2 ds: that of kappa^2 where s is the arc length."""
        return float(0.5 * np.vdot(self.data, self.bending_gradient))

    @cached_property
    def bending_gradient(self) -> FloatArray:
        """Its gradient."""
        return _along(_BENDING, self.data) / self.splines.lengths[:, None] ** 3

    @cached_property
    def speeds(self) -> FloatArray:
        """|r'| at each edge's Gauss points (4, n): 1 where s is the arc length."""
        speeds: FloatArray = np.sqrt(np.vecdot(self._first, self._first))
        return speeds / self.splines.lengths

    @cached_property
    def excess(self) -> FloatArray:
        """By how much each edge's arc (n,) is longer than at rest."""
        excess: FloatArray = self.splines.lengths * (_WEIGHTS @ (self.speeds - 1))
        return excess

    def tension_gradient(self, tensions: FloatArray) -> FloatArray:
        """Return the gradient of sum_v lambda_v excess_v for tensions lambda (n,)."""
        pull = _WEIGHTS[:, None] * (tensions / self.splines.lengths) / self.speeds
        return _along(_FIRST.T, pull[:, :, None] * self._first)

    @cached_property
    def spanned(self) -> FloatArray:
        """Half the integral of r x r' ds (3,): area times normal of a flat loop."""
        products = self.data.reshape(-1, 3).T @ self._ahead.reshape(-1, 3)
        turned: FloatArray = products[[1, 2, 0], [2, 0, 1]] - products[[2, 0, 1], [1, 2, 0]]
        return 0.5 * turned

    def spanned_gradient(self, normal: FloatArray) -> FloatArray:
        """Return the gradient of its part along a normal (3,).

        It is C d x n, d the data: that part is half the sum of d . (C d x n).
        """
        x, y, z = normal.tolist()
        turn = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        gradient: FloatArray = self._ahead.reshape(-1, 3) @ turn
        return gradient.reshape(self.data.shape)

    @cached_property
    def _ahead(self) -> FloatArray:
        """The data times C (6, n, 3)."""
        return _along(_AHEAD, self.data)

    @property
    def middles(self) -> FloatArray:
        """The middles of the edges (n, 3)."""
        middles: FloatArray = _along(_MIDDLE, self.data)[0]
        return middles

    def middles_gradient(self, forces: FloatArray) -> FloatArray:
        """Return the gradient of what forces (n, 3) do on the middles."""
        return _along(_MIDDLE.T, forces[None])

    @cached_property
    def _first(self) -> FloatArray:
        return _along(_FIRST, self.data)


def _along(basis: FloatArray, data: FloatArray) -> FloatArray:
    """Return sums (m, n, 3) of data (6, n, 3) with the rows of a basis (m, 6).

    By the transpose: the gradient by data of what forces (m, n, 3) do on such sums.
    """
    found: FloatArray = basis @ data.reshape(len(data), -1)
    return found.reshape(-1, *data.shape[1:])
