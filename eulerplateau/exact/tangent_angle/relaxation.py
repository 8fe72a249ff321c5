"""The film of least energy in its plane downhill from a start, without contact.

It is found by the tangent angle of a loop with n lobes alike, theta(s) = pi/2 + 2 pi s +
phi(s), phi(s) = sum_k c_k sin(2 pi n k s): such a loop keeps its length and, for n >= 2,
closes, whatever its c_k; nothing is left to be held. In the plane the film is its loop's
area, which the Fourier coefficients of e^{i phi} give, with all derivatives (kernels.py).
Everything converges exponentially in the number of harmonics.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import ArrayLike

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError
from eulerplateau.exact.checks import finite, points, whole_number
from eulerplateau.exact.tangent_angle.kernels import MORE_POINTS, descend, waist
from eulerplateau.exact.tangent_angle.start_kernels import polygon_angle, project

# Part of a start's phi that may lack the symmetry, root mean squares; and radians that may
# in any case, so that a circle's rounding is none.
_ASYMMETRY, _ROUND = 1e-2, 1e-4


@dataclass(frozen=True, repr=False)
class PlaneLoop:
    """A loop of length 1 with its film, least in energy among those with its symmetry.

    Arc length s counts counter-clockwise from the tip of a lobe on the axis x > 0; the
    origin is the centre. Energies are in alpha/L, energy = bending + tension * area,
    tension = sigma_hat = sigma L^3 / alpha.

    Attributes
    ----------
    coefficients : (m,) float
        c_k, by which theta(s) = pi/2 + 2 pi s + sum_k c_k sin(2 pi n k s).
    series : (2 P - 1,) float
        The Fourier coefficients a_l of e^{i phi}, the middle one being a_0.
    beta : float
        The multiplier of length, in 2 kappa'' + kappa^3 - beta kappa - tension = 0.
    waist : float
        The width left between the strands at a lobe's neck, where beyond its widest place
        they run along its axis; of two lobes always in the middle. Without a neck, the
        width of the lobe's end.
    residual : float
        The gradient of the energy in the norm in which the bending is |u|^2 / 2, over the
        root of the energy.
    steps : int
        Newton's steps from the start.
    """

    lobes: int
    coefficients: FloatArray
    series: FloatArray
    tension: float
    energy: float
    area: float
    bending: float
    beta: float
    waist: float
    residual: float
    steps: int

    def __repr__(self) -> str:
        numbers = (
            f"energy={self.energy:.10g}, area={self.area:.10g}, waist={self.waist:.6g}"
        )
        return f"PlaneLoop(lobes={self.lobes}, tension={self.tension:.10g}, {numbers})"

    def positions(self, s: ArrayLike) -> FloatArray:
        """Return the positions (..., 2) at the arc lengths s (...)."""
        last = len(self.series) // 2
        wave = 2 * pi * (1 + self.lobes * np.arange(-last, last + 1))
        angle = np.multiply.outer(np.asarray(s, dtype=np.float64), wave)
        each = self.series / wave
        return np.stack([np.cos(angle) @ each, np.sin(angle) @ each], axis=-1)

    def curvature(self, s: ArrayLike) -> FloatArray:
        """Return kappa (...) at the arc lengths s (...), > 0 where convex."""
        wave = 2 * pi * self.lobes * np.arange(1, len(self.coefficients) + 1)
        angle = np.multiply.outer(np.asarray(s, dtype=np.float64), wave)
        bends: FloatArray = np.cos(angle) @ (wave * self.coefficients)
        return 2 * pi + bends


def relax_in_plane(
    start: ArrayLike, tension: float, harmonics: int, lobes: int = 2
) -> PlaneLoop | None:
    """Return the film in its plane of least energy downhill from a start.

    It is a minimum among films with the start's symmetry, found by Newton's method
    (kernels.py). None if no minimum is reached, or if its strands cross, as they do beyond
    the tension of contact; `planar_film` has the films that touch.

    Parameters
    ----------
    start : (points, 2 or 3) float
        Vertices of a closed polygon, counter-clockwise, of any size and spacing, z = 0;
        more than two for each harmonic of each lobe. It has `lobes` lobes alike, each with
        a mirror, the first vertex at a tip on the axis x > 0, or between two lobes.
    tension : float
        sigma_hat = sigma L^3 / alpha, finite and not negative.
    harmonics : int
        m >= 1, of a lobe's tangent angle.
    lobes : int
        n >= 2.

    Raises
    ------
    SpecError
        For numbers out of range, and for a start that is no such polygon.
    """
    harmonics = whole_number("harmonics", harmonics, 1)
    lobes = whole_number("lobes", lobes, 2)
    tension = finite("tension", tension)
    c = _projected(_checked(start, 2 * lobes * harmonics), lobes, harmonics)
    half = harmonics + MORE_POINTS
    a = np.empty(2 * half + 4 * harmonics - 1)
    bending, area, residual, steps, found = descend(c, lobes, tension, a)
    if not found:
        return None
    if c[0] < 0.0:
        # The start counted from between two lobes: count from half a lobe further on.
        c[::2] *= -1
        a[half % 2 :: 2] *= -1
    width = waist(c, lobes, a)
    if not width > 0.0:
        return None
    return PlaneLoop(
        lobes=lobes,
        coefficients=c,
        series=a[2 * harmonics : -2 * harmonics],
        tension=tension,
        energy=bending + tension * area,
        area=area,
        bending=bending,
        beta=bending - 2 * tension * area,
        waist=width,
        residual=residual,
        steps=steps,
    )


def _checked(start: ArrayLike, fewest: int) -> FloatArray:
    """Return the vertices, contiguous, of a polygon in its plane; see relax_in_plane."""
    x = points("start", start, (2, 3))
    if len(x) <= fewest:
        should = f"should have more than {fewest}, two for each harmonic of each lobe"
        raise SpecError("start", f"found {len(x)} points; {should}")
    if x.shape[1] == 3 and x[:, 2].any():
        raise SpecError("start", "leaves the plane z = 0; should lie in it")
    return x


def _projected(x: FloatArray, lobes: int, harmonics: int) -> FloatArray:
    """Return the coefficients (harmonics,) of a polygon's angle, if it has the symmetry."""
    at, phi = np.empty(len(x) + 1), np.empty(len(x) + 1)
    shortest, turning = polygon_angle(x, at, phi)
    if not shortest > 0.0:
        raise SpecError("start", "has an edge of no length; all vertices should differ")
    if not abs(turning - 2 * pi) < 1.0:
        raise SpecError(
            "start",
            f"turns {turning / (2 * pi):.0f} times round; should once, counter-clockwise",
        )
    c = np.empty(harmonics)
    size, rest = project(at, phi, lobes, harmonics + MORE_POINTS, c)
    if not rest <= _ASYMMETRY * size + _ROUND:
        raise SpecError(
            "start",
            f"lacks a symmetry; should have {lobes} lobes alike, each with a mirror, the "
            "first point at a tip on the axis of x",
        )
    return c
