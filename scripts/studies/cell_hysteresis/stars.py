"""Stars as polygons: their tips cost a bending energy that depends on the edges."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.cell import star
from eulerplateau.loop import FreeBending, edges_of
from eulerplateau.mesh import polygon_area

_FINE = 4000


@dataclass(frozen=True)
class StarEnergy:
    """The energy of a star with protrusions, of m equal edges a side.

    Attributes
    ----------
    tips : float, bending of the vertices where protrusions turn back, N pi^2 / edge
    rest : float, bending of all others
    film : float
    turning : float, the sum of all exterior angles but those of tips
    side : float, the length of a side
    pull : float, -dE/dR of one tip's bending, with the adhesion at R: it pushes outwards
    """

    tips: float
    rest: float
    film: float
    turning: float
    side: float
    pull: float


def star_energy(adhesions: int, sigma_hat: float, edges: int) -> StarEnergy:
    """Return the energy of a star at sigma_hat, its tips at the adhesions."""
    x, side = star_polygon(adhesions, sigma_hat, edges)
    loop = edges_of(x)
    tips = edges * np.arange(adhesions)
    # A tip turns by pi to either side; in a star's it is to the left.
    turning = loop.turning.copy()
    turning[tips] = np.abs(turning[tips])
    bending = FreeBending(side / edges).energy(x)
    at_tips = float((turning[tips] ** 2 / loop.means[tips]).sum())
    others = float(np.delete(turning, tips).sum())
    # A side is longer by 2 for each unit that both its adhesions are further out.
    pull = at_tips / adhesions * 2 / side
    area = abs(polygon_area(x))
    return StarEnergy(at_tips, bending - at_tips, sigma_hat * area, others, side, pull)


def star_polygon(adhesions: int, sigma_hat: float, edges: int) -> tuple[FloatArray, float]:
    """Return a star of so many equal edges a side (n, 2), and the length of a side."""
    found = star(adhesions)
    half = found.half_side(_FINE) * sigma_hat ** (-1 / 3)
    cusp = half[-1]
    protrusion = cusp / np.hypot(*cusp)
    right = np.vstack([half, protrusion])
    left = right[:0:-1] * [-1.0, 1.0]
    curve = np.vstack([left, right])
    lengths = np.append(0.0, np.cumsum(np.hypot(*np.diff(curve, axis=0).T)))
    places = np.linspace(0, lengths[-1], edges + 1)[:-1]
    one = [np.interp(places, lengths, column) for column in curve.T]
    side = one[0] + 1j * one[1]
    turns = np.exp(2j * np.pi * np.arange(adhesions) / adhesions)
    whole = (turns[:, None] * side).ravel()
    return np.stack([whole.real, whole.imag], axis=-1), float(lengths[-1])
