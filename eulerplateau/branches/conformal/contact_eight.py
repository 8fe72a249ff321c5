"""The twisted eight of a loop with a diameter, whose strands touch in one point.

It is the film whose waist is held at the diameter, as long as the strands push each other
and touch where they are nearest.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from eulerplateau.branches.conformal.curved import NoFilmError
from eulerplateau.branches.conformal.films import checked
from eulerplateau.branches.conformal.touching import (
    FIRST,
    Touching,
    in_contact,
    way,
)
from eulerplateau.branches.conformal.with_rod import WithRod
from eulerplateau.exact import checked_diameter
from eulerplateau.exact.conformal import (
    TWISTED,
    make_basis,
    nearest_strands,
    twisted_film,
)

# The most harmonics in the end.
_MOST = 324
# A point force leaves errors of O(K^-3): relative change of the energy that is small enough
# from one number of harmonics to the next, and part of it that is left then.
_ENOUGH, _LEFT = 1e-9, 1 / (1.5**3 - 1)
_RESOLVED = 1e-7
# Points of the loop that are nearer than this part of the diameter less overlap.
_TOUCHES = 1e-9


@dataclass(frozen=True)
class ThickEight(WithRod):
    """A twisted eight in contact; lengths in L, energies in alpha / L.

    Attributes
    ----------
    n_unstable : the Morse index, the strands in contact
    contact_force : F = dE/dd, in alpha / L^2
    crossing_angle : the acute angle between the tangents where they touch, degrees
    smallest_gap : of all points of the tube's centre line, less the diameter
    convexity : the least second derivative of the strands' distance, times the diameter
    energy_error : relative, what is left from truncation, roughly
    """

    diameter: float
    contact_force: float
    crossing_angle: float
    smallest_gap: float
    convexity: float
    energy_error: float

    @property
    def status(self) -> str:
        """Whether it is an equilibrium of a loop of this diameter, or why not."""
        _, x1, x2 = self.film.curve
        bends = np.linalg.norm(np.cross(x1, x2), axis=1) / np.linalg.norm(x1, axis=1) ** 3
        if bends.max() > 2 / self.diameter:
            return "too_thick"
        if self.contact_force <= 0:
            return "opens"
        if self.convexity <= 0 or self.smallest_gap < -_TOUCHES * self.diameter:
            return "splits"
        return "converged" if self.energy_error < _RESOLVED else "unresolved"

    @property
    def refusal(self) -> str | None:
        """What is wrong with it and what to do, if it is no equilibrium."""
        reasons = {
            "too_thick": "the loop bends more than its thickness allows: take a smaller "
            "diameter",
            "opens": "the eight opens: its strands would have to pull each other with "
            f"{-self.contact_force:.4g} alpha/L^2; take a higher load or a smaller "
            "diameter",
            "splits": "one point of contact is not enough: strands would overlap beside "
            "it; take a lower load, or a mesh",
        }
        return reasons.get(self.status)

    def numbers(self) -> dict[str, float | int | str]:
        """Return what is said of it; raises NoFilmError if it is no equilibrium."""
        if self.refusal is not None:
            raise NoFilmError(self.refusal, self.status)
        return {
            **self.parts(),
            "waist": self.diameter,
            "contact_force": self.contact_force,
            "crossing_angle": self.crossing_angle,
            "smallest_gap": self.smallest_gap,
            "n_unstable": self.n_unstable,
            "energy_error": self.energy_error,
            "residual": self.film.residual,
            "status": self.status,
        }


def thick_eight(
    load: float, diameter: float, twist_ratio: float = 0.0, link: float = 0.0
) -> ThickEight:
    """Return the twisted eight of a loop with a diameter, wound the way it was turned.

    Parameters
    ----------
    load : float, sigma_hat = sigma L^3 / alpha, positive
    diameter : float, in L, up to 0.1
    twist_ratio : float, C / B; with 0 the link must be 0
    link : float, Lk, in turns

    Raises
    ------
    SpecError : for wrong numbers
    NoFilmError : where Newton's method finds no film on the way there
    """
    checked(load, twist_ratio, link)
    checked_diameter(diameter)
    if link < 0:
        return thick_eight(load, diameter, twist_ratio, -link).mirrored()
    values = {"load": load, "twist_ratio": twist_ratio, "link": link, "diameter": diameter}
    return measured(touching(values))


def touching(values: Mapping[str, float]) -> Touching:
    """Return the film held at a diameter, by few harmonics; raises NoFilmError if none is.

    From where its strands touch without force, at the load at which an untwisted eight of
    this diameter opens. values : "load", "twist_ratio", "link" and "diameter"
    """
    untwisted = {**values, "twist_ratio": 0.0, "link": 0.0}
    free = twisted_film(values["diameter"])
    without_force = in_contact(free, {**untwisted, "load": free.load})
    return reached(reached(without_force, untwisted), values)


def reached(start: Touching, values: Mapping[str, float], step: float = FIRST) -> Touching:
    """Return the film at other values; raises NoFilmError if it is not found."""
    *_, found = start, *way(start, values, step)
    if found.values != values:
        problem = "Newton's method finds no film with one point of contact"
        how, status = _lost(start, found)
        where = f"sigma_hat = {values['load']:g}"
        raise NoFilmError(f"{problem} at {where}{how}", status)
    return found


def _lost(start: Touching, last: Touching) -> tuple[str, str]:
    """Return what has become of films on a way that ends with the last one; a status."""
    if last is not start and last.force < 0:
        return "; it opens before", "opens"
    at = "sigma_hat = {load:g}, twist ratio {twist_ratio:g}, link {link:g}"
    at = at.format(**last.values)
    if last.convexity <= 0:
        return f"; one point is not enough at {at} already", "splits"
    return f"; the last on the way there is at {at}", "stalled"


def refined(film: Touching) -> tuple[Touching, Touching]:
    """Return a film by more and more harmonics, the last two."""
    coarse = film
    while (harmonics := 3 * film.basis.harmonics // 2) <= _MOST:
        finer = film.in_basis(make_basis(harmonics, TWISTED, film.basis.crowding))
        if finer is None:
            break
        coarse, film = film, finer
        if abs(coarse.energy / film.energy - 1) < _ENOUGH:
            break
    return coarse, film


def measured(held: Touching) -> ThickEight:
    """Return a film, stable or not, with all its numbers, by enough harmonics."""
    coarse, fine = refined(held)
    family, point, values = fine.family, fine.point, fine.values
    film, twist = family.film(point), family.twist(point.value)
    change = abs(coarse.energy / fine.energy - 1) if coarse is not fine else math.inf
    return ThickEight(
        film=film,
        diameter=values["diameter"],
        twist_ratio=twist.ratio,
        link=twist.link,
        energy=fine.energy,
        twist_energy=twist.twist_energy(fine.x),
        writhe=twist.writhe(fine.x),
        twist_moment=twist.moment(fine.x),
        contact_force=fine.force,
        crossing_angle=fine.crossing.angle,
        smallest_gap=nearest_strands(film.curve, values["diameter"]) - values["diameter"],
        convexity=fine.convexity,
        n_unstable=family.in_space(point).n_unstable,
        energy_error=_LEFT * change,
    )
