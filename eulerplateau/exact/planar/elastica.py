"""One solution of the planar shape equation, in Jacobi's elliptic functions.

Units of this subpackage: lengths L (the loop's), energies alpha/L, so that the curvature
kappa(s) of a free piece of the loop obeys (paper, eq. shape-equation-nodim, corrected)

    2 kappa'' + kappa^3 - beta kappa - sigma = 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import atan2, cos, sin, sqrt

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import ellipeinc, ellipj, ellipk, ellipkinc, elliprj

from eulerplateau.arrays import FloatArray


@dataclass(frozen=True)
class Elastica:
    """The solution whose curvature runs between `mean` -/+ `amplitude`.

    Multiplied by kappa' and integrated, the shape equation is

        (kappa')^2 = (k_max - kappa)(kappa - k_min)((kappa + mean)^2 + imaginary2) / 4:

    two real roots and, since no cubic term is there, a complex pair with real part -mean
    and imaginary part of square `imaginary2` > 0. These three numbers replace the paper's
    kappa_0, z_1, z_2: nothing cancels in what follows, however small the amplitude is.
    The arc length s is zero at a maximum of kappa, the tip of a lobe.
    """

    mean: float
    amplitude: float
    imaginary2: float

    @cached_property
    def sigma(self) -> float:
        """The surface tension."""
        return self.mean * (self.imaginary2 + self.amplitude**2) / 2

    @cached_property
    def beta(self) -> float:
        """The multiplier of the loop's length."""
        return self.mean**2 + (self.amplitude**2 - self.imaginary2) / 2

    @cached_property
    def _distances(self) -> tuple[float, float]:
        """Distances of the real roots k_max and k_min from the complex ones."""
        top, bottom = 2 * self.mean + self.amplitude, 2 * self.mean - self.amplitude
        return sqrt(top**2 + self.imaginary2), sqrt(bottom**2 + self.imaginary2)

    @cached_property
    def frequency(self) -> float:
        """The omega of eq. solution: kappa is a function of cn(omega s | m)."""
        return sqrt(self._distances[0] * self._distances[1]) / 2

    @cached_property
    def m(self) -> float:
        """The parameter m of the elliptic functions, the square of the modulus."""
        product = self._distances[0] * self._distances[1]
        rest = 4 * self.mean**2 + self.imaginary2 - self.amplitude**2
        if rest < 0:
            return (1 - rest / product) / 2
        # The same without cancellation at small amplitudes.
        return 2 * self.amplitude**2 * self.imaginary2 / (product * (product + rest))

    @cached_property
    def _skew(self) -> float:
        """The rho of kappa = mean + amplitude (cn - rho) / (1 - rho cn)."""
        top, bottom = self._distances
        return 8 * self.mean * self.amplitude / (top + bottom) ** 2

    @cached_property
    def half_period(self) -> float:
        """Arc length from a maximum of kappa to the next minimum, 2 K(m) / omega."""
        return 2 * float(ellipk(self.m)) / self.frequency

    @cached_property
    def half_turn(self) -> float:
        """The angle the tangent turns by from a maximum of kappa to the next minimum."""
        rest = 1 - self._skew**2
        even = 2 * float(elliprj(0.0, 1 - self.m, 1.0, 1 / rest))
        wave = -self._skew / (3 * rest) * even
        return self.mean * self.half_period + self.amplitude / self.frequency * wave

    def scaled(self, size: float) -> Elastica:
        """Return the similar solution `size` times as large (paper, eq. similarity)."""
        return Elastica(self.mean / size, self.amplitude / size, self.imaginary2 / size**2)

    def arc_length(self, phase: float) -> float:
        """Return s where kappa = mean + amplitude cos(phase), 0 <= phase <= 2 pi."""
        top, bottom = self._distances
        half = phase / 2
        amplitude = 2 * atan2(sqrt(bottom) * sin(half), sqrt(top) * cos(half))
        return float(ellipkinc(amplitude, self.m)) / self.frequency

    def curvature(self, s: ArrayLike) -> FloatArray:
        """Return kappa at the arc lengths `s`, any shape."""
        _, cn, _, _ = ellipj(self.frequency * np.asarray(s), self.m)
        wave = (cn - self._skew) / (1 - self._skew * cn)
        return np.asarray(self.mean + self.amplitude * wave)

    def slope(self, s: ArrayLike) -> FloatArray:
        """Return d kappa / ds at the arc lengths `s`."""
        sn, cn, dn, _ = ellipj(self.frequency * np.asarray(s), self.m)
        wave = (1 - self._skew**2) * sn * dn / (1 - self._skew * cn) ** 2
        return np.asarray(-self.amplitude * self.frequency * wave)

    def turning(self, s: ArrayLike) -> FloatArray:
        """Return the angle the tangent turns by from 0 to s, the integral of kappa.

        With rho^2 + rho'^2 = 1 and g^2 = rho'^2 m + rho^2, the integrand splits into
        mean, a part odd in cn, which is elementary, and one even in cn, of the third kind.
        """
        # One number as a number: arithmetic with arrays of one takes ten times as long.
        s = np.asarray(s, dtype=np.float64)[()]
        sn, cn, dn, _ = ellipj(self.frequency * s, self.m)
        skew2, rest = self._skew**2, 1 - self._skew**2
        g = sqrt(rest * self.m + skew2)
        odd = sqrt(rest) / g * np.arctan(g * sn / (dn * sqrt(rest)))
        # Carlson's R_J reaches from -K to K only: count the half periods before.
        half_periods = np.rint(s / self.half_period)
        inside = sn * (1 - 2 * (half_periods % 2))
        even = inside**3 * elliprj(cn**2, dn**2, 1.0, 1 + skew2 / rest * sn**2)
        even += 2 * half_periods * elliprj(0.0, 1 - self.m, 1.0, 1 / rest)
        wave = odd - self._skew / (3 * rest) * even
        return np.asarray(self.mean * s + self.amplitude / self.frequency * wave)

    def energy(self, s: float) -> float:
        """Return the integral of (3 kappa^2 - beta) / 2 from 0 to s.

        Summed over the loop this is the film's energy (docs/planar.md). The integral of
        kappa^2, which has double poles without residue, is of the second kind, and beta
        cancels.
        """
        sn, cn, dn, amplitude = ellipj(self.frequency * s, self.m)
        poles = self._skew * sn * dn / (1 - self._skew * cn)
        second_kind = float(ellipeinc(amplitude, self.m)) + float(poles)
        first_kind = (5 - 4 * self.m) * self.frequency * s
        return self.frequency * (6 * second_kind - first_kind)

    def position(self, s: ArrayLike, tangent_angle: FloatArray) -> FloatArray:
        """Return positions (..., 2) from the force's centre (eq. guven-parametrization).

        `tangent_angle` is the tangent's angle with the x axis at each s; the normal is the
        tangent turned by +pi/2, which points into the film.
        """
        along = 2 * self.slope(s) / self.sigma
        across = -(self.curvature(s) ** 2 - self.beta) / self.sigma
        cosine, sine = np.cos(tangent_angle), np.sin(tangent_angle)
        return np.stack(
            [along * cosine - across * sine, along * sine + across * cosine], -1
        )
