"""The exact planar film with n lobes at any tension, disk to line contact."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from functools import cache
from math import pi

import numpy as np
from numpy.typing import ArrayLike

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.checks import finite, whole_number
from eulerplateau.exact.planar.buckled import buckled, excess, sigma_buckling
from eulerplateau.exact.planar.contact import (
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

LOBES = range(2, 13)


class Regime(Enum):
    """What the n-lobed film looks like at a load."""

    DISK = "disk"
    BUCKLED = "buckled"
    POINT_CONTACT = "point-contact"
    LINE_CONTACT = "line-contact"


@dataclass(frozen=True)
class Thresholds:
    """The loads sigma L^3 / alpha at which the n-lobed film changes its regime."""

    lobes: int
    sigma_buckling: float
    sigma_contact: float
    sigma_line_contact: float


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


def thresholds(lobes: int) -> Thresholds:
    """Return the thresholds of the film with n lobes (paper, tab:contact).

    Parameters
    ----------
    lobes : int
        n, from 2 to 12.

    Returns
    -------
    Thresholds
        Tensions sigma L^3 / alpha, to 12 digits or more.

    Raises
    ------
    SpecError
        If `lobes` is no such number.
    """
    return _thresholds(_checked_lobes(lobes))


def planar_film(lobes: int, tension: float) -> PlanarFilm:
    """Return the planar equilibrium with n lobes, by elliptic functions (docs/planar.md).

    Up to the buckling threshold that is the disk; beyond the contact threshold the loop
    touches itself. Correct to about 13 digits.

    Parameters
    ----------
    lobes : int
        n, from 2 to 12.
    tension : float
        sigma_hat = sigma L^3 / alpha, finite and not negative.

    Returns
    -------
    PlanarFilm
        Its loop has length 1, its energies are in alpha/L.

    Raises
    ------
    SpecError
        If an argument is no such number.
    """
    lobes, tension = _checked_lobes(lobes), finite("tension", tension)
    limits = _thresholds(lobes)
    if excess(lobes, tension) <= 0:
        return _disk(lobes, tension)
    if tension < limits.sigma_contact:
        return _buckled(lobes, tension)
    if tension < limits.sigma_line_contact:
        return _touching(lobes, tension, Regime.POINT_CONTACT, touching_at(lobes, tension))
    size = (limits.sigma_line_contact / tension) ** (1 / 3)
    parts = at_line_contact(lobes).scaled(size)
    return _touching(lobes, tension, Regime.LINE_CONTACT, parts)


@cache
def _thresholds(lobes: int) -> Thresholds:
    contact = at_first_contact(lobes).lobe.sigma
    return Thresholds(
        lobes, sigma_buckling(lobes), contact, at_line_contact(lobes).lobe.sigma
    )


def _checked_lobes(lobes: int) -> int:
    return whole_number("lobes", lobes, LOBES[0], LOBES[-1])


def _disk(lobes: int, tension: float) -> PlanarFilm:
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
        half_lobe=CircleHalf(lobes),
    )


def _buckled(lobes: int, tension: float) -> PlanarFilm:
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
        half_lobe=BuckledHalf(lobes, shape),
    )


def _curved_energy(lobes: int, parts: Touching) -> float:
    lobe, neck = parts.lobe, parts.neck
    energy = lobe.energy(parts.lobe_length)
    if neck is not None:
        inner = neck.half_period - parts.neck_length
        energy += neck.energy(neck.half_period) - neck.energy(inner)
    return 2 * lobes * float(energy)


def _touching(lobes: int, tension: float, regime: Regime, parts: Touching) -> PlanarFilm:
    """Return the film with the given curved parts and lines between them."""
    lobe, neck = parts.lobe, parts.neck
    lowest = lobe.mean - lobe.amplitude
    if parts.lobe_length < lobe.half_period:
        lowest = float(lobe.curvature(parts.lobe_length))
    if neck is not None:
        lowest = min(lowest, neck.mean - neck.amplitude)
    energy, beta, line = _curved_energy(lobes, parts), lobe.beta, 0.0
    if regime is Regime.LINE_CONTACT:
        beta, line = 0.0, 1 / (2 * lobes) - parts.lobe_length - parts.neck_length
        # One shape of every size: products of a tiny one's numbers would overflow.
        alike = at_line_contact(lobes)
        growth = (tension / alike.lobe.sigma) ** (1 / 3)
        energy = growth * _curved_energy(lobes, alike)
    return PlanarFilm(
        lobes=lobes,
        tension=tension,
        regime=regime,
        energy=energy,
        area=(energy - beta) / (3 * tension),
        kappa_max=lobe.mean + lobe.amplitude,
        kappa_min=lowest,
        beta_hat=beta,
        contact_length=line,
        half_lobe=TouchingHalf(lobes, parts, line),
    )
