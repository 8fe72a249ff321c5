"""What a solver returns: a shape, how good it is, and what it cost."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from eulerplateau.mesh import FloatArray

# What an accepted equilibrium meets: force imbalance relative to the largest force, and
# relative error of every loop edge's length.
RESIDUAL_TOLERANCE = 1e-6
LENGTH_TOLERANCE = 1e-8


class Status(Enum):
    """How a solve ended. Only CONVERGED rows are equilibria to be trusted."""

    CONVERGED = "converged"
    ITERATION_LIMIT = "iteration_limit"
    STALLED = "stalled"
    SADDLE = "saddle"
    NOT_FINITE = "not_finite"

    @property
    def advice(self) -> str:
        """One line telling the user what to do about it."""
        return _ADVICE[self]


_ADVICE = {
    Status.CONVERGED: "an equilibrium within the stated tolerances",
    Status.ITERATION_LIMIT: "raise solver.max_iterations, or approach in smaller steps",
    Status.STALLED: "rounding allows no more: take smaller load steps, or a coarser mesh",
    Status.SADDLE: "lower states lie close by: the load is at a transition; step past it",
    Status.NOT_FINITE: "the energy overflowed: use a smaller load or a finer mesh",
}


@dataclass(frozen=True)
class Equilibrium:
    """An equilibrium, or the best a solver reached. Units: lengths L, energies alpha/L.

    Attributes
    ----------
    x : (n_v, 3) float
    multipliers : (n_b,) float
        Edge tensions lambda, the multipliers of c_v = (|e_v|^2 - s_v^2) / (2 s_v).
    load : float
        k L^3 / alpha.
    residual : float
        |g_bending + g_film + J^T lambda|_inf over the largest of the three terms' |.|_inf.
    length_error : float
        max |l_v / s_v - 1| over the loop's edges.
    n_unstable, n_neutral, lowest_eigenvalue :
        Stability (stability.py), None where the solver does not compute it.
    """

    x: FloatArray
    multipliers: FloatArray
    load: float
    energy: float
    film_energy: float
    bending_energy: float
    residual: float
    length_error: float
    iterations: int
    seconds: float
    status: Status
    n_unstable: int | None = None
    n_neutral: int | None = None
    lowest_eigenvalue: float | None = None

    @property
    def converged(self) -> bool:
        """Whether the tolerances are met."""
        return self.status is Status.CONVERGED
