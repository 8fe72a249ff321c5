"""Cells solved for: force balance, limits, orders of convergence, and where they end."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from eulerplateau.cells import (
    Cell,
    CellEquilibrium,
    Sites,
    crosses_itself,
    regular_sites,
    solve_cell,
    sweep_cell,
)
from eulerplateau.cells.equilibrium import status_of
from eulerplateau.errors import SpecError
from eulerplateau.solvers import Stability, Status, tangent_model
from tests.helpers.marks import quick_with
from tests.helpers.polygons import order, turned, uneven as uneven_polygon

POINTS = np.array([[-0.8, -0.7], [1.1, -0.5], [0.7, 0.9], [-0.5, 0.6]])
WEIGHTS = np.array([1.0, 2.0, 0.7, 1.4])
UNEVEN = Sites(POINTS, WEIGHTS)
SIGMA, KS = 12.0, 60.0


@pytest.fixture(scope="module")
def uneven() -> CellEquilibrium:
    return solve_cell(Cell(UNEVEN, 16, beta_hat=0.5), SIGMA, KS)


def test_a_converged_cell_is_a_minimum_whose_parts_add_up(uneven: CellEquilibrium) -> None:
    assert uneven.converged
    assert uneven.n_unstable == 0
    assert uneven.residual < 1e-10
    parts = uneven.bending_energy + uneven.film_energy + uneven.adhesion_energy
    assert uneven.energy == pytest.approx(parts + 0.5 * uneven.perimeter, rel=1e-14)
    assert uneven.film_energy == pytest.approx(SIGMA * uneven.area, rel=1e-14)
    squares = WEIGHTS @ uneven.extensions**2
    assert uneven.adhesion_energy == pytest.approx(KS * squares, rel=1e-13)
    assert "\n" not in repr(uneven)


def test_forces_on_the_substrate_balance(uneven: CellEquilibrium) -> None:
    size = uneven.traction.max()
    np.testing.assert_allclose(uneven.forces.sum(axis=0), 0, atol=1e-9 * size)
    moment = POINTS[:, 0] * uneven.forces[:, 1] - POINTS[:, 1] * uneven.forces[:, 0]
    assert abs(moment.sum()) < 1e-9 * size
    np.testing.assert_allclose(uneven.traction, 2 * KS * WEIGHTS * uneven.extensions)


def test_a_turned_cell_is_the_same_cell(uneven: CellEquilibrium) -> None:
    sites = Sites(turned(POINTS, 1.0) + np.array([3.0, -2.0]), WEIGHTS)
    other = solve_cell(Cell(sites, 16, beta_hat=0.5), SIGMA, KS)
    assert other.energy == pytest.approx(uneven.energy, rel=1e-12)
    np.testing.assert_allclose(other.forces, turned(uneven.forces, 1.0), atol=1e-7)


def test_in_other_units_it_is_the_same_cell(uneven: CellEquilibrium) -> None:
    """Lengths times a: sigma and k_s by a^-3, beta by a^-2, the energy by a^-1."""
    a = 2.5
    cell = Cell(Sites(a * POINTS, WEIGHTS), 16, beta_hat=0.5 / a**2)
    other = solve_cell(cell, SIGMA / a**3, KS / a**3)
    assert other.energy == pytest.approx(uneven.energy / a, rel=1e-12)
    np.testing.assert_allclose(other.x, a * uneven.x, atol=1e-6)


def test_every_start_leads_to_the_same_minimum(uneven: CellEquilibrium) -> None:
    straight = solve_cell(uneven.cell, SIGMA, KS, uneven.cell.straight_start())
    assert straight.energy == pytest.approx(uneven.energy, rel=1e-12)
    again = solve_cell(uneven.cell, SIGMA, KS, uneven)
    assert again.iterations <= 1


def test_derivatives_of_the_energy_are_the_area_and_the_springs_squares(
    uneven: CellEquilibrium,
) -> None:
    """dE/dsigma = A and dE/dk_s = sum w |r - p|^2 (Hellmann and Feynman)."""
    sizes = [0.08, 0.04, 0.02]
    by_load, by_stiffness = [], []
    for h in sizes:
        ends = [solve_cell(uneven.cell, SIGMA + s * h * SIGMA, KS, uneven) for s in (-1, 1)]
        slope = (ends[1].energy - ends[0].energy) / (2 * h * SIGMA)
        by_load.append(slope - uneven.area)
        ends = [solve_cell(uneven.cell, SIGMA, KS + s * h * KS, uneven) for s in (-1, 1)]
        slope = (ends[1].energy - ends[0].energy) / (2 * h * KS)
        by_stiffness.append(slope - uneven.adhesion_energy / KS)
    assert order(sizes, by_load) == pytest.approx(2, abs=0.1)
    assert order(sizes, by_stiffness) == pytest.approx(2, abs=0.1)


@pytest.mark.slow
def test_springs_end_up_normal_to_the_edge_to_the_order_of_the_discretisation() -> None:
    counts = [12, 24, 48]
    slipped = []
    for m in counts:
        found = solve_cell(Cell(UNEVEN, m), SIGMA, KS)
        assert found.status is Status.CONVERGED
        slipped.append(float(np.abs(found.tangential / found.extensions).max()))
    assert order([1 / m for m in counts], slipped) == pytest.approx(2, abs=0.2)


def circle_perimeter(n: int, sigma: float) -> float:
    """Of the regular n-gon that nothing holds: l^3 = 8 pi^2 tan(pi / n) / (n^2 sigma)."""
    return n * (8 * np.pi**2 * np.tan(np.pi / n) / (n**2 * sigma)) ** (1 / 3)


def test_on_soft_springs_a_cell_is_a_free_circle() -> None:
    """E = sigma pi R^2 + 2 pi / R is least at R = sigma^(-1/3)."""
    softness = [0.4, 0.2, 0.1]
    cell, sigma = Cell(regular_sites(3), 16), 2.0
    off = []
    for ks in softness:
        found = solve_cell(cell, sigma, ks)
        assert found.converged
        off.append(found.perimeter - circle_perimeter(cell.size, sigma))
    assert order(softness, off) == pytest.approx(1, abs=0.05)
    counts = [24, 48, 96]
    smooth = 2 * np.pi * sigma ** (-1 / 3)
    errors = [circle_perimeter(n, sigma) - smooth for n in counts]
    assert order([1 / n for n in counts], errors) == pytest.approx(2, abs=0.01)


def test_on_stiff_springs_adhesions_stay_where_the_sites_are() -> None:
    stiffness = [1e3, 1e4, 1e5]
    found = [solve_cell(Cell(regular_sites(3), 32), 10.0, ks) for ks in stiffness]
    assert all(cell.converged for cell in found)
    extensions = [float(cell.extensions.max()) for cell in found]
    assert order(stiffness, extensions) == pytest.approx(-1, abs=0.05)
    assert found[2].traction.max() == pytest.approx(found[1].traction.max(), rel=0.02)


@pytest.mark.parametrize("n", [2, 3, 5, 8])
def test_cells_on_regular_polygons_of_any_number_converge(n: int) -> None:
    found = solve_cell(Cell(regular_sites(n), 16), 5.0, 50.0)
    assert found.converged
    np.testing.assert_allclose(found.traction, found.traction[0], rtol=1e-6)


def test_a_sweep_ends_where_the_edge_meets_itself_and_never_beyond() -> None:
    """Past its last stable state a three-fold cell collapses onto itself."""
    values = [(sigma, 100.0) for sigma in (50.0, 60.0, 70.0, 80.0)]
    found = list(sweep_cell(Cell(regular_sites(3), 32), values))
    assert [cell.status.value for cell in found] == ["converged"] * 2 + ["touching"]
    assert not crosses_itself(found[-1].x)
    assert found[-1].area > 0
    assert found[-1].status.advice


def test_a_cell_too_coarse_for_its_shape_says_so() -> None:
    found = solve_cell(Cell(regular_sites(3), 4), 30.0, 1000.0)
    assert found.status is Status.UNRESOLVED


def test_what_makes_no_sense_is_refused() -> None:
    cell = Cell(regular_sites(3), 8)
    x = cell.round_start()
    for sigma, ks in ((-1.0, 1.0), (np.nan, 1.0), (1.0, 0.0), (1.0, np.inf)):
        with pytest.raises(SpecError):
            solve_cell(cell, sigma, ks)
    for start in (x[:-1], np.full_like(x, np.nan), np.zeros_like(x), x * np.nan):
        with pytest.raises(SpecError, match="start"):
            solve_cell(cell, 1.0, 1.0, start)
    t = 2 * np.pi * (np.arange(cell.size) + 0.5) / cell.size
    with pytest.raises(SpecError, match="crosses itself"):
        solve_cell(cell, 1.0, 1.0, np.column_stack([np.sin(t), np.sin(2 * t)]))
    with pytest.raises(SpecError, match="max_iterations"):
        solve_cell(cell, 1.0, 1.0, max_iterations=0)


@pytest.mark.parametrize("seed", quick_with([0, 1, 3, 5, 6, 7], range(8)))
def test_on_any_polygon_a_cell_ends_as_a_minimum_or_says_why_there_is_none(
    seed: int,
) -> None:
    rng = np.random.default_rng(seed)
    n = int(rng.integers(3, 7))
    sites = Sites(uneven_polygon(n, seed), rng.uniform(0.4, 2.0, n))
    sigma, ks = 10 ** rng.uniform(-1, 2.5), 10 ** rng.uniform(0, 4)
    found = solve_cell(Cell(sites, 16), sigma, ks)
    ends = {Status.CONVERGED, Status.UNRESOLVED, Status.TOUCHING, Status.COLLAPSED}
    assert found.status in ends
    assert not crosses_itself(found.x)
    if found.converged:
        assert found.n_unstable == 0
        assert found.residual < 1e-6


def test_stall_in_balance_is_a_minimum_or_a_saddle(uneven: CellEquilibrium) -> None:
    """By its modes; what converged, or stalled, out of balance has stalled."""
    cell = uneven.cell
    model = tangent_model(cell.energy(SIGMA, KS), uneven.x)
    stable, saddle = (Stability(np.array([low, 9.0]), 1e-9) for low in (1.0, -1.0))
    searched = Status.STALLED
    assert status_of(cell, model, stable, searched) is Status.CONVERGED
    assert status_of(cell, model, saddle, searched) is Status.SADDLE
    pulled = replace(model, residual=1e-3)
    for end in (Status.STALLED, Status.CONVERGED):
        assert status_of(cell, pulled, saddle, end) is Status.STALLED
