"""Columns of a film's rows that only some runs have: of what is varied, of contact."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any


@dataclass(frozen=True)
class OfRatio:
    """What a row says besides where the rigidity to twist is varied.

    Attributes
    ----------
    twist_ratio : float, C / B
    """

    twist_ratio: float


@dataclass(frozen=True)
class OfLength:
    """What a row says besides where the loop's length is varied.

    Attributes
    ----------
    length_m : float, in m
    """

    length_m: float


@dataclass(frozen=True)
class OfSurfaceTension:
    """What a row says besides where the liquid's surface tension is varied.

    Attributes
    ----------
    surface_tension_N_per_m : float, in N/m
    """

    surface_tension_N_per_m: float  # noqa: N815 - the column's name


@dataclass(frozen=True)
class OfDiameter:
    """What a row says besides where the loop's thickness is varied.

    Attributes
    ----------
    diameter : float, in units of L
    """

    diameter: float


@dataclass(frozen=True)
class OfContact:
    """What a row says besides of a loop that has a thickness: None where it has none.

    Attributes
    ----------
    contacts : int, at how many places strands touch; None if there is no film
    contact_force : float, the sum of the forces with which they push, alpha / L^2
    smallest_gap : float, between strands; None beyond half the diameter
    crossing_angle : float, between the strands that push most, degrees, in [0, 90]
    film_vertices : int, of its triangles: more than the mesh's where it was refined
    """

    contacts: int | None
    contact_force: float | None
    smallest_gap: float | None
    crossing_angle: float | None
    film_vertices: int


@cache
def with_own(own: Any, row: Any) -> Any:
    """Return the type of rows with the columns of `own` after those of `row`."""
    made = type(f"{own.__name__}{row.__name__}", (own, row), {"__doc__": row.__doc__})
    return dataclass(frozen=True)(made)
