"""A point that a live film has come to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh import Shape
from eulerplateau.runs.rows import Row


@dataclass(frozen=True)
class Visited:
    """An equilibrium, or what the solver came to, and how it was come to.

    Attributes
    ----------
    values : {column: value as it is shown}, of all that is varied
    row : its numbers
    shape : the film
    radius : float or None, half of the loop's diameter, in units of L, if it has one
    directors : (n_b, 3) float or None, across the loop's edges, where it resists twist
    way : "begin", "follow", "kick" or "other"
    jumped : bool, whether the film lost energy on the way from the point before
    """

    values: Mapping[str, float]
    row: Row
    shape: Shape
    radius: float | None
    directors: FloatArray | None
    way: str
    jumped: bool
