"""The elastic loop: bending stiffness and inextensibility, edge by edge."""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray, cross
from eulerplateau.loop.term import OwnTerm

# Edges in which a resolved loop can turn back on itself.
_TURNING_BACK = 6


@dataclass(frozen=True)
class Loop:
    """A closed chain of edges that keep their rest lengths s_v (n_b,), in units of L.

    Attributes
    ----------
    terms : what its energy has beside its bending, by names: "twist"
    diameter : its thickness, in units of L; None of a line, whose strands only meet
    """

    rest_lengths: FloatArray
    terms: Mapping[str, OwnTerm] = field(default_factory=dict)
    diameter: float | None = None
    # The same loop with edges cut into parts, as it last was.
    _finer: list[Loop] = field(default_factory=list, init=False, repr=False, compare=False)

    @property
    def parameters(self) -> Mapping[str, float]:
        """What can be varied of it: its thickness, and what its terms name; the values."""
        own = (term.parameters.items() for term in self.terms.values())
        found = {name: value for pairs in own for name, value in pairs}
        return found if self.diameter is None else {"diameter": self.diameter, **found}

    def with_value(self, parameter: str, value: float) -> Loop:
        """Return the loop at another value of one of its parameters."""
        # Copied with what is known of its lengths.
        made, terms = copy(self), self.terms.items()
        if parameter == "diameter":
            object.__setattr__(made, "diameter", value)
        own = {name: term.with_value(parameter, value) for name, term in terms}
        object.__setattr__(made, "terms", own)
        finer = [known.with_value(parameter, value) for known in self._finer]
        object.__setattr__(made, "_finer", finer)
        return made

    def on_edges(self, rest_lengths: FloatArray) -> Loop:
        """Return the same loop with other edges, so long (n,)."""
        terms = {name: term.on_edges(rest_lengths) for name, term in self.terms.items()}
        return replace(self, rest_lengths=rest_lengths, terms=terms)

    def cut(self, parts: IntArray) -> Loop:
        """Return the same loop, each of its edges cut into so many equal parts (n_b,)."""
        lengths = np.repeat(self.rest_lengths / parts, parts)
        for known in self._finer:
            if np.array_equal(known.rest_lengths, lengths):
                return known
        self._finer[:] = [self.on_edges(lengths)]
        return self._finer[0]

    def pinched(self, x: FloatArray) -> bool:
        """Return whether a loop (n, d) meets itself where that ends what a term says."""
        return any(term.pinched(x) for term in self.terms.values())

    @cached_property
    def mean_lengths(self) -> FloatArray:
        """<s_v> = (s_v + s_{v-1}) / 2 (n_b,), the length that belongs to vertex v."""
        return 0.5 * (self.rest_lengths + np.roll(self.rest_lengths, 1))

    @cached_property
    def bending_matrix(self) -> FloatArray:
        """B (n_b, n_b) with sum_v <s_v> kappa_v^2 = tr(x^T B x) (alpha = 1)."""
        unit = np.eye(len(self.rest_lengths))
        return self._bending_by(np.roll(unit, -1, axis=0) - unit)

    @cached_property
    def edge_bending_matrix(self) -> FloatArray:
        """K (n_b, n_b) with sum_v <s_v> kappa_v^2 = tr(e^T K e), by the edges e_v."""
        return self._bending_by(np.eye(len(self.rest_lengths)))

    def _bending_by(self, edges: FloatArray) -> FloatArray:
        """Return the bending energy's matrix by unknowns, columns (n_b, n) of the edges."""
        tangent = edges / self.rest_lengths[:, None]
        turn = tangent - np.roll(tangent, 1, axis=0)
        stiffness: FloatArray = turn.T @ (turn / self.mean_lengths[:, None])
        return stiffness

    def chain(self, tensions: FloatArray) -> FloatArray:
        """Return 2 B + D^T diag(lambda / s) D as three rows (3, n_b); n_b is 5 at least.

        They couple vertex v to itself, to v + 1 and to v + 2.
        """
        found, stress = self._bare_chain.copy(), tensions / self.rest_lengths
        found[0] += stress
        found[0, 1:] += stress[:-1]
        found[0, 0] += stress[-1]
        found[1] -= stress
        return found

    @cached_property
    def _bare_chain(self) -> FloatArray:
        """The same without tensions."""
        s, m = self.rest_lengths, self.mean_lengths
        after = np.roll(m, -1)
        # The same by the edges: each with itself, and with the next.
        own = 2 * (1 / m + 1 / after) / s**2
        beside = -2 / (s * np.roll(s, -1) * after)
        before = np.roll(beside, 1)
        return np.stack(
            [own + np.roll(own, 1) - 2 * before, beside + before - own, -beside]
        )

    @cached_property
    def stiffest_row(self) -> float:
        """The largest sum of sizes in a row of 2 B, the bending's stiffness."""
        return 2 * float(np.abs(self.bending_matrix).sum(axis=1).max())

    def chords(self, x_loop: FloatArray) -> FloatArray:
        """Return e_v = x_{v+1} - x_v (n_b, 3) of loop positions (n_b, 3)."""
        return differences(x_loop)

    def constraint(self, x_loop: FloatArray) -> FloatArray:
        """Return c_v = (|e_v|^2 - s_v^2) / (2 s_v) (n_b,); zero where lengths are kept.

        Formed as (|e| - s)(|e| + s) / (2 s): the difference of squares would lose half
        of the digits that are left near zero.
        """
        return self.excess(np.linalg.norm(self.chords(x_loop), axis=1))

    def excess(self, lengths: FloatArray) -> FloatArray:
        """Return the same of edges that are so long (n_b,)."""
        s = self.rest_lengths
        found: FloatArray = (lengths - s) * (lengths + s) / (2 * s)
        return found

    def length_error(self, x_loop: FloatArray) -> float:
        """Return max |l_v / s_v - 1|."""
        lengths = np.linalg.norm(self.chords(x_loop), axis=1)
        return float(np.abs(lengths / self.rest_lengths - 1).max())

    def strands_meet(self, x_loop: FloatArray) -> bool:
        """Whether two stretches of the loop have come as close as neighbours are.

        Strands with a thickness touch, and do not come closer.
        """
        if self.diameter is not None:
            return False
        return strands_meet(x_loop, float(self.rest_lengths.max()))

    def is_too_thick(self, x_loop: FloatArray) -> bool:
        """Whether a loop (n, d) bends more than so thick a rod can: kappa > 2 / d."""
        if self.diameter is None:
            return False
        tangent = self.chords(x_loop) / self.rest_lengths[:, None]
        turns = np.linalg.norm(backward_differences(tangent), axis=1)
        return bool((turns / self.mean_lengths).max() > 2 / self.diameter)

    def bending_energy(self, x_loop: FloatArray) -> float:
        """Return sum_v <s_v> kappa_v^2 of loop positions (n_b, 3).

        By differences: as a product with them it drowns in rounding on fine loops.
        """
        turn = backward_differences(self.chords(x_loop) / self.rest_lengths[:, None])
        return float(np.vdot(turn, turn / self.mean_lengths[:, None]))

    def bending_force(self, x_loop: FloatArray) -> FloatArray:
        """Return the gradient (n_b, 3) of sum_v <s_v> kappa_v^2, i.e. 2 B x.

        By differences of neighbours: the product 2 B x would be lost in rounding, whose
        share is eps / h^3 for edges of length h.
        """
        s = self.rest_lengths[:, None]
        tangent = self.chords(x_loop) / s
        curvature = backward_differences(tangent) / self.mean_lengths[:, None]
        return backward_differences(differences(curvature) * (2 / s))

    def tension_force(self, x_loop: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return J^T lambda (n_b, 3), the gradient of sum_v lambda_v c_v."""
        pull = (tensions / self.rest_lengths)[:, None] * self.chords(x_loop)
        return -backward_differences(pull)

    def tension_stiffness(self, tensions: FloatArray) -> FloatArray:
        """Return D^T diag(lambda / s) D (n_b, n_b): what tension adds to the stiffness."""
        stress = tensions / self.rest_lengths
        n = len(stress)
        stiffness = np.diag(stress + np.roll(stress, 1))
        v = np.arange(n)
        # Not stiffness[i, j] -= ...: with three vertices an entry can occur twice.
        np.subtract.at(stiffness, (v, (v + 1) % n), stress)
        np.subtract.at(stiffness, ((v + 1) % n, v), stress)
        return stiffness


def strands_meet(x_loop: FloatArray, reach: float | None = None) -> bool:
    """Return whether two stretches of a loop (n, d) have come as close as neighbours are.

    That is closer than `reach`, by default its longest edge. Where it turns by no more
    than 30 degrees at a vertex, a loop takes six edges to turn back, four edges away from
    itself.
    """
    n = len(x_loop)
    if n < 4 * _TURNING_BACK:
        return False
    from eulerplateau.loop.kernels import strands_within  # springs do not ask

    if reach is None:
        reach = float(np.linalg.norm(differences(x_loop), axis=1).max())
    return strands_within(np.ascontiguousarray(x_loop), reach, _TURNING_BACK)


def largest_turning(x_loop: FloatArray) -> float:
    """Return the largest angle between consecutive edges, degrees, in [0, 180].

    x_loop : (n_b, 3) float, the vertices of a closed loop in any unit.
    """
    after = differences(x_loop)
    before = np.concatenate([after[-1:], after[:-1]])
    sine = np.linalg.norm(cross(before, after), axis=1)
    cosine = (before * after).sum(axis=1)
    return float(np.degrees(np.arctan2(sine, cosine).max()))


def differences(rows: FloatArray) -> FloatArray:
    """Return D rows: row v + 1 minus row v, cyclic (np.roll costs more than the work)."""
    result = np.empty_like(rows, order="C")
    np.subtract(rows[1:], rows[:-1], out=result[:-1])
    np.subtract(rows[0], rows[-1], out=result[-1])
    return result


def backward_differences(rows: FloatArray) -> FloatArray:
    """Return -D^T rows: row v minus row v - 1, cyclic."""
    result = np.empty_like(rows, order="C")
    np.subtract(rows[1:], rows[:-1], out=result[1:])
    np.subtract(rows[0], rows[-1], out=result[0])
    return result
