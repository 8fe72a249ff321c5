"""The exact planar film with n lobes at any tension, disk to line contact."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from math import pi

import numpy as np
from numpy.typing import ArrayLike

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.checks import checked_diameter, finite
from eulerplateau.exact.planar.buckled import buckled, excess
from eulerplateau.exact.planar.contact import (
    WIDEST,
    Touching,
    at_first_contact,
    at_line_contact,
    touching_at,
)
from eulerplateau.exact.planar.halves import (
    BuckledHalf,
    CircleHalf,
    HalfLobe,
    Points,
    TouchingHalf,
)
from eulerplateau.exact.planar.limits import checked_lobes
from eulerplateau.exact.planar.thickness import (
    TooThickError,
    is_too_thick,
)


class Regime(Enum):
    """What the n-lobed film looks like at a load."""

    DISK = "disk"
    BUCKLED = "buckled"
    POINT_CONTACT = "point-contact"
    LINE_CONTACT = "line-contact"

    @property
    def contact(self) -> str:
        """Where the loop touches itself: "free" (nowhere), in a "point", along a "line"."""
        return self.value.removesuffix("-contact") if self in _IN_CONTACT else "free"


_IN_CONTACT = (Regime.POINT_CONTACT, Regime.LINE_CONTACT)


@dataclass(frozen=True, repr=False)
class PlanarFilm:
    """The planar equilibrium with n lobes, loop of length 1. Energies in alpha/L.

    energy = tension * area + the integral of kappa^2 over the loop: no 1/2.
    The arc length t runs from 0 to 1 (outside, only the tangent angle is not periodic),
    counter-clockwise, from the tip of a lobe on the positive x axis; kappa > 0 where the
    loop is convex; the centre of symmetry is the origin.

    Attributes
    ----------
    lobes : int
        n.
    tension : float
        sigma_hat = sigma L^3 / alpha.
    area : float
        In L^2.
    kappa_max, kappa_min : float
        The loop's curvature at the lobes' tips, and where it is least; in 1/L.
    beta_hat : float
        The multiplier of length in 2 kappa'' + kappa^3 - beta_hat kappa - tension = 0.
    contact_length : float
        Length of the line along which each lobe's sides touch; 0 without line contact.
        Of two lobes the lines are one, twice as long.
    contact_force : float
        d energy / d diameter, in alpha/L^2: the sum over the contacts of the forces, each
        > 0, by which the strands push each other apart. Without contact 0.
    diameter : float
        Of the loop, in L; 0 for a loop without thickness. The film spans the centreline.
    half_lobe : HalfLobe
        The loop from a tip to the middle between two lobes.
    """

    lobes: int
    tension: float
    regime: Regime
    energy: float
    area: float
    kappa_max: float
    kappa_min: float
    beta_hat: float
    contact_length: float
    contact_force: float
    diameter: float
    half_lobe: HalfLobe

    def __repr__(self) -> str:
        numbers = f"energy={self.energy:.10g}, area={self.area:.10g}"
        return (
            f"PlanarFilm(lobes={self.lobes}, tension={self.tension:.10g}, "
            f"{self.regime.value}, {numbers})"
        )

    def curvature(self, t: ArrayLike) -> FloatArray:
        """Return kappa at the arc lengths `t`, any shape."""
        return self.points(t).kappa

    def tangent_angle(self, t: ArrayLike) -> FloatArray:
        """Return the tangent's angle with the x axis, pi/2 at t = 0, continuous in t."""
        return self.points(t).angle

    def positions(self, t: ArrayLike) -> FloatArray:
        """Return the positions (..., 2) at the arc lengths `t`."""
        return self.points(t).x

    def points(self, t: ArrayLike) -> Points:
        """Return curvature, tangent angle and positions at the arc lengths `t`."""
        t = np.asarray(t, dtype=np.float64)
        shape, t = t.shape, t.ravel()
        lobe = np.floor(t * self.lobes + 0.5)
        s = t - lobe / self.lobes
        side = np.where(s < 0, -1.0, 1.0)
        half = self.half_lobe.at(np.minimum(np.abs(s), 1 / (2 * self.lobes)))
        turned = 2 * pi * lobe / self.lobes
        angle = pi / 2 + turned + side * (half.angle - pi / 2)
        x, y = half.x[..., 0], side * half.x[..., 1]
        cosine, sine = np.cos(turned), np.sin(turned)
        position = np.stack([cosine * x - sine * y, sine * x + cosine * y], -1)
        return Points(
            half.kappa.reshape(shape), angle.reshape(shape), position.reshape(*shape, 2)
        )


def planar_film(lobes: int, tension: float, diameter: float | None = None) -> PlanarFilm:
    """Return the planar equilibrium with n lobes, by elliptic functions (docs/planar.md).

    Up to the buckling threshold that is the disk; beyond the contact threshold the loop
    touches itself. Correct to about 13 digits.

    Parameters
    ----------
    lobes : int
        n, from 2 to 12.
    tension : float
        sigma_hat = sigma L^3 / alpha, finite and not negative.
    diameter : float, optional
        That of the loop, in L, above 0 and at most 0.1; by default it has no thickness.

    Returns
    -------
    PlanarFilm
        Its loop has length 1, its energies are in alpha/L.

    Raises
    ------
    SpecError
        If an argument is no such number.
    TooThickError
        If the loop's curvature would exceed 2/d.
    """
    lobes, tension = checked_lobes(lobes), finite("tension", tension)
    diameter = 0.0 if diameter is None else checked_diameter(diameter)
    film = _film(lobes, tension, diameter)
    if is_too_thick(film.kappa_max, film.kappa_min, diameter):
        sharpest = max(film.kappa_max, -film.kappa_min)
        raise _too_thick(diameter, f"its curvature is {sharpest:.6g}")
    return film


def _film(lobes: int, tension: float, diameter: float) -> PlanarFilm:
    """Return the film, however sharply its loop is bent."""
    if excess(lobes, tension) <= 0:
        return _disk(lobes, tension, diameter)
    width = diameter * tension ** (1 / 3)
    if tension < at_first_contact(lobes, min(width, WIDEST)).lobe.sigma:
        return _buckled(lobes, tension, diameter)
    if width > WIDEST:
        raise _too_thick(diameter, "its curvature would be larger, were it to touch itself")
    opening = at_line_contact(lobes, width)
    if tension < opening.lobe.sigma:
        parts = touching_at(lobes, tension, width)
        return _touching(lobes, tension, diameter, Regime.POINT_CONTACT, parts)
    parts = opening.scaled((opening.lobe.sigma / tension) ** (1 / 3))
    return _touching(lobes, tension, diameter, Regime.LINE_CONTACT, parts)


def _too_thick(diameter: float, why: str) -> TooThickError:
    limit = f"a loop of diameter {diameter:g} L bends to 2/d = {2 / diameter:g} / L at most"
    return TooThickError(f"too_thick: {limit}; {why}", "too_thick")


def _disk(lobes: int, tension: float, diameter: float) -> PlanarFilm:
    area, kappa = 1 / (4 * pi), 2 * pi
    return PlanarFilm(
        lobes=lobes,
        tension=tension,
        regime=Regime.DISK,
        energy=tension * area + kappa**2,
        area=area,
        kappa_max=kappa,
        kappa_min=kappa,
        beta_hat=kappa**2 - tension / kappa,
        contact_length=0.0,
        contact_force=0.0,
        diameter=diameter,
        half_lobe=CircleHalf(lobes),
    )


def _buckled(lobes: int, tension: float, diameter: float) -> PlanarFilm:
    lobe = at_first_contact(lobes).lobe
    shape = buckled(lobes, tension, 0.9 * lobe.imaginary2 / lobe.mean**2)
    energy = 2 * lobes * shape.energy(shape.half_period)
    return PlanarFilm(
        lobes=lobes,
        tension=tension,
        regime=Regime.BUCKLED,
        energy=energy,
        area=(energy - shape.beta) / (3 * tension),
        kappa_max=shape.mean + shape.amplitude,
        kappa_min=shape.mean - shape.amplitude,
        beta_hat=shape.beta,
        contact_length=0.0,
        contact_force=0.0,
        diameter=diameter,
        half_lobe=BuckledHalf(lobes, shape),
    )


def _curved_energy(lobes: int, parts: Touching) -> float:
    lobe, neck = parts.lobe, parts.neck
    energy = lobe.energy(parts.lobe_length)
    if neck is not None:
        inner = neck.half_period - parts.neck_length
        energy += neck.energy(neck.half_period) - neck.energy(inner)
    return 2 * lobes * float(energy)


def _touching(
    lobes: int, tension: float, diameter: float, regime: Regime, parts: Touching
) -> PlanarFilm:
    """Return the film with the given curved parts and lines between them."""
    curved = parts
    growth, beta, line = 1.0, parts.lobe.beta, 0.0
    if regime is Regime.LINE_CONTACT:
        beta = 0.0 - tension * diameter / 2
        line = 1 / (2 * lobes) - parts.lobe_length - parts.neck_length
        # One shape of every size: products of a tiny one's numbers would overflow.
        curved = at_line_contact(lobes, diameter * tension ** (1 / 3))
        growth = (tension / curved.lobe.sigma) ** (1 / 3)
    # Along a line the strands push against the film's tension, at its ends as in a point.
    force = lobes * (growth**2 * curved.shear_jump + tension * line)
    energy = growth * _curved_energy(lobes, curved)
    energy += (force + lobes * tension * line) * diameter / 2
    return PlanarFilm(
        lobes=lobes,
        tension=tension,
        regime=regime,
        energy=energy,
        area=(energy - beta + force * diameter) / (3 * tension),
        kappa_max=parts.kappa_max,
        kappa_min=parts.kappa_min,
        beta_hat=beta,
        contact_length=line,
        contact_force=force,
        diameter=diameter,
        half_lobe=TouchingHalf(lobes, parts, line),
    )
