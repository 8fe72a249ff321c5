"""A round cell on a continuous adhesion: its radius, over the substrate's stiffness.

The paper's energy (eq. cfm) without line tension, on a circle of radius R, with adhesions
of density rho = 1/L all along the perimeter L = 2 pi R, so that the springs add up to
k_s (R - R_0)^2 whatever L is:

    E(R) = pi sigma R^2 + 2 pi alpha / R + k_s (R - R_0)^2,
    R^2 E'(R) / 2 = (k_s + pi sigma) R^3 - k_s R_0 R^2 - pi alpha      (eq. radius).

The cubic has one positive root, by Descartes' rule, and E''(R) > 0 for all R > 0. Soft
substrates leave the cell at xi = (alpha / sigma)^(1/3), stiff ones hold it at R_0; in
between R rises with k_s if xi < R_0, and falls if xi > R_0.

Units: any consistent ones. With lengths in um and forces in nN, sigma and k_s are in
nN/um and alpha, the rigidity in alpha kappa^2 (without 1/2), is in nN um^2.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError

# From 1, Newton's method on the scaled cubic comes within rounding of any root in five.
_STEPS = 6


@dataclass(frozen=True)
class RadiusSlopes:
    """Derivatives of the radius, each of the arguments' common shape."""

    stiffness: FloatArray
    contractility: FloatArray
    bending: FloatArray
    rest_radius: FloatArray


def cell_radius(
    stiffness: ArrayLike,
    contractility: ArrayLike,
    bending: ArrayLike,
    rest_radius: ArrayLike = 1.0,
) -> FloatArray:
    """Return the radius R of a round cell, to rounding, of the arguments' common shape.

    `stiffness` is k_s, `contractility` sigma, `bending` alpha and `rest_radius` R_0 > 0.
    Each of the first three may be 0, as long as something holds the cell in (k_s or sigma)
    and something out (k_s or alpha); SpecError otherwise.
    """
    return cubic_root(*_checked(stiffness, contractility, bending, rest_radius))


def radius_slopes(
    stiffness: ArrayLike,
    contractility: ArrayLike,
    bending: ArrayLike,
    rest_radius: ArrayLike = 1.0,
) -> RadiusSlopes:
    """Return the derivatives of `cell_radius` by each of its arguments.

    By implicit differentiation of E'(R) = 0; all share E''(R) / 2. Takes what
    `cell_radius` takes.
    """
    k, sigma, alpha, rest = _checked(stiffness, contractility, bending, rest_radius)
    radius = cubic_root(k, sigma, alpha, rest)
    half_curvature = k + pi * sigma + 2 * pi * (alpha / radius / radius / radius)
    return RadiusSlopes(
        stiffness=(rest - radius) / half_curvature,
        contractility=-pi * radius / half_curvature,
        bending=pi / radius / radius / half_curvature,
        rest_radius=k / half_curvature,
    )


def interpolated_radius(
    stiffness: ArrayLike,
    contractility: ArrayLike,
    bending: ArrayLike,
    rest_radius: ArrayLike = 1.0,
) -> FloatArray:
    """Return the paper's formula (k_s R_0 + 3 pi sigma xi) / (k_s + 3 pi sigma) for R.

    It is never too large: it leaves the cubic at -pi sigma (R - xi)^2 (2 R + xi). At the
    soft end it is exact to first order in k_s, and about xi = R_0 to first order in
    xi - R_0. At the stiff end only the limit is right: R_0 - R falls off like
    pi sigma (R_0^3 - xi^3) / (k_s R_0^2), the formula like 3 pi sigma (R_0 - xi) / k_s.

    Takes what `cell_radius` takes, and sigma > 0.
    """
    k, sigma, alpha, rest = _checked(stiffness, contractility, bending, rest_radius)
    if not (sigma > 0).all():
        raise SpecError("contractility", "found 0; the formula needs xi, and so sigma > 0")
    xi = np.cbrt(alpha) / np.cbrt(sigma)
    free = 3 * pi * sigma
    radius: FloatArray = rest * (k / (k + free)) + xi * (free / (k + free))
    return radius


def cubic_root(
    k: FloatArray, sigma: FloatArray, alpha: FloatArray, rest: FloatArray
) -> FloatArray:
    """Return the cubic's positive root; the arguments broadcast and are not checked.

    With the roots it has for alpha = 0 and for R_0 = 0, R_k = k R_0 / (k + pi sigma) and
    R_c^3 = pi alpha / (k + pi sigma), the cubic is R - R_k - R_c^3 / R^2 = 0. Measured in
    the larger of the two, R lies in [1, 1.4656], where this is an increasing and concave
    function: Newton's method from 1 never goes too far. R grows more slowly than R_k and
    R_c, so that it is as exact as these. Neither over- nor underflows unless R does.
    """
    inward = k / pi + sigma
    share = np.sqrt(k / pi) / np.sqrt(inward)
    adhesive = share * rest * share
    elastic = np.cbrt(alpha) / np.cbrt(inward)
    unit = np.maximum(adhesive, elastic)
    low, cube = adhesive / unit, (elastic / unit) ** 3
    x = np.ones_like(unit)
    for _ in range(_STEPS):
        square = x * x
        x = x - (x - low - cube / square) / (1 + 2 * cube / (square * x))
    root: FloatArray = unit * x
    return root


def _checked(*arguments: ArrayLike) -> list[FloatArray]:
    """Return k_s, sigma, alpha and R_0 as arrays that go together; raises SpecError."""
    names = ("stiffness", "contractility", "bending", "rest_radius")
    given = []
    for name, argument in zip(names, arguments, strict=True):
        try:
            values = np.asarray(argument, dtype=np.float64)
        except (TypeError, ValueError):
            raise SpecError(name, "is no array of real numbers; should be one") from None
        wrong = ~(np.isfinite(values) & (values >= 0))
        if name == "rest_radius":
            wrong |= values == 0
        if wrong.any():
            wanted = "positive" if name == "rest_radius" else "not negative"
            raise SpecError(
                name, f"found {values[wrong][0]:g}; should be finite and {wanted}"
            )
        given.append(values)
    k, sigma, alpha, _ = given
    try:
        np.broadcast_shapes(*(values.shape for values in given))
    except ValueError:
        shapes = ", ".join(str(values.shape) for values in given)
        raise SpecError("stiffness", f"found shapes {shapes}; should go together") from None
    for name, values in (("contractility", sigma), ("bending", alpha)):
        if ((k == 0) & (values == 0)).any():
            raise SpecError(
                name, "found 0 where the stiffness is 0; one should be positive"
            )
    return given
