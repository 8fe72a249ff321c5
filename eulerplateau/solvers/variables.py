"""The variables in which conjugate gradients search: the paper's, or well conditioned ones.

Conjugate gradients take as many iterations as the stiffest motion is stiffer than the
softest. The energy about a base point has nearly the second derivative

    M = 2 B + S + mu J^T diag(1/s) J + shift,

bending, the film at rest, the penalty of the lengths. With M = (R R^T)^-1 and the
displacement R y its stiffness by the variables y is nearly 1 in all directions: a change of
variables is all that a preconditioner is, and the method and its energy stay the same. The
film's inside is varied about where it rests, likewise (film/condensation.py).

What is left is what a loop's lengths make of a long way: a displacement u that keeps them
to first order stretches the edges by |Delta u|^2 / 2 s, and the penalty, stiff as it is,
allows short steps only. A film on a regular polygon turns against its mesh almost for
nothing, and would walk along the circle of its saddles for ever. So the variables curve
with the constraint: the loop is moved by v with

    v = u - P q(v),   q_v = |v_{v+1} - v_v|^2 / (2 s_v),   P = M^-1 J^T (J M^-1 J^T)^-1,

whose lengths change as J u, to third order after two rounds. The map is smooth and its
derivative exact, hence so is the gradient.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.linalg import cho_factor, cho_solve, cholesky, solve_triangular

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import Lengths, Loop, backward_differences, differences
from eulerplateau.solvers.equilibrium import SOFTEST_BENDING
from eulerplateau.solvers.trial_space import TrialSpace

# Rounds of v = u - P q(v).
_ROUNDS = 2
# Of the largest entry, added to J M^-1 J^T, which is singular where a loop lies on a line.
_SINGULAR = 1e-12


class Variables(Protocol):
    """Displacements (n_v, 3) of a film as a smooth function of m variables; 0 at 0."""

    @property
    def size(self) -> int:
        """Number of variables m."""

    def displacement(self, y: FloatArray) -> FloatArray:
        """Return the displacement (n_v, 3) of variables (m,)."""

    def derivative(self, y: FloatArray, gradient: FloatArray) -> FloatArray:
        """Return the derivatives (m,) by the variables, of a gradient (n_v, 3) at y."""


@dataclass(frozen=True)
class Plain:
    """The unknowns themselves, in units in which the stiffest bending has stiffness 1.

    The first step that is tried is as long as the gradient. In the unit of displacement in
    which the loop's stiffest bending mode, 32 / s^3, has stiffness 1 that step is a good
    one; in units of L it overshoots so far that the line search gives up.
    """

    space: TrialSpace
    unit: float

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return self.space.size

    def displacement(self, y: FloatArray) -> FloatArray:
        """Return the displacement (n_v, 3) of variables (m,)."""
        return self.space.displacement(self.unit * y)

    def derivative(self, y: FloatArray, gradient: FloatArray) -> FloatArray:
        """Return the derivatives (m,) by the variables."""
        return self.unit * self.space.collect(gradient)


def plain(space: TrialSpace, loop: Loop, x_loop: FloatArray, penalty: float) -> Plain:
    """Return the paper's variables."""
    return Plain(space, float(np.sqrt(loop.rest_lengths.min() ** 3 / 32)))


@dataclass(frozen=True)
class Conditioned:
    """Variables in which every motion is about as stiff as every other.

    Attributes
    ----------
    root : (3 n_b, 3 n_b) float
        R: what the loop moves by, per variable.
    lengthening : (3 n_b, n_b) float
        P: how the loop moves most easily to lengthen each edge.
    """

    space: TrialSpace
    loop: Loop
    root: FloatArray
    lengthening: FloatArray

    @property
    def size(self) -> int:
        """As many as unknowns."""
        return self.space.size

    def displacement(self, y: FloatArray) -> FloatArray:
        """Return the displacement (n_v, 3) of variables (m,)."""
        return self.space.unfold(self._curved(y)[-1], y[len(self.root) :])

    def derivative(self, y: FloatArray, gradient: FloatArray) -> FloatArray:
        """Return the derivatives (m,) by the variables."""
        force, inside = self.space.fold(gradient)
        total, s = force, self.loop.rest_lengths
        for moved in reversed(self._curved(y)[:-1]):
            pull = (force.ravel() @ self.lengthening) / s
            # The transpose of differences is -backward_differences.
            force = backward_differences(pull[:, None] * differences(moved))
            total = total + force
        return np.concatenate([total.ravel() @ self.root, inside])

    def _curved(self, y: FloatArray) -> list[FloatArray]:
        """Return u and the rounds of v (n_b, 3) that follow, the last being the move."""
        straight = (self.root @ y[: len(self.root)]).reshape(-1, 3)
        rounds = [straight]
        for _ in range(_ROUNDS):
            stretch = np.square(differences(rounds[-1])).sum(axis=1)
            excess = stretch / (2 * self.loop.rest_lengths)
            rounds.append(straight - (self.lengthening @ excess).reshape(-1, 3))
        return rounds


def conditioned(
    space: TrialSpace, loop: Loop, x_loop: FloatArray, penalty: float
) -> Conditioned:
    """Return well conditioned variables about a base point with the loop x_loop (n_b, 3).

    The shift makes no motion softer than a circle's softest bending: translations would
    cost nothing, and the softest modes are those that the film has all but buckled.
    """
    jacobian = Lengths(loop).jacobian(x_loop)
    stiffness = 2 * loop.bending_matrix + space.stiffness
    stiffness[np.diag_indices_from(stiffness)] += SOFTEST_BENDING * loop.mean_lengths
    whole = np.kron(stiffness, np.eye(3))
    whole += jacobian.T @ ((penalty / loop.rest_lengths)[:, None] * jacobian)
    upper = cholesky(whole)
    root = solve_triangular(upper, np.eye(len(whole)))
    softened = jacobian @ root
    compliance = softened @ softened.T
    compliance[np.diag_indices_from(compliance)] += _SINGULAR * compliance.max()
    lengthening = root @ cho_solve(cho_factor(compliance), softened).T
    return Conditioned(space, loop, _varied(space, root), _varied(space, lengthening))


def _varied(space: TrialSpace, moves: FloatArray) -> FloatArray:
    """Return displacements of the loop, in columns (3 n_b, k), as a space varies it."""
    columns = moves.shape[1]
    return space.varied(moves.reshape(-1, 3, columns)).reshape(-1, columns)
