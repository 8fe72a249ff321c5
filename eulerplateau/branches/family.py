"""What a branch is a branch of: energies of a loop that differ in one parameter."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol, Self, TypeVar

from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.control import Hyperplane
from eulerplateau.loop import LoopEnergy

Point = TypeVar("Point")


class Family(Protocol):
    """Energies of a loop that differ in one parameter, good near one shape.

    A soap film is known near one shape at a time, so a family is made anew where the film
    has turned too far. What x is, vertices (n, d) or any other unknowns, only it knows.
    """

    @property
    def parameter(self) -> str:
        """Name of the parameter, by which the energies' terms know it: see Term.rate."""

    def energy(self, value: float) -> LoopEnergy:
        """Return the energy at a value of the parameter."""

    def with_value(self, parameter: str, value: float) -> Family:
        """Return the family at another value of a parameter that it does not vary."""

    def positions(self, x: FloatArray) -> FloatArray:
        """Return the loop in space (k, 3), or in a plane (k, 2), that x (n, d) stands for.

        It is linear in x, so that displacements are taken to displacements.
        """

    def near(self, x: FloatArray) -> Family:
        """Return the family made anew at a loop x (n, d), or itself."""

    def rests(self, model: Any, value: float) -> bool:
        """Return whether forces balance at a point's TangentModel, as at an equilibrium."""

    def settled(self, point: Any, plane: Hyperplane) -> Any | None:
        """Return what stands for a BranchPoint of a hyperplane; None if there is none.

        Itself, but for strands that touch: where they do they overlap nowhere then.
        """

    def steady(self, x: FloatArray) -> Family:
        """Return the family in which steps from a loop x (n, d) are taken."""

    def released(self, x: FloatArray) -> Family:
        """Return the family whose film is free to move inside its surface, if it can be."""

    def kept(self, x: FloatArray) -> Mapping[str, NDArray[Any]]:
        """Return what makes it again, good near a loop x (n, d), to the bit."""

    def restored(self, kept: Mapping[str, NDArray[Any]]) -> Family:
        """Return the family that this was `kept` of, itself where it is no other."""


class UnboundedFamily:
    """What a Family knows of strands that touch if nothing bounds its loops."""

    def settled(self, point: Point, plane: Hyperplane) -> Point:
        """Return the point."""
        return point

    def steady(self, x: FloatArray) -> Self:
        """Return itself."""
        return self
