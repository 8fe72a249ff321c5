"""Planar films: the equilibria with n lobes at any surface tension."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from functools import cache
from math import isfinite, pi
from operator import index

import numpy as np
from numpy.typing import ArrayLike

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError
from eulerplateau.exact.planar.buckled import buckled, excess, sigma_buckling
from eulerplateau.exact.planar.contact import (
    Touching,
    at_line_contact,
    first_contact_phase,
    touching,
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

    n: int
    sigma_buckling: float
    sigma_contact: float
    sigma_line_contact: float


@dataclass(frozen=True)
class PlanarFilm:
    """The planar equilibrium with n lobes, loop of length 1. Energies in alpha/L.

    energy = sigma_hat * area + the integral of kappa^2 over the loop: no 1/2.
    The arc length t runs from 0 to 1 (outside, only the tangent angle is not periodic),
    counter-clockwise, from the tip of a lobe on the positive x axis; kappa > 0 where the
    loop is convex; the centre of symmetry is the origin.

    Attributes
    ----------
    beta_hat :
        The multiplier of length in 2 kappa'' + kappa^3 - beta_hat kappa - sigma_hat = 0.
    contact_length :
        Length of the line along which each lobe's sides touch.
    """

    n: int
    sigma_hat: float
    regime: Regime
    energy: float
    area: float
    kappa_max: float
    kappa_min: float
    beta_hat: float
    contact_length: float
    half_lobe: HalfLobe

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
        lobe = np.floor(t * self.n + 0.5)
        s = t - lobe / self.n
        side = np.where(s < 0, -1.0, 1.0)
        half = self.half_lobe.at(np.minimum(np.abs(s), 1 / (2 * self.n)))
        turned = 2 * pi * lobe / self.n
        angle = pi / 2 + turned + side * (half.angle - pi / 2)
        x, y = half.x[..., 0], side * half.x[..., 1]
        cosine, sine = np.cos(turned), np.sin(turned)
        position = np.stack([cosine * x - sine * y, sine * x + cosine * y], -1)
        return Points(
            half.kappa.reshape(shape), angle.reshape(shape), position.reshape(*shape, 2)
        )


def thresholds(n: int) -> Thresholds:
    """Return the thresholds of the n-lobed film (paper, tab:contact, to 12 digits or more).

    Raises SpecError if n is not one of 2 ... 12.
    """
    return _thresholds(_checked_lobes(n))


def planar_film(n: int, sigma_hat: float) -> PlanarFilm:
    """Return the planar equilibrium with n lobes at sigma_hat = sigma L^3 / alpha.

    Up to the buckling threshold that is the disk. Raises SpecError if n is not one of
    2 ... 12 or sigma_hat is negative or not finite.
    """
    n, sigma_hat = _checked_lobes(n), float(sigma_hat)
    if not (isfinite(sigma_hat) and sigma_hat >= 0):
        raise SpecError(
            "sigma_hat", f"found {sigma_hat}; should be finite and not negative"
        )
    limits = _thresholds(n)
    if excess(n, sigma_hat) <= 0:
        return _disk(n, sigma_hat)
    if sigma_hat < limits.sigma_contact:
        return _buckled(n, sigma_hat)
    if sigma_hat < limits.sigma_line_contact:
        return _touching(n, sigma_hat, Regime.POINT_CONTACT, touching_at(n, sigma_hat))
    size = (limits.sigma_line_contact / sigma_hat) ** (1 / 3)
    parts = at_line_contact(n).scaled(size)
    return _touching(n, sigma_hat, Regime.LINE_CONTACT, parts)


@cache
def _thresholds(n: int) -> Thresholds:
    contact = touching(n, first_contact_phase(n)).lobe.sigma
    return Thresholds(n, sigma_buckling(n), contact, at_line_contact(n).lobe.sigma)


def _checked_lobes(n: int) -> int:
    try:
        lobes = index(n)
    except TypeError:
        lobes = 0
    if lobes not in LOBES:
        raise SpecError("n", f"found {n!r}; should be a whole number from 2 to {LOBES[-1]}")
    return lobes


def _disk(n: int, sigma_hat: float) -> PlanarFilm:
    area, kappa = 1 / (4 * pi), 2 * pi
    return PlanarFilm(
        n=n,
        sigma_hat=sigma_hat,
        regime=Regime.DISK,
        energy=sigma_hat * area + kappa**2,
        area=area,
        kappa_max=kappa,
        kappa_min=kappa,
        beta_hat=kappa**2 - sigma_hat / kappa,
        contact_length=0.0,
        half_lobe=CircleHalf(n),
    )


def _buckled(n: int, sigma_hat: float) -> PlanarFilm:
    lobe = touching(n, first_contact_phase(n)).lobe
    shape = buckled(n, sigma_hat, 0.9 * lobe.imaginary2 / lobe.mean**2)
    energy = 2 * n * shape.energy(shape.half_period)
    return PlanarFilm(
        n=n,
        sigma_hat=sigma_hat,
        regime=Regime.BUCKLED,
        energy=energy,
        area=(energy - shape.beta) / (3 * sigma_hat),
        kappa_max=shape.mean + shape.amplitude,
        kappa_min=shape.mean - shape.amplitude,
        beta_hat=shape.beta,
        contact_length=0.0,
        half_lobe=BuckledHalf(n, shape),
    )


def _touching(n: int, sigma_hat: float, regime: Regime, parts: Touching) -> PlanarFilm:
    """Return the film with the given curved parts and lines between them."""
    lobe, neck = parts.lobe, parts.neck
    energy = 2 * n * lobe.energy(parts.lobe_length)
    lowest = lobe.mean - lobe.amplitude
    if parts.lobe_length < lobe.half_period:
        lowest = float(lobe.curvature(parts.lobe_length))
    if neck is not None:
        inner = neck.half_period - parts.neck_length
        energy += 2 * n * (neck.energy(neck.half_period) - neck.energy(inner))
        lowest = min(lowest, neck.mean - neck.amplitude)
    beta, line = lobe.beta, 0.0
    if regime is Regime.LINE_CONTACT:
        beta, line = 0.0, 1 / (2 * n) - parts.lobe_length - parts.neck_length
    return PlanarFilm(
        n=n,
        sigma_hat=sigma_hat,
        regime=regime,
        energy=energy,
        area=(energy - beta) / (3 * sigma_hat),
        kappa_max=lobe.mean + lobe.amplitude,
        kappa_min=lowest,
        beta_hat=beta,
        contact_length=line,
        half_lobe=TouchingHalf(n, parts, line),
    )
