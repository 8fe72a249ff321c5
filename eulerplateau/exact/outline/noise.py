"""Noise that is alike from point to point along an outline, by what a fit leaves.

The distances of neighbouring points from a fitted curve err alike: a camera's distortion, a
blurred edge, a hand. The model is white noise and noise that forgets by exp(-distance along
the loop / length); its three numbers are those of the greatest restricted likelihood, which
allows for what the fit itself has taken out of the distances. Errors of a least-squares fit
follow from it by (J'J)^-1 J'SJ (J'J)^-1, S being the covariance of the distances.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve, qr
from scipy.optimize import minimize

from eulerplateau.arrays import FloatArray

# Successive points are taken together: what varies more slowly than these is what counts.
_GROUPS = 240
# Correlation lengths tried, over the spacing of the groups and the loop's length.
_SHORTEST, _LONGEST, _LENGTHS = 0.7, 0.3, 9
_SHARES = (0.02, 0.2, 0.5, 0.8, 0.98)


@dataclass(frozen=True)
class Noise:
    """What is known of an outline's noise.

    Attributes
    ----------
    deviation : float, of one point
    length : float, along the loop, over which the correlated part is forgotten
    correlated : float, the share of that part in the variance
    covariance : (p, p) of the fit's unknowns
    dof : float, effective degrees of freedom of the deviation
    """

    deviation: float
    length: float
    correlated: float
    covariance: FloatArray
    dof: float


def estimate(
    distances: FloatArray, slopes: FloatArray, t: FloatArray, period: float
) -> Noise:
    """Return the noise of distances (n,) with slopes (n, p) that least squares have left.

    `t` (n,) are arc lengths, in order round a loop of the length `period`; infinite for an
    open curve.
    """
    n = len(slopes)
    groups = np.array_split(np.arange(n), min(n, _GROUPS))
    count = np.array([len(group) for group in groups], dtype=np.float64)
    starts = np.array([group[0] for group in groups])
    r, where = (np.add.reduceat(values, starts) / count for values in (distances, t))
    j = np.add.reduceat(slopes, starts, axis=0) / count[:, None]
    apart = np.abs(where[:, None] - where)
    apart = np.minimum(apart, period - apart) if np.isfinite(period) else apart
    likely = _Likelihood(r, j, 1 / count, apart)
    share, length = likely.greatest()
    weighted = j * count[:, None]
    inverse = np.linalg.inv(slopes.T @ slopes)
    covariance = likely.covariance(share, length)
    scale = likely.scale(share, length)
    inner = weighted.T @ covariance @ weighted
    # What is left of noise of this kind by a fit: of the effective number of distances.
    root = np.sqrt(count)
    basis = qr(j * root[:, None], mode="economic")[0]
    seen = covariance * np.outer(root, root)
    seen -= basis @ (basis.T @ seen)
    dof = float(np.trace(seen) ** 2 / (seen * seen.T).sum())
    return Noise(
        deviation=float(np.sqrt(scale)),
        length=length,
        correlated=share,
        covariance=scale * inverse @ inner @ inverse,
        dof=max(dof, 1.0),
    )


@dataclass(frozen=True)
class _Likelihood:
    """The restricted likelihood of means of distances.

    `white` (m,) is the variance of a mean of white noise of variance 1, `apart` (m, m) how
    far the means lie from each other along the loop.
    """

    r: FloatArray
    j: FloatArray
    white: FloatArray
    apart: FloatArray

    def covariance(self, share: float, length: float) -> FloatArray:
        """Return the covariance (m, m) of means where one distance has the variance 1."""
        found = share * np.exp(-self.apart / length)
        found[np.diag_indices_from(found)] += (1 - share) * self.white
        return found

    def scale(self, share: float, length: float) -> float:
        """Return the likeliest variance of one distance."""
        return self._parts(share, length)[0]

    def greatest(self) -> tuple[float, float]:
        """Return the likeliest share of correlated noise, and its length."""
        spacing = np.sort(self.apart, axis=1)[:, 1].mean()
        shortest, longest = _SHORTEST * spacing, _LONGEST * self.apart.max() * 2
        lengths = np.geomspace(shortest, max(longest, 2 * shortest), _LENGTHS)
        tried = [(self._cost(s, x), s, x) for s in _SHARES for x in lengths]
        _, share, length = min(tried)

        def cost(unknowns: FloatArray) -> float:
            return self._cost(float(unknowns[0]), float(np.exp(unknowns[1])))

        bounds = [(0.0, 1 - 1e-6), tuple(np.log(lengths[[0, -1]]))]
        best = minimize(
            cost, [share, np.log(length)], method="L-BFGS-B", bounds=bounds,
            options={"maxiter": 20},
        )  # fmt: skip
        return float(best.x[0]), float(np.exp(best.x[1]))

    def _cost(self, share: float, length: float) -> float:
        """Return minus twice the logarithm of the restricted likelihood."""
        variance, logarithms = self._parts(share, length)
        left = len(self.r) - self.j.shape[1]
        return float(left * np.log(max(variance, np.finfo(float).tiny)) + logarithms)

    def _parts(self, share: float, length: float) -> tuple[float, float]:
        factor, _ = cho_factor(self.covariance(share, length), lower=True)
        r, j = (cho_solve((factor, True), values) for values in (self.r, self.j))
        normal = self.j.T @ j
        left = self.r @ r - (self.j.T @ r) @ np.linalg.solve(normal, self.j.T @ r)
        logarithms = 2 * np.log(np.diag(factor)).sum() + np.linalg.slogdet(normal)[1]
        return float(left) / (len(self.r) - self.j.shape[1]), float(logarithms)
