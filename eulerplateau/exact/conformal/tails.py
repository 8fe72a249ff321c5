"""What a corner in a derivative leaves in a Fourier series: tails that fall as powers of k.

Where derivatives of a function of some order jump, or grow as a logarithm, its coefficients
of large k are sums of powers, a_p / k^p. All of such a series from harmonic v on is

    T_p(phi) = sum over k >= v of k^-p exp(i k phi),

whose derivative by phi is i T_(p-1). Near phi = 0 it is the sum of a series (Lerch;
Erdelyi et al. 1953, 1.11(8) and (9)); elsewhere an integral, smooth and soon done,

    T_p = exp(i v phi) / Gamma(p) int t^(p-1) exp(-v t) / (1 - exp(i phi - t)) dt, t > 0.
"""

from __future__ import annotations

from math import factorial, pi

import numpy as np
from scipy.special import bernoulli, digamma, gamma, poch, roots_genlaguerre

from eulerplateau.arrays import FloatArray

# v |phi| up to which the series is taken, and how many of its terms.
_NEAR, _TERMS = 6.0, 60
# The least angle.
_BEHIND = 1e-17
# Points of Gauss's and Laguerre's rule.
_POINTS = 60
# Terms of Euler's and Maclaurin's sum.
_EVEN = np.arange(2, 22, 2)
_SHARES = bernoulli(int(_EVEN[-1]))[_EVEN] / gamma(_EVEN + 1.0)


def tail(p: float, v: int, phi: FloatArray) -> np.ndarray:
    """Return v^p T_p (n,) of p >= 1 at phi (n,), at 0 as just behind it; v at least 10."""
    turned = phi - 2 * pi * np.round(phi / (2 * pi))
    turned[turned == 0] = _BEHIND
    near = v * np.abs(turned) < _NEAR
    found = np.empty(len(phi), dtype=complex)
    found[near] = _series(p, v, turned[near])
    found[~near] = _integral(p, v, turned[~near])
    return found


def _series(p: float, v: int, phi: FloatArray) -> np.ndarray:
    """Return v^p T_p by powers of phi, not 0."""
    mu = 1j * v * phi
    if p == round(p):
        n = round(p)
        logarithm = digamma(n) - digamma(v) - np.log(-mu / v)
        found = v * logarithm * mu ** (n - 1) / factorial(n - 1)
    else:
        found = v * gamma(1 - p) * (-mu) ** (p - 1)
    for j in range(_TERMS):
        if j != p - 1:
            found = found + _zeta(p - j, v) * mu**j / factorial(j)
    return np.asarray(found)


def _zeta(s: float, v: int) -> float:
    """Return v^s times Hurwitz's zeta function of any s but 1, by Euler and Maclaurin."""
    terms = _SHARES * poch(s, _EVEN - 1) / float(v) ** (_EVEN - 1)
    return float(v / (s - 1) + 0.5 + terms.sum())


def _integral(p: float, v: int, phi: FloatArray) -> np.ndarray:
    """Return v^p T_p by the rule that is exact for polynomials times t^(p-1) exp(-t)."""
    t, weights = roots_genlaguerre(_POINTS, p - 1)
    kernel = 1 / (1 - np.exp(1j * phi[:, None] - t / v))
    return np.asarray(np.exp(1j * v * phi) / gamma(p) * (kernel @ weights))
