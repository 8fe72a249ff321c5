"""What a solver returns: a shape, how good it is, and what it cost."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from eulerplateau.arrays import FloatArray, IntArray

# What an accepted equilibrium meets: force imbalance relative to the largest force, and
# relative error of every loop edge's length.
RESIDUAL_TOLERANCE = 1e-6
LENGTH_TOLERANCE = 1e-8
# Forces of larger loads overflow where they are squared.
LARGEST_LOAD = 1e100
# A loop that turns farther than this at a vertex (degrees) is too coarse for its own shape:
# its equilibrium may be exact, and says nothing about a smooth loop. The excess is for
# rounding: a regular dodecagon turns by 30 degrees.
RESOLVED_TURNING = 30.0 * (1 + 1e-9)


class Status(Enum):
    """How a solve ended. Only CONVERGED rows are equilibria to be trusted."""

    CONVERGED = "converged"
    ITERATION_LIMIT = "iteration_limit"
    STALLED = "stalled"
    SADDLE = "saddle"
    NOT_FINITE = "not_finite"
    UNRESOLVED = "unresolved"
    PINCHED = "pinched"

    @property
    def advice(self) -> str:
        """One line telling the user what to do about it."""
        return _ADVICE[self]


_ADVICE = {
    Status.CONVERGED: "an equilibrium within the stated tolerances",
    Status.ITERATION_LIMIT: "raise solver.max_iterations, or approach in smaller steps",
    Status.STALLED: "rounding allows no more: smaller load steps, or a coarser, even mesh",
    Status.SADDLE: "lower states lie close by: the load is at a transition; step past it",
    Status.NOT_FINITE: "the start is not finite, or the energy overflowed: a smaller load",
    Status.PINCHED: "two strands of the loop meet: no film spans what is between them",
    Status.UNRESOLVED: "the loop turns by over 30 degrees at a vertex: use a finer mesh",
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
        The film's own (load.py).
    residual : float
        |g_bending + g_film + J^T lambda|_inf over the largest of the three terms' |.|_inf.
    film_residual : float
        The largest force of the film on a vertex inside over the largest on any.
    length_error : float
        max |l_v / s_v - 1| over the loop's edges.
    n_unstable, n_neutral, lowest_eigenvalue :
        Stability (stability.py), None where the solver does not compute it.
    triangles : (n_t, 3) int
        Those of a soap film whose mesh was repaired on the way; None if it was not.
    """

    x: FloatArray
    multipliers: FloatArray
    load: float
    energy: float
    film_energy: float
    bending_energy: float
    residual: float
    film_residual: float
    length_error: float
    iterations: int
    seconds: float
    status: Status
    n_unstable: int | None = None
    n_neutral: int | None = None
    lowest_eigenvalue: float | None = None
    triangles: IntArray | None = None

    @property
    def converged(self) -> bool:
        """Whether the tolerances are met."""
        return self.status is Status.CONVERGED
