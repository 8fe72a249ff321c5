"""Cells fitted to areas: truth recovered, units, intervals, and what data leave open."""

from __future__ import annotations

from math import inf, pi

import numpy as np
import pytest
from scipy.optimize import brentq, least_squares

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError
from eulerplateau.exact.cell import AreaFit, cell_radius, fit_areas
from eulerplateau.exact.cell.area_model import AreaModel
from scripts.studies.cell_fit.coverage import CASES, Case, coverage
from tests.helpers.marks import quick_with

SIGMA, ALPHA, REST = 2.0, 700.0, 15.0
STIFFNESS = np.geomspace(0.3, 300.0, 9)
NAMES = ("sigma", "alpha", "rest_radius")
TRUTH = (SIGMA, ALPHA, REST)


def areas(
    sigma: float = SIGMA, alpha: float = ALPHA, rest: float = REST, noise: float = 0.0
) -> FloatArray:
    """Return areas, with Gaussian noise of a share of each area."""
    exact = pi * cell_radius(STIFFNESS, sigma, alpha, rest) ** 2
    draw = np.random.default_rng(7).standard_normal(len(STIFFNESS))
    noisy: FloatArray = exact * (1 + noise * draw)
    return noisy


def values(fit: AreaFit) -> list[float]:
    return [getattr(fit, name).value for name in NAMES]


def ends(fit: AreaFit) -> FloatArray:
    """Return low and high of every parameter (3, 2)."""
    return np.array([[getattr(fit, n).low, getattr(fit, n).high] for n in NAMES])


@pytest.mark.parametrize("rest_radius", [None, REST])
@pytest.mark.parametrize("relative", [False, True])
def test_without_noise_the_truth_is_recovered(
    rest_radius: float | None, relative: bool
) -> None:
    fit = fit_areas(STIFFNESS, areas(), rest_radius=rest_radius, relative=relative)
    assert values(fit) == pytest.approx(TRUTH, rel=1e-8)
    assert fit.xi == pytest.approx((ALPHA / SIGMA) ** (1 / 3), rel=1e-8)
    assert fit.areas(STIFFNESS)[0] == pytest.approx(areas(), rel=1e-8)


@pytest.mark.parametrize(
    "truth",
    [(0.05, 20.0, 10.0), (50.0, 1e4, 30.0), (1.0, 6e4, 20.0), (8.0, 8e3, 1e3)],
    ids=["weak", "strong", "shrinking", "far from its rest radius"],
)
def test_other_cells_are_recovered_too(truth: tuple[float, float, float]) -> None:
    errors = 1e-3 * areas(*truth)
    fit = fit_areas(STIFFNESS, areas(*truth), errors)
    assert values(fit) == pytest.approx(truth, rel=1e-8)
    assert fit.chi2 == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("kind", ["known", "constant", "relative"])
def test_other_units_give_the_same_fit_in_other_units(kind: str) -> None:
    lengths, forces = 1e-6, 1e-9  # um and nN in SI
    area = areas(noise=0.05)
    error = 0.05 * area if kind == "known" else None
    here = fit_areas(STIFFNESS, area, error, relative=kind == "relative")
    there = fit_areas(
        STIFFNESS * forces / lengths,
        area * lengths**2,
        None if error is None else error * lengths**2,
        relative=kind == "relative",
    )
    units = np.array([forces / lengths, forces * lengths**2, lengths])
    assert values(there) == pytest.approx(units * values(here), rel=1e-7)
    assert ends(there) == pytest.approx(units[:, None] * ends(here), rel=1e-5)
    assert there.xi == pytest.approx(here.xi * lengths, rel=1e-7)
    scales = {"known": 1.0, "constant": lengths**2, "relative": 1.0}
    chosen = "chi2" if kind == "known" else "noise"
    found = [getattr(fit, chosen) for fit in (here, there)]
    assert found[1] == pytest.approx(scales[kind] * found[0], rel=1e-9)


def test_derivatives_of_the_model_are_those_of_the_residuals() -> None:
    theta = np.log([[1.5, 1.0, 1.2], [0.2, 3.0, 0.8]])
    k, measured = STIFFNESS / 10, areas(noise=0.1) / 200
    for error in (None, np.full(len(k), 0.3)):
        model = AreaModel(k, measured, error, None)
        _, slopes = model(theta)
        for j in range(3):
            errors = []
            for step in (1e-2, 5e-3):
                shift = step * np.eye(3)[j]
                secant = (model(theta + shift)[0] - model(theta - shift)[0]) / (2 * step)
                errors.append(np.abs(secant - slopes[..., j]).max())
            assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.02)


def reference_end(
    residuals: object, best: FloatArray, j: int, outer: float, rise: float
) -> float:
    """Return where the profile of parameter j rises so far: scipy, one point at a time."""
    lowest = float((residuals(best) ** 2).sum())  # type: ignore[operator]

    def above(value: float) -> float:
        def rest(others: FloatArray) -> FloatArray:
            found: FloatArray = residuals(np.insert(others, j, value))  # type: ignore[operator]
            return found

        found = least_squares(rest, np.delete(best, j), xtol=1e-12, ftol=1e-12, gtol=1e-12)
        return float(2 * found.cost) - lowest - rise

    return float(brentq(above, best[j], outer, xtol=1e-9))


@pytest.mark.parametrize(
    "kind", quick_with(["constant"], ["known", "constant", "relative"])
)
def test_intervals_end_where_an_independent_profile_says(kind: str) -> None:
    area = areas(noise=0.08)
    error = 0.08 * areas() if kind == "known" else None
    level = 0.9
    fit = fit_areas(STIFFNESS, area, error, level=level, relative=kind == "relative")
    from scipy.stats import chi2, t  # which takes a second to import

    best = np.log(values(fit))

    def residuals(theta: FloatArray) -> FloatArray:
        model = pi * cell_radius(STIFFNESS, *np.exp(theta)) ** 2
        if kind == "relative":
            return np.asarray(np.log(model / area))
        return np.asarray((model - area) / (1.0 if error is None else error))

    rise = float(chi2.ppf(level, 1))
    if kind != "known":
        dof = len(area) - 3
        variance = float((residuals(best) ** 2).sum()) / dof
        rise = float(t.ppf((1 + level) / 2, dof)) ** 2 * variance
        assert fit.noise == pytest.approx(np.sqrt(variance), rel=1e-6)
    for j, pair in enumerate(np.log(ends(fit))):
        for end in pair:
            outer = best[j] + 1.5 * (end - best[j])
            found = reference_end(residuals, best, j, outer, rise)
            assert end - best[j] == pytest.approx(found - best[j], rel=1e-4)


def test_with_small_noise_the_profile_is_quadratic() -> None:
    """The interval tends to q standard errors either side, at first order in the noise."""
    gaps = []
    for noise in (1e-2, 1e-3, 1e-4):
        fit = fit_areas(STIFFNESS, areas(noise=noise), noise * areas())
        width = fit.quantile() * np.sqrt(np.diag(fit.covariance))
        wald = fit.logarithms[:, None] + np.outer(width, [-1.0, 1.0])
        gaps.append(np.abs((np.log(ends(fit)) - wald) / width[:, None]).max())
    orders = np.log10(np.divide(gaps[:-1], gaps[1:]))
    assert orders == pytest.approx([1.0, 1.0], abs=0.1)


def test_intervals_shrink_with_the_level_and_hold_the_value() -> None:
    wide, narrow = (fit_areas(STIFFNESS, areas(noise=0.05), level=x) for x in (0.99, 0.5))
    assert (ends(wide)[:, 0] < ends(narrow)[:, 0]).all()
    assert (ends(narrow)[:, 0] < values(narrow)).all()
    assert (ends(narrow)[:, 1] > values(narrow)).all()
    assert (ends(wide)[:, 1] > ends(narrow)[:, 1]).all()


def test_only_ratios_of_areas_tell_contractility() -> None:
    """The paper's data may be off by a factor, sigma and alpha / R_0^3 are not."""
    area = areas(noise=0.05)
    here, there = fit_areas(STIFFNESS, area), fit_areas(STIFFNESS, area / pi)
    assert there.sigma.value == pytest.approx(here.sigma.value, rel=1e-7)
    moduli = [fit.alpha.value / fit.rest_radius.value**3 for fit in (here, there)]
    assert moduli[1] == pytest.approx(moduli[0], rel=1e-7)


def test_data_without_bending_bound_it_from_above_only() -> None:
    stiff = np.geomspace(10.0, 1000.0, 9)
    area = pi * cell_radius(stiff, 5.0, 0.0, 20.0) ** 2
    alpha = fit_areas(stiff, area, 0.1 * area).alpha
    assert alpha.low == 0.0
    assert 0 < alpha.high < inf
    assert alpha.value < 1e-3 * alpha.high


def test_data_without_contraction_bound_it_from_above_only() -> None:
    area = pi * cell_radius(STIFFNESS, 0.0, 1e4, 20.0) ** 2
    sigma = fit_areas(STIFFNESS, area, 0.05 * area).sigma
    assert sigma.low == 0.0
    assert 0 < sigma.high < inf


def test_equal_areas_bound_nothing_but_say_how_large_cells_are() -> None:
    area = np.full(9, 500.0)
    fit = fit_areas(STIFFNESS, area, 0.05 * area)
    assert ends(fit).tolist() == [[0.0, inf]] * 3
    curve, error = fit.areas(STIFFNESS)
    assert curve == pytest.approx(area, rel=1e-6)
    assert (error < 0.05 * area).all()


def test_the_fit_is_no_worse_than_the_truth_and_prints_in_a_line() -> None:
    area, error = areas(noise=0.05), 0.05 * areas()
    fit = fit_areas(STIFFNESS, area, error)
    assert fit.chi2 is not None
    assert fit.chi2 <= (((area - areas()) / error) ** 2).sum()
    assert fit.dof == len(area) - 3
    assert "\n" not in str(fit)


@pytest.mark.parametrize("case", quick_with(CASES[-1:], CASES), ids=str)
def test_a_few_synthetic_sets_are_fitted_and_counted(case: Case) -> None:
    for one in coverage(case, 20, seed=3):
        assert 15 <= one.held <= 20
        assert one.open == 0


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES, ids=str)
def test_intervals_of_95_percent_hold_the_truth_that_often(case: Case) -> None:
    for one in coverage(case, 1000, seed=1):
        assert 0.936 <= one.share <= 0.964, one


@pytest.mark.parametrize(
    ("columns", "options", "key"),
    [
        (([1.0, 2.0, 3.0], [1.0, 2.0, 3.0]), {}, "stiffness"),
        (([1.0, 2.0], [1.0, 2.0], [1.0, 1.0]), {}, "stiffness"),
        (([1.0, 2.0], [1.0, 2.0]), {"rest_radius": 1.0}, "stiffness"),
        (([2.0] * 9, STIFFNESS), {}, "stiffness"),
        (([1.0, 2.0] * 4, STIFFNESS[:8]), {}, "stiffness"),
        (([1.0, 0.0, 3.0, 4.0], [1.0] * 4), {}, "stiffness[1]"),
        (([1.0, 2.0, 3.0, 4.0], [1.0, 1.0, -1.0, 1.0]), {}, "area[2]"),
        (([1.0, 2.0, 3.0, 4.0], [1.0, 1.0, np.nan, 1.0]), {}, "area[2]"),
        (([1.0, 2.0, 3.0, 4.0], [1.0] * 3), {}, "area"),
        (([1.0, 2.0, 3.0, 4.0], "abcd"), {}, "area"),
        ((STIFFNESS, STIFFNESS, np.zeros(9)), {}, "error[0]"),
        ((STIFFNESS, STIFFNESS), {"rest_radius": -1.0}, "rest_radius"),
        ((STIFFNESS, STIFFNESS), {"level": 1.0}, "level"),
        ((STIFFNESS, STIFFNESS, STIFFNESS), {"relative": True}, "relative"),
    ],
)
def test_data_that_cannot_be_fitted_are_refused(
    columns: tuple[FloatArray, ...], options: dict[str, float], key: str
) -> None:
    with pytest.raises(SpecError) as refused:
        fit_areas(*columns, **options)  # type: ignore[arg-type]
    assert refused.value.key == key
