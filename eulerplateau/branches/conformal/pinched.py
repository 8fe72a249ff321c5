"""The flat figure eight of a rod that resists twist, pinched where it crosses itself.

It is the end of the films of given writhe: as the waist closes the writhe tends to one
turn, that of a flat crossing, and the moment that holds it to zero, E_0'(1) = 0. So the
energy of a rod of link Lk rises there with the writhe by -2 pi M, M = gamma 2 pi (Lk - 1):
turned by less than a turn the rod opens its pinch; turned by more it presses its strands
together, and without thickness they would pass through each other.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from eulerplateau.branches.conformal.films import checked
from eulerplateau.errors import SpecError
from eulerplateau.exact.conformal import flat_eight


@dataclass(frozen=True)
class PinchedEight:
    """A flat eight; energies in alpha / L.

    Attributes
    ----------
    energy : of film, bending and twist
    writhe : one turn, the way the rod was turned
    pinch : "opens", "presses", or "rests" where there is no moment
    """

    energy: float
    area: float
    bending: float
    twist_energy: float
    writhe: float
    twist_moment: float
    pinch: str

    def numbers(self) -> dict[str, float | str]:
        """Return what is said of it, by names."""
        return {**vars(self), "waist": 0.0, "status": "pinched"}


def pinched_eight(
    load: float, twist_ratio: float = 0.0, link: float = 0.0, rest_curvature: float = 0.0
) -> PinchedEight:
    """Return the flat eight at a load, and what twist does to its pinch.

    Parameters are those of `rod_film`. Raises SpecError for wrong ones, and for a rod that
    is curved by nature: the frame that it has in an eight is not known here.
    """
    checked(load, twist_ratio, link, rest_curvature)
    if rest_curvature != 0.0:
        raise SpecError("rest_curvature", "should be 0 where the film is pinched")
    flat = flat_eight(load)
    writhe = math.copysign(1.0, link)
    moment = 4 * math.pi * twist_ratio * (link - writhe)
    twist = math.pi * moment * (link - writhe)
    pushes = moment * writhe
    return PinchedEight(
        energy=flat.energy + twist,
        area=flat.area,
        bending=flat.energy - load * flat.area,
        twist_energy=twist,
        writhe=writhe,
        twist_moment=moment,
        pinch="opens" if pushes < 0 else "presses" if pushes > 0 else "rests",
    )
