"""An energy of loops: a sum of terms, with the constraint and the free motions it has.

Whoever adds to the physics of the loop (a film, twist, contact, adhesion, line tension)
writes a `Term`; what minimises and follows equilibria knows only the sum of them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.loop.term import Term, product, summed
from eulerplateau.loop.turns import EdgeTurns


class Constraint(Protocol):
    """m equations c(x) = 0 for loops x (n, d); their multipliers are called tensions."""

    def jacobian(self, x: FloatArray) -> FloatArray:
        """Return dc/dx (m, d n)."""

    def force(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return J^T tensions (n, d), for tensions (m,)."""

    def stiffness(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return the second derivative of tensions . c, as a term's `hessian` is."""

    def project(self, x: FloatArray) -> FloatArray | None:
        """Return the nearest loop (n, d) with c = 0, to rounding; None if it is lost."""

    def turns(self, x: FloatArray) -> EdgeTurns | None:
        """Return the turns of edges by which it is kept, if it keeps each edge's length."""

    def split_stiffness(
        self, x: FloatArray, tensions: FloatArray
    ) -> tuple[FloatArray | None, FloatArray]:
        """Return the second derivative of tensions . c in two parts, if it has turns.

        By positions (d n, d n) what is no edge's length, if anything is; and by each edge
        (n,), the same number for all coordinates of it.
        """


class Bounds(Protocol):
    """Inequalities of loops x (n, d), of which some hold as equations: gaps of strands."""

    def margins(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return numbers (k,) that are not negative as long as the same ones do.

        They are continuous along a branch; none where nothing is bounded.
        """

    def holds(self, x: FloatArray) -> bool:
        """Return whether they are still said the way they should be at x."""

    def reaches(self, x: FloatArray, other: FloatArray) -> bool:
        """Return whether a short way leads to another loop: nothing passes through."""

    def drift(self, parameter: str, x: FloatArray) -> FloatArray | None:
        """Return how a loop (n, d) must move for what is an equation of it to stay one.

        That is the least displacement, for a parameter that rises by 1; None where the
        equations do not depend on it.
        """


class Unbounded:
    """No inequalities."""

    def margins(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return none (0,)."""
        return np.zeros(0)

    def holds(self, x: FloatArray) -> bool:
        """Return True."""
        return True

    def reaches(self, x: FloatArray, other: FloatArray) -> bool:
        """Return True."""
        return True

    def drift(self, parameter: str, x: FloatArray) -> None:
        """Return None."""


@dataclass(frozen=True)
class LoopEnergy:
    """A sum of terms, and what a solver must know to minimise it.

    Attributes
    ----------
    terms : the terms by their names, as "bending" and "film"
    constraint : what every loop is held to: the lengths of its edges, or nothing
    weights : (n,) float
        The length that belongs to each vertex: |p|^2 = sum_v weights_v |p_v|^2.
    free_motions : function of x (n, d)
        Returns displacements that keep the constraint and cost nothing, as columns
        (d n, m): rigid motions, sliding; none of a loop that is pinned.
    bounds : what a branch of its loops must keep to besides, by default nothing
    """

    terms: Mapping[str, Term]
    constraint: Constraint
    weights: FloatArray
    free_motions: Callable[[FloatArray], FloatArray]
    bounds: Bounds = field(default_factory=Unbounded)

    @property
    def is_handed(self) -> bool:
        """Whether a loop and its mirror image differ in energy."""
        return any(term.is_handed for term in self.terms.values())

    @cached_property
    def rounding(self) -> float:
        """What rounding alone leaves of a force, per unit of position."""
        return sum(term.rounding for term in self.terms.values())

    def forces(self, x: FloatArray) -> list[FloatArray]:
        """Return the gradient of each term (n, d)."""
        return [term.force(x) for term in self.terms.values()]

    def hessian(self, x: FloatArray) -> FloatArray:
        """Return the second derivative: one matrix (n, n) for all coordinates, or full."""
        return summed([term.hessian(x) for term in self.terms.values()], len(x))

    def lagrangian_hessian(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return the second derivative of the energy plus tensions . constraint.

        It is that on displacements which keep the constraint to first order, and one
        matrix (n, n) for all coordinates, or a full one (d n, d n).
        """
        parts = [term.hessian(x) for term in self.terms.values()]
        return summed([*parts, self.constraint.stiffness(x, tensions)], len(x))

    def split_hessian(
        self, x: FloatArray, tensions: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return the same in two parts, of a loop that keeps its edges' lengths.

        What is no form of the edges by positions, as `hessian` is; the rest by edges.
        """
        others, edges = self.constraint.split_stiffness(x, tensions)
        by_edges, parts = np.diag(edges), [] if others is None else [others]
        for term in self.terms.values():
            form = term.edge_hessian()
            if form is None:
                parts.append(term.hessian(x))
            else:
                by_edges += form
        return summed(parts, len(x)), by_edges

    def product(self, x: FloatArray, tensions: FloatArray, step: FloatArray) -> FloatArray:
        """Return the same times a step (n, d) that keeps the constraint to first order."""
        parts = [term.product(x, step) for term in self.terms.values()]
        held = product(self.constraint.stiffness(x, tensions), step)
        return sum(parts, start=held)

    def change(self, x: FloatArray, step: FloatArray) -> float:
        """Return the energy at x + step less that at x, as precise as the difference."""
        return sum(term.change(x, step) for term in self.terms.values())

    def rate(self, parameter: str, x: FloatArray) -> FloatArray:
        """Return the derivative of the force (n, d) by a parameter of some of the terms.

        Raises ValueError if no term depends on it.
        """
        rates = [term.rate(parameter, x) for term in self.terms.values()]
        known = [rate for rate in rates if rate is not None]
        if not known:
            raise ValueError(f"no term of the energy depends on {parameter!r}")
        return sum(known[1:], start=known[0])

    def pull(self, parameter: str, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return the same (n, d) of a loop in balance, which drifts with its bounds."""
        drift = self.bounds.drift(parameter, x)
        if drift is None:
            return self.rate(parameter, x)
        return product(self.lagrangian_hessian(x, tensions), drift)

    def holds(self, x: FloatArray) -> bool:
        """Return whether all terms, and bounds, are still good at x."""
        return self.bounds.holds(x) and all(term.holds(x) for term in self.terms.values())

    def reaches(self, x: FloatArray, other: FloatArray) -> bool:
        """Return whether by all that is known a short way leads from x to another loop."""
        terms = self.terms.values()
        return self.bounds.reaches(x, other) and all(t.reaches(x, other) for t in terms)
