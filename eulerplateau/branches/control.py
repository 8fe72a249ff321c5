"""How a branch is followed, and directions in which it may go on."""

from __future__ import annotations

from dataclasses import dataclass

from eulerplateau.arrays import FloatArray


@dataclass(frozen=True)
class StepControl:
    """How a branch is followed.

    Attributes
    ----------
    window : the parameter's range; a branch ends where it leaves it
    unit : float
        A change of the parameter by this much is as long as a displacement of 1 L (r.m.s.).
    first_step, largest_step, smallest_step : arclengths
    max_points : int, per branch
    least : float
        Values of the parameter down to this one, included, do not exist.
    """

    window: tuple[float, float]
    unit: float
    first_step: float = 5e-3
    largest_step: float = 0.03
    smallest_step: float = 1e-9
    max_points: int = 400
    least: float = 0.0

    def scale(self, value: float) -> float:
        """Return with what differences from a value are compared.

        That is the value, or `unit` where zero is a value like any other.
        """
        return value if self.least >= 0 else self.unit


@dataclass(frozen=True)
class Direction:
    """A direction of a branch, of unit arclength.

    Attributes
    ----------
    displacement : (n, d) float, of the loop
    rate : float, of the parameter
    """

    displacement: FloatArray
    rate: float

    def reversed(self) -> Direction:
        """Return the opposite direction."""
        return Direction(-self.displacement, -self.rate)


@dataclass(frozen=True)
class Motion:
    """A displacement (n, d) with changes of both parameters (2,)."""

    displacement: FloatArray
    rates: FloatArray

    def __mul__(self, factor: float) -> Motion:
        """Return it times a number."""
        return Motion(factor * self.displacement, factor * self.rates)

    def __add__(self, other: Motion) -> Motion:
        """Return the sum of two."""
        return Motion(self.displacement + other.displacement, self.rates + other.rates)

    def __sub__(self, other: Motion) -> Motion:
        """Return the difference of two."""
        return self + other * -1.0


@dataclass(frozen=True)
class Hyperplane:
    """All loops and values across a way from one: where a point of a branch is sought.

    Attributes
    ----------
    x : (n, d) float
    value : float, of the parameter
    way : the direction it is normal to
    """

    x: FloatArray
    value: float
    way: Direction
    control: StepControl
