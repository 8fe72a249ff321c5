"""A round cell on a continuous adhesion: the cubic, its limits, and the energy behind."""

from __future__ import annotations

from decimal import Decimal, localcontext
from math import pi

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError
from eulerplateau.exact.cell import cell_radius, interpolated_radius, radius_slopes
from scripts.studies.cell_radius.errors import SOFT, STIFF, error, order, worst

EPS = np.finfo(np.float64).eps
PI = Decimal("3.14159265358979323846264338327950288419716939937510582097494459")


def random_cells(span: float, count: int, seed: int = 0) -> FloatArray:
    """Return k_s, sigma, alpha and R_0 (4, count), each over 2 `span` decades."""
    return 10.0 ** np.random.default_rng(seed).uniform(-span, span, (4, count))


def energy(
    radius: FloatArray | float, k: float, sigma: float, alpha: float, rest: float
) -> FloatArray | float:
    """The paper's eq. cfm on a circle: area, bending, springs of density 1/L."""
    return pi * sigma * radius**2 + 2 * pi * alpha / radius + k * (radius - rest) ** 2


def exact_root(cell: FloatArray, start: float) -> Decimal:
    """Return the cubic's root in 60 digits, by Newton's method from a float."""
    with localcontext(prec=60):
        k, sigma, alpha, rest, x = map(Decimal, (*cell.tolist(), start))
        for _ in range(6):
            value = (k + PI * sigma) * x**3 - k * rest * x**2 - PI * alpha
            x -= value / (3 * (k + PI * sigma) * x**2 - 2 * k * rest * x)
        return x


@pytest.mark.parametrize("span", [2.0, 30.0, 150.0, 300.0])
def test_radius_is_right_to_rounding_whatever_the_scales(span: float) -> None:
    cells = random_cells(span, 300)
    found = cell_radius(*cells)
    assert np.isfinite(found).all()
    for cell, radius in zip(cells.T, found, strict=True):
        if 1e-300 < radius < 1e300:
            exact = exact_root(cell, float(radius))
            assert abs(Decimal(float(radius)) / exact - 1) < Decimal(4 * EPS)


def test_radius_is_where_an_independent_minimisation_of_the_energy_ends() -> None:
    for cell in random_cells(1.5, 40, seed=1).T:
        radius = float(cell_radius(*cell))
        found = minimize_scalar(
            lambda t, cell=cell: energy(np.exp(t), *cell),
            bounds=(np.log(radius) - 3, np.log(radius) + 2),
            method="bounded",
            options={"xatol": 1e-12},
        )
        # A minimum is known to the root of the energy's precision.
        assert np.exp(found.x) == pytest.approx(radius, rel=1e-6)


def test_energy_is_convex_there_and_stationary() -> None:
    cells = random_cells(2.0, 200, seed=2)
    radius = cell_radius(*cells)
    k, sigma, alpha, rest = cells
    forces = np.array([2 * pi * sigma * radius, -2 * pi * alpha / radius**2])
    spring = 2 * k * (radius - rest)
    size = np.abs(forces).sum(axis=0) + 2 * k * np.maximum(radius, rest)
    assert (np.abs(forces.sum(axis=0) + spring) < 10 * EPS * size).all()
    step = 1e-3 * radius
    middle = energy(radius, *cells)
    assert (energy(radius + step, *cells) > middle).all()
    assert (energy(radius - step, *cells) > middle).all()


def test_on_a_soft_substrate_the_radius_is_xi_and_on_a_stiff_one_the_rest_radius() -> None:
    sigma, alpha, rest = random_cells(0.5, 50, seed=3)[:3]
    xi = np.cbrt(alpha / sigma)
    assert cell_radius(0.0, sigma, alpha, rest) == pytest.approx(xi, rel=4 * EPS)
    for small in (1e-5, 1e-6, 1e-7):
        # From E' = 0 to first order; what is left out is of second order in `small`.
        soft = cell_radius(small * sigma, sigma, alpha, rest)
        slope = (rest - xi) / (3 * pi)
        room = small**2 * np.abs(slope) * (1 + np.abs(slope) / xi) + 4 * EPS * xi
        assert (np.abs(soft - xi - small * slope) < room).all()
        stiff = cell_radius(sigma / small, sigma, alpha, rest)
        pull = pi * (alpha / rest**2 / sigma - rest)
        steepness = pi * (2 * alpha / rest**3 / sigma + 1)
        room = 2 * small**2 * np.abs(pull) * steepness + 4 * EPS * rest
        assert (np.abs(stiff - rest - small * pull) < room).all()


def test_where_xi_is_the_rest_radius_the_cell_is_as_large_as_that() -> None:
    k, sigma, _, rest = random_cells(5.0, 200, seed=4)
    found = cell_radius(k, sigma, sigma * rest**3, rest)
    assert found == pytest.approx(rest, rel=4 * EPS)
    assert interpolated_radius(k, sigma, sigma * rest**3, rest) == pytest.approx(
        rest, rel=4 * EPS
    )


@pytest.mark.parametrize("ratio", [0.2, 0.9, 1.1, 5.0])
def test_radius_rises_with_stiffness_if_and_only_if_xi_is_below_the_rest_radius(
    ratio: float,
) -> None:
    radius = cell_radius(np.geomspace(1e-3, 1e5, 200), 2.0, 2.0 * (3.0 * ratio) ** 3, 3.0)
    steps = np.diff(radius)
    assert (steps > 0).all() if ratio < 1 else (steps < 0).all()
    assert (radius > min(ratio, 1) * 3).all()
    assert (radius < max(ratio, 1) * 3).all()


def test_without_one_of_the_terms_the_root_is_elementary() -> None:
    k, sigma, alpha, rest = random_cells(2.0, 50, seed=5)
    pulled_in = cell_radius(k, sigma, 0.0, rest)
    assert pulled_in == pytest.approx(k * rest / (k + pi * sigma), rel=4 * EPS)
    held_out = cell_radius(k, 0.0, alpha, rest)
    assert (held_out > rest).all()
    cube = k * rest * held_out**2 + pi * alpha
    assert k * held_out**3 == pytest.approx(cube, rel=20 * EPS)


def test_slopes_are_the_derivatives() -> None:
    cells = random_cells(1.0, 100, seed=6)
    slopes = radius_slopes(*cells)
    names = ("stiffness", "contractility", "bending", "rest_radius")
    for row, name in enumerate(names):
        errors = []
        for step in (1e-2, 5e-3):
            sides = []
            for sign in (1, -1):
                moved = cells.copy()
                moved[row] *= 1 + sign * step
                sides.append(cell_radius(*moved))
            secant = (sides[0] - sides[1]) / (2 * step * cells[row])
            errors.append(
                np.abs(secant - getattr(slopes, name)).max() / np.abs(secant).max()
            )
        assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.05), name


def test_slopes_add_up_as_units_demand() -> None:
    """Forces scaled change nothing; lengths scaled are the radius scaled."""
    k, sigma, alpha, rest = cells = random_cells(2.0, 100, seed=7)
    slopes = radius_slopes(*cells)
    radius = cell_radius(*cells)
    bending = alpha * slopes.bending
    forces = k * slopes.stiffness + sigma * slopes.contractility + bending
    assert np.abs(forces / radius).max() < 1e-14
    lengths = rest * slopes.rest_radius + 3 * bending
    assert lengths == pytest.approx(radius, rel=1e-14)


def test_interpolation_leaves_the_cubic_at_what_its_docstring_says() -> None:
    k, sigma, alpha, rest = cells = random_cells(1.0, 200, seed=8)
    radius, xi = interpolated_radius(*cells), np.cbrt(alpha / sigma)
    left = (k + pi * sigma) * radius**3 - k * rest * radius**2 - pi * alpha
    stated = -pi * sigma * (radius - xi) ** 2 * (2 * radius + xi)
    size = (k + pi * sigma) * radius**3 + k * rest * radius**2 + pi * alpha
    assert (np.abs(left - stated) < 20 * EPS * size).all()
    assert (radius <= cell_radius(*cells) * (1 + 4 * EPS)).all()


@pytest.mark.parametrize("tension", [0.1, 10.0, 100.0])
def test_interpolation_is_right_to_first_order_at_the_soft_end_only(tension: float) -> None:
    assert order(SOFT * tension, tension) == pytest.approx(2.0, abs=0.01)
    assert -order(STIFF * tension, tension) == pytest.approx(1.0, abs=0.01)


def test_interpolation_at_its_worst_is_no_better_elsewhere() -> None:
    found = worst(10.0)
    assert found.error == pytest.approx(float(error(found.stiffness, 10.0)))
    assert (error(np.geomspace(1e-3, 1e6, 1000), 10.0) >= found.error - 1e-12).all()


def test_arguments_broadcast() -> None:
    grid = cell_radius(np.ones((3, 1)), [1.0, 2.0], 0.5)
    assert grid.shape == (3, 2)
    assert grid[1, 1] == cell_radius(1.0, 2.0, 0.5)


@pytest.mark.parametrize(
    ("cell", "key"),
    [
        ((-1.0, 1.0, 1.0, 1.0), "stiffness"),
        ((np.nan, 1.0, 1.0, 1.0), "stiffness"),
        ((1.0, np.inf, 1.0, 1.0), "contractility"),
        ((1.0, 1.0, [1.0, -2.0], 1.0), "bending"),
        ((1.0, 1.0, 1.0, 0.0), "rest_radius"),
        ((0.0, 0.0, 1.0, 1.0), "contractility"),
        ((0.0, 1.0, 0.0, 1.0), "bending"),
        (("soft", 1.0, 1.0, 1.0), "stiffness"),
        (([1.0, 2.0], [1.0, 2.0, 3.0], 1.0, 1.0), "stiffness"),
    ],
)
def test_impossible_cells_are_refused(cell: tuple[object, ...], key: str) -> None:
    with pytest.raises(SpecError) as refused:
        cell_radius(*cell)  # type: ignore[arg-type]
    assert refused.value.key == key


def test_interpolation_needs_contractility() -> None:
    with pytest.raises(SpecError):
        interpolated_radius(1.0, 0.0, 1.0)
