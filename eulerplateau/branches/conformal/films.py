"""The film of true area at a load, bounded by a rod of given twist ratio and link.

From a flat film or a twisted one of no link it follows the film to the link asked for,
along the films of given writhe (by_writhe.py), which has no folds; where the link folds on
that way no film of this branch is left to follow.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import Enum
from itertools import chain, islice, pairwise

from eulerplateau.branches.brent import zero_between
from eulerplateau.branches.conformal.by_writhe import (
    CONTROL,
    NARROWEST,
    Tell,
    films_by_writhe,
)
from eulerplateau.branches.conformal.curved import NoFilmError, curved
from eulerplateau.branches.conformal.family import SmoothFamily, smooth_family
from eulerplateau.branches.conformal.resolution import TAIL, resolved
from eulerplateau.branches.conformal.with_rod import WithRod
from eulerplateau.branches.point import BranchPoint, ahead, first_point, point_near
from eulerplateau.errors import SpecError
from eulerplateau.exact import finite
from eulerplateau.exact.conformal import (
    BUCKLING,
    TWISTED,
    disk,
    edge,
    make_basis,
    waist,
)
from eulerplateau.solvers import LARGEST_LOAD

_ROUND_HARMONICS = 16
_MOST_MODES = 240
_FOUND = 1e-13

# Neighbours on a branch, and what is looked for between them.
Neighbours = tuple[BranchPoint, BranchPoint, "_Held"]


class Start(Enum):
    """Which film is followed from no link to the one asked for."""

    DISK = "disk"
    LOBES = "lobes"
    TWISTED = "twisted"
    EIGHT = "eight"


@dataclass(frozen=True)
class RodFilm(WithRod):
    """A film that is held by nothing but its rod.

    Attributes
    ----------
    tail : the relative error of truncation, roughly, of the loop and of a frame
    """

    tail: float

    @property
    def resolved(self) -> bool:
        """Whether the harmonics resolve it to ten digits."""
        return self.tail < TAIL

    def numbers(self) -> dict[str, float | int | str]:
        """Return what is said of it, by names."""
        frame = edge(self.film)
        return {
            **self.parts(),
            "abs_kappa_n": frame.abs_kappa_n,
            "total_gauss_curvature": frame.total_gauss_curvature,
            "waist": waist(self.film),
            "n_unstable": self.n_unstable,
            "tail": self.tail,
            "residual": self.film.residual,
            "status": "converged" if self.resolved else "unresolved",
        }


def rod_film(
    start: Start,
    load: float,
    twist_ratio: float = 0.0,
    link: float = 0.0,
    rest_curvature: float = 0.0,
    tell: Tell = lambda where: None,
) -> RodFilm:
    """Return the film that a start leads to at a load, with a rod turned `link` times.

    Parameters
    ----------
    start : Start, but for EIGHT, which has no harmonics
    load : float, sigma_hat = sigma L^3 / alpha, positive
    twist_ratio : float
        C / B; with 0 twist costs nothing, and the link must be 0.
    link : float
        Lk, in turns. Lobes of a negative one are the mirror image; a twisted film is
        right-handed where it starts, with no link.
    rest_curvature : float
        q = k0 L / 2 pi: from the link the film is followed to it. A rod that was turned by
        no whole number of turns was welded at phi = 0, the tip of a lobe.
    tell : is told how far that has come, film by film

    Raises
    ------
    SpecError : for a load at which there is no such start, or another wrong number
    NoFilmError : where the branch folds before it comes to the link, or ends pinched
    """
    checked(load, twist_ratio, link, rest_curvature)
    if start is Start.LOBES and link < 0:
        right = rod_film(start, load, twist_ratio, -link, rest_curvature, tell)
        return right.mirrored()
    values = {"load": load, "twist_ratio": twist_ratio, "link": link}
    if start is Start.DISK:
        found = _flat_disk(values, rest_curvature)
    else:
        found = _straight_rod(start, values, tell)
    return _measured(curved(found, rest_curvature, tell) if rest_curvature else found)


def _straight_rod(start: Start, values: Mapping[str, float], tell: Tell) -> BranchPoint:
    """Return the film that a start leads to, with a rod that is straight by nature."""
    load, twist_ratio, link = values["load"], values["twist_ratio"], values["link"]
    if start is Start.LOBES and load <= BUCKLING:
        exist = f"lobes exist above {BUCKLING:.6g}, where the disk buckles"
        raise SpecError("load", f"found {load:g}; {exist}")
    path = films_by_writhe(load, tell=tell)
    if start is Start.LOBES and link == 0.0:
        return _with_rod(next(iter(path)), values)
    between = _between if start is Start.LOBES else _twisted_between
    return _with_rod(_located(*between(path, _Held(twist_ratio, link))), values)


def checked(
    load: float, twist_ratio: float, link: float, rest_curvature: float = 0.0
) -> None:
    """Raise SpecError for what is no number, or has no meaning."""
    if finite("load", load) == 0:
        raise SpecError("load", "found 0; should be above: no film shapes the loop then")
    if load > LARGEST_LOAD:
        raise SpecError("load", f"found {load:g}; should be at most {LARGEST_LOAD:g}")
    finite("twist_ratio", twist_ratio)
    if not math.isfinite(link):
        raise SpecError("link", f"found {link}; should be finite, positive or negative")
    if link != 0 and twist_ratio == 0:
        raise SpecError("link", "needs a twist ratio: twist that costs nothing is lost")
    if finite("rest_curvature", rest_curvature) != 0 and twist_ratio == 0:
        problem = "needs a twist ratio: a rod that twists for nothing turns as it likes"
        raise SpecError("rest_curvature", problem)


@dataclass(frozen=True)
class _Held:
    """What a film is looked for by: what holds it at its writhe.

    4 pi (C/B) Lk = 4 pi (C/B) Wr + M, which is M alone where twist costs nothing.
    """

    twist_ratio: float
    link: float

    @property
    def wanted(self) -> float:
        """What it is to be."""
        return 4 * math.pi * self.twist_ratio * self.link

    def __call__(self, point: BranchPoint) -> float:
        """Return what it is at a film of given writhe."""
        twist = smooth_family(point).twist(point.value)
        own = 4 * math.pi * self.twist_ratio * twist.writhe(point.x)
        return own + twist.moment(point.x)

    def said(self, value: float) -> str:
        """Return how a message says it."""
        if self.twist_ratio == 0:
            return f"the twisting moment {value:.4g}"
        return f"the link {value / (4 * math.pi * self.twist_ratio):.4g}"


def _between(points: Iterable[BranchPoint], held: _Held) -> Neighbours:
    """Return the neighbours between which a link that changes one way is the one wanted."""
    value = math.nan
    for before, after in pairwise(points):
        past, value = held(before), held(after)
        if min(past, value) <= held.wanted <= max(past, value):
            return before, after, held
        if abs(value - held.wanted) >= abs(past - held.wanted):
            raise NoFilmError(f"the branch folds near {held.said(past)}", "folds")
    closes = f"its waist is narrower than {NARROWEST:g} L beyond {held.said(value)}"
    raise NoFilmError(f"the film pinches: {closes}", "pinched")


def _twisted_between(path: Iterable[BranchPoint], held: _Held) -> Neighbours:
    """Return the same on the branch of the least twisted film of no link."""
    points = iter(path)
    # Flat lobes come first, which rounding alone holds.
    seen, unheld = list(islice(points, 2)), 0.0
    for point in points:
        unheld = held(seen[-1])
        if unheld * held(point) < 0:
            break
        seen.append(point)
    else:
        raise NoFilmError(_no_twisted(smooth_family(point), held), "absent")
    rises = held(point) > unheld
    if held.wanted == 0.0 or rises == (held.wanted > 0):
        return _between(chain([seen[-1], point], points), held)
    return _between(chain([point], reversed(seen)), held)


def _no_twisted(family: SmoothFamily, held: _Held) -> str:
    """Return what is said where no film but the flat ones has no link."""
    where = f"sigma_hat = {family.values['load']:g}, twist ratio {held.twist_ratio:g}"
    found = f"a rod that was not turned has no twisted film at {where}, to start from"
    return f"{found}: start from disk or lobes, or take a lower twist ratio"


def _located(before: BranchPoint, after: BranchPoint, held: _Held) -> BranchPoint:
    """Return the film between two neighbours that is held by what is wanted."""

    def at(value: float) -> BranchPoint:
        # From the nearer one: a neighbour may lie too far for Newton's method.
        nearest = min(before, after, key=lambda point: abs(point.value - value))
        found = ahead(nearest, value, CONTROL.least)
        if found is None:
            raise NoFilmError(f"Newton's method fails near the writhe {value:.4g}")
        return found

    def off(value: float) -> float:
        return held(at(value)) - held.wanted

    return at(zero_between(off, before.value, after.value, _FOUND))


def _with_rod(point: BranchPoint, values: Mapping[str, float]) -> BranchPoint:
    """Return the film next to a point, with its rod's own twist ratio and link."""
    found = point_near(
        SmoothFamily(smooth_family(point).basis, values), point.x, values["load"]
    )
    if found is None:
        problem = "Newton's method fails at the link asked for: the branch folds"
        raise NoFilmError(problem, "folds")
    return resolved(found, CONTROL)


def _flat_disk(values: Mapping[str, float], rest_curvature: float) -> BranchPoint:
    """Return the disk, which is in equilibrium at every load and link.

    All modes n that yield are held: m = (C/B) |Lk| and nu = sigma_hat / 16 pi^3 leave
    stable those of n > sqrt(nu) + m + 1, as (n^2 - 1 - nu) (1 - nu / (n (n + 1))) > m^2
    there. Of a rod curved by nature those of q (q + g) > q + g n^2 yield, g = C/B.

    Raises NoFilmError where they are too many to count.
    """
    load, ratio = values["load"], values["twist_ratio"]
    modes = math.sqrt(load / (16 * math.pi**3)) + ratio * abs(values["link"])
    if rest_curvature:
        modes += math.sqrt(rest_curvature * (rest_curvature + ratio) / ratio)
    if modes > _MOST_MODES:
        problem = f"its unstable modes may have up to {modes:.3g} waves, of which"
        raise NoFilmError(f"{problem} {_MOST_MODES} are counted", "unresolved")
    basis = make_basis(_ROUND_HARMONICS + math.ceil(modes), TWISTED)
    family = SmoothFamily(basis, values)
    flat = family.unknowns.x(disk(basis, load).coefficients)
    return first_point(family, flat, load, CONTROL)


def _measured(point: BranchPoint) -> RodFilm:
    """Return the film of a point, with all its numbers."""
    family = smooth_family(point)
    film, twist = family.film(point), family.twist(point.value)
    return RodFilm(
        film=film,
        twist_ratio=twist.ratio,
        link=twist.link,
        energy=film.energy + twist.energy(point.x),
        twist_energy=twist.twist_energy(point.x),
        writhe=twist.writhe(point.x),
        twist_moment=twist.moment(point.x),
        n_unstable=family.in_space(point).n_unstable,
        tail=family.tail(point.x),
    )
