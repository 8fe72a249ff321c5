"""What a solver returns: a shape, how good it is, and what it cost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import Enum
from typing import TYPE_CHECKING

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh import Shape

if TYPE_CHECKING:
    from eulerplateau.loop import Contacts

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

# The lowest eigenvalue of the bare circle, 2 (2 pi)^4 times 36/5.
SOFTEST_BENDING = 22443.0


class Status(Enum):
    """How a solve ended. Only CONVERGED rows are equilibria to be trusted."""

    CONVERGED = "converged"
    ITERATION_LIMIT = "iteration_limit"
    STALLED = "stalled"
    SADDLE = "saddle"
    NOT_FINITE = "not_finite"
    UNRESOLVED = "unresolved"
    PINCHED = "pinched"
    FOLDED = "folded"
    TOUCHING = "touching"
    COLLAPSED = "collapsed"
    TOO_THICK = "too_thick"
    FILM_TOUCHED = "film_touched"

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
    Status.FOLDED: "triangles lie on each other: a mesh without folds, or a coarser one",
    Status.TOUCHING: "the edge meets itself: a smaller load, or softer adhesions",
    Status.COLLAPSED: "two adhesions have met: leave one out, or make them stiffer",
    Status.TOO_THICK: "the loop bends more than a rod of its diameter can: a thinner one",
    Status.FILM_TOUCHED: "the film comes against rod or film, which nothing holds off here",
    Status.UNRESOLVED: "the loop turns by over 30 degrees at a vertex, or strands overlap "
    "between vertices: use a finer mesh",
}


@dataclass(frozen=True)
class Stability:
    """Eigenvalues of the second variation, rigid motions removed.

    Attributes
    ----------
    eigenvalues : (m,) float, ascending, in units alpha / L^4 for the norm integral |p|^2 ds
        All of them, or of a large loop the lowest: every one that is not stable is there.
    error_bound : float
        What rounding can have moved an eigenvalue by that is small among them.
    """

    eigenvalues: FloatArray
    error_bound: float

    @property
    def blind(self) -> bool:
        """Whether rounding hides eigenvalues, even as large as those of the bare loop."""
        return self.n_neutral > 0 and self.error_bound > 0.1 * SOFTEST_BENDING

    @property
    def n_unstable(self) -> int:
        """Eigenvalues that are negative beyond their error bound: the Morse index."""
        return int(np.sum(self.eigenvalues < -self.error_bound))

    @property
    def n_neutral(self) -> int:
        """Eigenvalues that cannot be told from zero: neither stable nor unstable."""
        return int(np.sum(np.abs(self.eigenvalues) <= self.error_bound))

    @property
    def lowest(self) -> float:
        """The smallest eigenvalue; infinite where the loop cannot move at all."""
        return float(self.eigenvalues[0]) if len(self.eigenvalues) else np.inf


@dataclass(frozen=True)
class Settled:
    """Where an iteration settled: positions (n, d), tensions, iterations."""

    x: FloatArray
    tensions: FloatArray
    iterations: int


@dataclass(frozen=True, eq=False, repr=False)
class Equilibrium:
    """An equilibrium, or the best a solver reached. Units: lengths L, energies alpha/L.

    Attributes
    ----------
    shape : the film; of a soap film its triangles may have been replaced on the way
    tensions : (n_b,) float
        Of the loop's edges: the multipliers of c_v = (|e_v|^2 - s_v^2) / (2 s_v).
    load : float
        The film's own (load.py).
    loop_energies : of what the loop's energy has beside its bending, by names
    residual : float
        |g_bending + g_film + J^T lambda|_inf over the largest of the three terms' |.|_inf.
    film_residual : float
        The largest force of the film on a vertex inside over the largest on any.
    length_error : float
        max |l_v / s_v - 1| over the loop's edges.
    stability : Stability or None
        The lowest part of the spectrum; None where the solver does not compute it.
    contacts : where strands of a loop that has a diameter touch; None without one
    """

    shape: Shape
    tensions: FloatArray
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
    stability: Stability | None = None
    loop_energies: Mapping[str, float] = field(default_factory=dict)
    contacts: Contacts | None = None

    @property
    def converged(self) -> bool:
        """Whether the tolerances are met."""
        return self.status is Status.CONVERGED

    @property
    def is_minimum(self) -> bool:
        """Whether it is an equilibrium of which it is known that no mode is unstable."""
        return self.converged and self.n_unstable == 0

    @property
    def n_unstable(self) -> int | None:
        """The Morse index; None where the solver does not compute it."""
        return None if self.stability is None else self.stability.n_unstable

    @property
    def n_neutral(self) -> int | None:
        """Eigenvalues that cannot be told from zero; None where nobody has looked."""
        return None if self.stability is None else self.stability.n_neutral

    @property
    def lowest_eigenvalue(self) -> float | None:
        """The smallest eigenvalue; None where the solver does not compute it."""
        return None if self.stability is None else self.stability.lowest

    @property
    def overlap(self) -> float:
        """By how much strands of a loop with a diameter overlap; 0 of any other."""
        return 0.0 if self.contacts is None else max(0.0, -self.contacts.smallest_gap)

    def __repr__(self) -> str:
        """Return one line: load, energy, status, Morse index."""
        index = "" if self.n_unstable is None else f", {self.n_unstable} unstable"
        return (
            f"<Equilibrium at load {self.load:.6g}: energy {self.energy:.9g}, "
            f"{self.status.value}{index}, residual {self.residual:.1e}>"
        )


def with_stability(found: Equilibrium, stability: Stability | None) -> Equilibrium:
    """Return a result with its stability, and the status that follows from it."""
    if stability is None:
        return found
    # A stall with balanced forces is an equilibrium all the same, if it is a minimum; and
    # rounding that leaves forces unbalanced on a very fine loop is a stall, as is rounding
    # that leaves nobody able to say whether it is a minimum.
    certain = found.residual <= RESIDUAL_TOLERANCE and not stability.blind
    status = found.status
    if status is Status.STALLED and certain:
        status = Status.CONVERGED if stability.n_unstable == 0 else Status.SADDLE
    elif status is Status.CONVERGED and not certain:
        status = Status.STALLED
    return replace(found, status=status, stability=stability)


def not_finite(shape: Shape, load: float) -> Equilibrium:
    """Return the record of a start that no solver can work with."""
    return Equilibrium(
        shape=shape,
        tensions=np.zeros(len(shape.loop)),
        load=load,
        energy=np.nan,
        film_energy=np.nan,
        bending_energy=np.nan,
        residual=np.nan,
        film_residual=np.nan,
        length_error=np.nan,
        iterations=0,
        seconds=0.0,
        status=Status.NOT_FINITE,
    )
