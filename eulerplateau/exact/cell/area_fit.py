"""Contractility and bending rigidity of round cells, from areas over stiffnesses.

The areas pi R^2 of `cell_radius` are fitted by least squares in log sigma, log alpha and,
unless it is given, log R_0. Intervals are those of the profile likelihood: a value belongs
to it if the sum of squares, lowest over the other parameters, is at most
q^2 s^2 above its minimum. With known errors s = 1 and q^2 is the quantile of chi^2 with
one degree of freedom; otherwise s^2 is the sum over the n - p degrees of freedom, and q is
Student's quantile for these.

Multiplying all areas by a factor multiplies R_0 by its root and alpha by its 3/2th power
and leaves sigma and alpha / R_0^3 alone: those are told by ratios of areas only.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import exp, inf, isfinite, nan, pi, sqrt

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import ndtri, stdtrit

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError
from eulerplateau.exact.cell.area_model import AreaModel, areas
from eulerplateau.exact.estimates import Estimate as Estimate
from eulerplateau.exact.profiles import Minimum, Profile, lowest

# A parameter whose factor e moves all areas by less than this part of their errors has no
# say in the curve's own error.
_UNFELT = 1e-3


@dataclass(frozen=True)
class AreaFit:
    """What areas over stiffnesses say of cells, in the units of the data.

    `level` is that of the intervals. `noise` is the standard deviation of an area,
    estimated from the residuals; a share of the area where `relative`, None where the
    errors were given. `chi2` is the weighted sum of squares, None where the noise is
    estimated and it would say nothing; `dof` the points less the parameters fitted.
    `xi` is (alpha / sigma)^(1/3), the radius on a substrate without stiffness.

    `logarithms` (3,) are those of sigma, alpha and R_0, and `covariance` (3, 3) theirs to
    first order: without what the data do not determine at all.
    """

    sigma: Estimate
    alpha: Estimate
    rest_radius: Estimate
    xi: float
    level: float
    noise: float | None
    relative: bool
    chi2: float | None
    dof: int
    logarithms: FloatArray = field(repr=False, compare=False)
    covariance: FloatArray = field(repr=False, compare=False)

    def __str__(self) -> str:
        how = f"noise {self.noise or 0:.3g}" + " of the area" * self.relative
        if self.chi2 is not None:
            how = f"chi2 {self.chi2:.4g}"
        return (
            f"sigma {self.sigma}, alpha {self.alpha}, R0 {self.rest_radius} "
            f"({100 * self.level:g} %), xi {self.xi:.4g}, {how}, dof {self.dof}"
        )

    def areas(self, stiffness: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Return the fitted areas (m,) and their standard errors (m,), to first order."""
        k = np.asarray(stiffness, dtype=np.float64)
        found, slopes = areas(k, self.logarithms[None])
        share = np.einsum("np,pq,nq->n", slopes[0], self.covariance, slopes[0])
        return found[0], found[0] * np.sqrt(np.maximum(share, 0.0))

    def quantile(self) -> float:
        """Return how many standard errors make an interval of the level."""
        tail = (1 + self.level) / 2
        known = self.chi2 is not None
        return float(ndtri(tail) if known else stdtrit(self.dof, tail))


def fit_areas(
    stiffness: ArrayLike,
    area: ArrayLike,
    error: ArrayLike | None = None,
    rest_radius: float | None = None,
    level: float = 0.95,
    *,
    relative: bool = False,
) -> AreaFit:
    """Fit sigma, alpha and, unless it is given, R_0 to areas (n,) at stiffnesses (n,).

    `error` (n,) are the areas' standard deviations. Without them the noise is estimated
    from the residuals: one standard deviation for all areas, or, with `relative`, one of
    their logarithms, a share of the area.

    Units are those of the data: with areas in um^2 and stiffnesses in nN/um, sigma is in
    nN/um, alpha in nN um^2 and R_0 in um. Raises SpecError if there are too few points, or
    values that are not finite and positive.
    """
    k, measured, errors = _columns(stiffness, area, error)
    _check_options(rest_radius, level, relative and error is not None)
    count = 2 if rest_radius is not None else 3
    _check_numbers(k, count, known=errors is not None)

    unit_k = float(np.exp(np.log(k).mean()))
    unit_area = float(np.exp(np.log(measured).mean()) / pi)
    unit_length = sqrt(unit_area)
    noise: FloatArray | None = np.ones(len(k))
    if errors is not None:
        noise = errors / unit_area
    elif relative:
        noise = None
    rest = None if rest_radius is None else float(rest_radius) / unit_length
    model = AreaModel(k / unit_k, measured / unit_area, noise, rest)

    best = lowest(model, model.starts(), model.box)
    dof = len(k) - count
    variance = 1.0 if errors is not None else best.cost / dof
    tail = (1 + level) / 2
    quantile = float(ndtri(tail) if errors is not None else stdtrit(dof, tail))
    ends = _intervals(model, best, quantile**2 * variance, count)

    values = _limits(model, best.theta)
    log_sigma, log_alpha = (values if np.isfinite(values[:2]).any() else best.theta)[:2]
    shift = np.log([unit_k, unit_k * unit_length**3, unit_length])
    values, ends = values + shift, ends + shift[:, None]
    sigma, alpha, rest_estimate = (
        Estimate(_exp(value), _exp(low), _exp(high))
        for value, (low, high) in zip(values, ends, strict=True)
    )
    if rest_radius is not None:
        rest_estimate = Estimate(*3 * (float(rest_radius),))
    felt = best.size > _UNFELT * sqrt(variance)
    spread = sqrt(variance) * (1.0 if relative else unit_area)
    return AreaFit(
        sigma,
        alpha,
        rest_estimate,
        xi=_exp((log_alpha - log_sigma) / 3) * unit_length,
        level=level,
        noise=spread if errors is None else None,
        relative=relative,
        chi2=None if errors is None else best.cost,
        dof=dof,
        logarithms=best.theta + shift,
        covariance=variance * best.spread * np.outer(felt, felt),
    )


def _intervals(model: AreaModel, best: Minimum, rise: float, count: int) -> FloatArray:
    """Return the ends (3, 2) of all intervals; those of a given R_0 are its own."""
    ends = np.repeat(best.theta[:, None], 2, axis=1)
    edges = model.edges
    anchor = np.clip(best.theta, edges.low, edges.high)
    profile = Profile(model, model.box, edges, anchor, best.cost)
    ends[:count] = profile.ends(list(range(count)), rise, best.spread, model.far_starts())
    return ends


def _limits(model: AreaModel, theta: FloatArray) -> FloatArray:
    """Return theta (3,), with infinities where a parameter went to a limit."""
    edges = model.edges
    found: FloatArray = np.where(theta < edges.low, -inf, theta)
    return np.where(theta > edges.high, inf, found)


def _exp(logarithm: float) -> float:
    return exp(logarithm) if logarithm < inf else inf


def _columns(
    stiffness: ArrayLike, area: ArrayLike, error: ArrayLike | None
) -> tuple[FloatArray, FloatArray, FloatArray | None]:
    """Return the columns (n,), all finite and positive; raises SpecError."""
    k = _positive("stiffness", stiffness)
    measured = _positive("area", area)
    errors = None if error is None else _positive("error", error)
    for name, column in (("area", measured), ("error", errors)):
        if column is not None and len(column) != len(k):
            raise SpecError(name, f"has {len(column)} values for {len(k)} stiffnesses")
    return k, measured, errors


def _positive(name: str, values: ArrayLike) -> FloatArray:
    try:
        column = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        column = np.asarray(nan)
    if column.ndim != 1:
        raise SpecError(name, "should be a list of numbers")
    for number, value in enumerate(column):
        if not (isfinite(value) and value > 0):
            raise SpecError(
                f"{name}[{number}]", f"found {value:g}; should be finite and positive"
            )
    return column


def _check_options(rest_radius: float | None, level: float, doubly: bool) -> None:
    if rest_radius is not None and not (isfinite(rest_radius) and rest_radius > 0):
        raise SpecError("rest_radius", f"found {rest_radius:g}; should be positive")
    if not 0 < level < 1:
        raise SpecError("level", f"found {level:g}; should lie between 0 and 1")
    if doubly:
        raise SpecError("relative", "is for noise to be estimated; errors are given")


def _check_numbers(stiffness: FloatArray, count: int, *, known: bool) -> None:
    """Raise SpecError unless so many parameters can be told from these stiffnesses."""
    given = "" if count == 3 else "; R_0 is given"
    need = count if known else count + 1
    if len(stiffness) < need:
        why = "" if known else " and an unknown noise"
        raise SpecError(
            "stiffness",
            f"found {len(stiffness)} points; {count} parameters{why} need {need}{given}",
        )
    different = len(np.unique(stiffness))
    if different < count:
        raise SpecError(
            "stiffness",
            f"found {different} different; {count} parameters need {count}{given}",
        )
