"""Where strands of a loop touch, and how they push each other: what is said of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import BoolArray, FloatArray
from eulerplateau.loop.gaps import Gaps


@dataclass(frozen=True, eq=False, repr=False)
class Contacts:
    """The contacts of a loop: k of them, lengths in units of L, forces in alpha / L^2.

    Attributes
    ----------
    s, t : (k,) float
        Where along the loop, from its first vertex.
    points : (2, k, 3) float, the same two places in space, on the centrelines
    forces : (k,) float, with which the strands push each other; the energy's slope in d
    gaps : (k,) float, the distance less the diameter
    angles : (k,) float, the acute angle between the strands' tangents, degrees
    at_a_point : (k,) bool
        Whether strands cross there; else they lie beside each other.
    slides : (k,) bool
        Whether the gap is least there by s too, and is held where it is; else it is held
        where s is. So does what crosses, and what lies beside each other at the minimum.
    uncertain : float, what a force can be off by
    pushes : (n_b, 3) float, what the contacts add to the energy's gradient
    smallest_gap : float, of all places, touching or not; infinite beyond half the diameter
    unstable_let_go : int or None
        The Morse index with the doubtful contacts let go; None where none is doubtful.
    risen : float
        By how much, in one step of the solver, what must fall has risen at most: rounding.
    """

    s: FloatArray
    t: FloatArray
    points: FloatArray
    forces: FloatArray
    gaps: FloatArray
    angles: FloatArray
    at_a_point: BoolArray
    slides: BoolArray
    uncertain: float
    pushes: FloatArray
    smallest_gap: float
    unstable_let_go: int | None = None
    risen: float = 0.0

    def __len__(self) -> int:
        """Return k."""
        return len(self.s)

    def __repr__(self) -> str:
        """Return one line: how many contacts, and their force."""
        return f"<Contacts: {len(self)}, force {self.force:.6g}>"

    @property
    def places(self) -> Gaps:
        """The gaps that are closed."""
        return Gaps(self.s, self.t, self.slides)

    @property
    def force(self) -> float:
        """The sum of the forces: dE/dd."""
        return float(self.forces.sum())

    @property
    def complementarity(self) -> float:
        """The largest force times gap, in alpha / L: 0 but for rounding at rest."""
        return float(np.abs(self.forces * self.gaps).max(initial=0.0))

    @property
    def doubtful(self) -> BoolArray:
        """Which of the forces (k,) cannot be told from none."""
        return self.forces <= self.uncertain
