"""The energy of a loop's twist: a rod that was turned, and whose ends were then welded.

Twist is free to spread along a rod that is straight by nature, and is uniform at rest. By
White's formula it is what is left of the turns Lk that were put in when the loop writhes:

    E = (gamma / 2) theta^2,   theta = 2 pi (Lk - Wr),   M = gamma theta,   dE/dLk = 2 pi M,

gamma = C / alpha = 2 C / B, C the rigidity to twist and B = 2 alpha that to bending.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.loop.frames import directors
from eulerplateau.loop.loop import Loop, backward_differences, differences
from eulerplateau.loop.term import OwnTerm, Term
from eulerplateau.loop.writhe_kernels import (
    add_edge_blocks,
    tangent_area,
    writhe,
    writhe_by_edges,
    writhe_second,
)

# Two strands that pass through each other change the writhe by 2.
_PASSED = 0.5
# Loops whose writhe is kept: where a step begins, and where it may end.
_KEPT = 4


class EvenTwist(Term):
    """The twisting energy of a welded loop, whatever stands for the loop.

    Attributes
    ----------
    ratio : float, C / B
    link : float, Lk, in turns; right-handed turns count positive
    """

    ratio: float
    link: float

    @abstractmethod
    def writhe(self, x: FloatArray) -> float:
        """Return Wr of a loop."""

    @abstractmethod
    def slope(self, x: FloatArray) -> FloatArray:
        """Return dWr/dx, as a force is."""

    @property
    def gamma(self) -> float:
        """C / alpha."""
        return 2 * self.ratio

    @property
    def is_handed(self) -> bool:
        """Whether a loop and its mirror image differ in energy: if it was turned."""
        return self.link != 0.0

    def moment(self, x: FloatArray) -> float:
        """Return the twisting moment M, in units of alpha / L."""
        return self.gamma * 2 * math.pi * (self.link - self.writhe(x))

    def energy(self, x: FloatArray) -> float:
        """Return the twisting energy."""
        return math.pi * (self.link - self.writhe(x)) * self.moment(x)

    def force(self, x: FloatArray) -> FloatArray:
        """Return -2 pi M dWr/dx."""
        return -2 * math.pi * self.moment(x) * self.slope(x)

    def rate(self, parameter: str, x: FloatArray) -> FloatArray | None:
        """Return the derivative of the force by "link" or "twist_ratio"."""
        if parameter == "link":
            return -4 * math.pi**2 * self.gamma * self.slope(x)
        if parameter == "twist_ratio":
            return -8 * math.pi**2 * (self.link - self.writhe(x)) * self.slope(x)
        return None


@dataclass(frozen=True)
class Twist(EvenTwist, OwnTerm):
    """The twisting energy of a welded loop x (n, 3), in units of alpha / L.

    Attributes
    ----------
    loop : its edges' lengths
    ratio : float, C / B
    link : float, Lk, in turns; right-handed turns count positive
    """

    loop: Loop
    ratio: float
    link: float
    _known: list[tuple[FloatArray, float]] = field(default_factory=list, repr=False)

    @property
    def parameters(self) -> Mapping[str, float]:
        """The link and C / B."""
        return {"link": self.link, "twist_ratio": self.ratio}

    def with_value(self, parameter: str, value: float) -> Twist:
        """Return the twist at another link or C / B; what is known of loops stays known."""
        if parameter == "link":
            return replace(self, link=value)
        return replace(self, ratio=value) if parameter == "twist_ratio" else self

    def on_edges(self, rest_lengths: FloatArray) -> Twist:
        """Return the twist of the same loop with other edges, so long (n,)."""
        return replace(self, loop=replace(self.loop, rest_lengths=rest_lengths), _known=[])

    @property
    def rounding(self) -> float:
        """What rounding alone leaves of the force, per unit of position."""
        shortest = float(self.loop.rest_lengths.min())
        turns = abs(self.link) + 1
        eps = float(np.finfo(np.float64).eps)
        return eps * self.gamma * (2 * math.pi) ** 2 * turns * 4 / shortest**2

    def writhe(self, x: FloatArray) -> float:
        """Return Wr of a loop, by all pairs of its edges."""
        for place, known in self._known:
            if np.array_equal(place, x):
                return known
        found = polygon_writhe(x)
        self._known[:] = [(x.copy(), found), *self._known[: _KEPT - 1]]
        return found

    def columns(self, x: FloatArray) -> Mapping[str, float]:
        """Return what a table says of the twist of a loop."""
        return {
            "twist_energy": self.energy(x),
            "writhe": self.writhe(x),
            "link": self.link,
            "twist_moment": self.moment(x),
        }

    def fields(self, x: FloatArray) -> Mapping[str, FloatArray]:
        """Return which way the rod points, at each vertex that of the edge behind it."""
        return {"director": directors(x, self.link - self.writhe(x))}

    def pinched(self, x: FloatArray) -> bool:
        """Return whether strands meet: without thickness no twist is held beyond that."""
        return self.loop.strands_meet(x)

    def slope(self, x: FloatArray) -> FloatArray:
        """Return dWr/dx (n, 3)."""
        return -backward_differences(writhe_by_edges(differences(x), np.ones(len(x))))

    def hessian(self, x: FloatArray) -> FloatArray:
        """Return -2 pi M d2Wr/dx2 + 4 pi^2 gamma dWr/dx dWr/dx (3 n, 3 n)."""
        slope = self.slope(x).ravel()
        matrix = np.outer(4 * math.pi**2 * self.gamma * slope, slope)
        blocks = matrix.reshape(len(x), 3, len(x), 3)
        factor = -2 * math.pi * self.moment(x)
        add_edge_blocks(*writhe_second(differences(x), np.ones(len(x))), factor, blocks)
        return matrix

    def change(self, x: FloatArray, step: FloatArray) -> float:
        """Return the energy at x + step less that at x.

        By the tangents' area, which is as precise as the difference. Raises LinAlgError
        where that is not the change of the writhe: a strand would pass through another.
        """
        after = x + step
        gained = writhe_gained(x, after)
        if passes(self.writhe(after) - self.writhe(x), gained):
            raise LinAlgError("a strand of the loop would pass through another")
        return -math.pi * gained * (self.moment(x) + self.moment(after))

    def reaches(self, x: FloatArray, other: FloatArray) -> bool:
        """Return whether the writhe changes by as much as it does locally."""
        return not passes(self.writhe(other) - self.writhe(x), writhe_gained(x, other))


@dataclass(frozen=True)
class PlaneTwist(Twist):
    """The same of a loop that is kept in its plane: nothing writhes, and it is constant."""

    @property
    def rounding(self) -> float:
        """Return 0: there is no force."""
        return 0.0

    def writhe(self, x: FloatArray) -> float:
        """Return 0."""
        return 0.0

    def slope(self, x: FloatArray) -> FloatArray:
        """Return no change of the writhe (n, d)."""
        return np.zeros_like(x)

    def hessian(self, x: FloatArray) -> FloatArray:
        """Return no stiffness (n, n)."""
        return np.zeros((len(x), len(x)))

    def change(self, x: FloatArray, step: FloatArray) -> float:
        """Return 0."""
        return 0.0

    def reaches(self, x: FloatArray, other: FloatArray) -> bool:
        """Return True."""
        return True


def polygon_writhe(x: FloatArray) -> float:
    """Return the writhe of a closed polygon x (n, 3), by all pairs of its edges."""
    return float(writhe(np.ascontiguousarray(x)))


def writhe_gained(x: FloatArray, after: FloatArray) -> float:
    """Return by how much the writhe changes on a short way, modulo 2."""
    return tangent_area(differences(x), differences(after)) / (2 * math.pi)


def passes(gained: float, locally: float) -> bool:
    """Return whether a strand has passed through another: the writhe gained more."""
    return abs(gained - locally) > _PASSED


def passed(x: FloatArray, after: FloatArray) -> bool:
    """Return whether a strand of a loop (n, 3) has passed through another on a short way.

    Never in a plane (n, 2), where strands that pass can be seen to cross.
    """
    if x.shape[1] == 2:
        return False
    gained = polygon_writhe(after) - polygon_writhe(x)
    return passes(gained, writhe_gained(x, after))
