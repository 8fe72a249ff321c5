"""Inflection, folds and stars of regular cells, by other ways than they are located."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from eulerplateau.errors import SpecError
from eulerplateau.exact.cell import (
    CellStatus,
    fold_line,
    fold_stiffness,
    folds,
    inflection_onset,
    inflection_stiffness,
    inflections,
    reconnection,
    regular_cell,
    rigid_fold,
    smooth_cells,
    star,
    strongest_pull,
)
from tests.helpers.marks import quick_with


@pytest.mark.parametrize("n", [2, 3, 6])
def test_sides_are_inflected_between_the_two_loads_and_nowhere_else(n):
    """The boundary-value solution there has kappa = 0 in mid-side, and it crosses."""
    # Soft enough for a stable smooth cell at all loads.
    stiffest = min(1.2 * inflection_onset(n).ks_hat, reconnection(n).ks_hat)
    stiffness = np.sqrt(inflection_onset(n).ks_hat * stiffest)
    first, second = inflections(n, stiffness)
    for point in (first, second):
        cell = regular_cell(n, point.sigma_hat, stiffness)
        assert cell.kappa_mid == pytest.approx(0.0, abs=1e-9)
    around = [first.sigma_hat * 0.99, first.sigma_hat * 1.01, second.sigma_hat * 1.01]
    signs = [np.sign(regular_cell(n, load, stiffness).kappa_mid) for load in around]
    assert signs == [1, -1, 1]
    assert inflections(n, 0.99 * inflection_onset(n).ks_hat) == ()
    at = inflection_stiffness(n, first.sigma_hat)
    assert at.ks_hat == pytest.approx(stiffness, rel=1e-9)


@pytest.mark.parametrize("n", quick_with([3], [2, 3, 6]))
def test_fold_is_where_the_stable_cell_ends_and_an_eigenvalue_vanishes(n):
    """Below it there are two cells, of index 0 and 1; their eigenvalues go as the root."""
    sigma = 2.0 * rigid_fold(n).sigma_hat
    fold = fold_stiffness(n, sigma)
    lowest = []
    for off in (1e-4, 1e-6):
        stable, unstable = smooth_cells(n, sigma, fold.ks_hat * (1 - off))
        assert (stable.symmetric_index, unstable.symmetric_index) == (0, 1)
        lowest.append(np.linalg.eigvalsh(stable._jet.curvature)[0])
    assert np.log10(lowest[0] / lowest[1]) == pytest.approx(1.0, abs=0.02)
    assert smooth_cells(n, sigma, fold.ks_hat * 1.0001) == ()
    below, above = (regular_cell(n, sigma, fold.ks_hat * f) for f in (0.999, 1.001))
    assert below.status is CellStatus.CONVERGED
    assert above.status is CellStatus.COLLAPSED


@pytest.mark.slow
def test_smooth_cells_agree_with_the_way_from_a_weak_substrate():
    for n, sigma, stiffness in [(3, 10.0, 50.0), (3, 50.0, 100.0), (5, 300.0, 200.0)]:
        one, other = smooth_cells(n, sigma, stiffness)[0], regular_cell(n, sigma, stiffness)
        assert one.energy == pytest.approx(other.energy, rel=1e-10)
        assert one.perimeter == pytest.approx(other.perimeter, rel=1e-9)


def test_two_folds_bound_the_loads_without_a_smooth_cell():
    low, high = folds(3, 100.0)
    for load, status in [
        (low.sigma_hat * 0.999, CellStatus.CONVERGED),
        (low.sigma_hat * 1.001, CellStatus.COLLAPSED),
        (high.sigma_hat * 0.999, CellStatus.COLLAPSED),
        (high.sigma_hat * 1.001, CellStatus.CONVERGED),
    ]:
        assert regular_cell(3, load, 100.0).status is status
    for point in (low, high):
        at = fold_stiffness(3, point.sigma_hat)
        assert at.ks_hat == pytest.approx(100.0, rel=1e-8)


@pytest.mark.parametrize("n", quick_with([2, 3], [2, 3, 4, 8]))
def test_branches_reconnect_where_adhesions_are_extended_by_a_third(n):
    """There the fold's ks_hat(sigma_hat) has its minimum."""
    point = reconnection(n)
    assert point.cell.extension == pytest.approx(1 / 3, rel=1e-9)
    around = [fold_stiffness(n, point.sigma_hat * f).ks_hat for f in (0.98, 1.0, 1.02)]
    assert around[1] == pytest.approx(point.ks_hat, rel=1e-9)
    assert around[1] < min(around[0], around[2])
    # Stiffness is largest on the fold and least along it: a saddle, so branches reconnect
    # (no isola, which would be an extremum, and no cusp).
    assert folds(n, 0.999 * point.ks_hat) == ()
    assert len(folds(n, 1.001 * point.ks_hat)) == 2


def test_line_of_folds_is_smooth_and_ends_at_infinity_both_ways():
    """From the rigid limit to ks_hat = f / 2 sigma_hat^(2/3); no cusp in between."""
    line = fold_line(3, 60)
    loads = np.array([point.sigma_hat for point in line])
    stiffnesses = np.array([point.ks_hat for point in line])
    assert (np.diff(loads) > 0).all()
    falling = np.diff(stiffnesses) < 0
    assert (falling[0], falling[-1]) == (True, False)
    assert np.count_nonzero(np.diff(falling)) == 1
    far = [fold_stiffness(3, load) for load in (1e7, 8e7)]
    limit = [point.ks_hat / point.sigma_hat ** (2 / 3) for point in far]
    off = np.array(limit) / strongest_pull(3) - 1
    # The extension is missing by one part in y = sigma_hat^(1/3).
    assert np.log2(off[0] / off[1]) == pytest.approx(1.0, abs=0.05)
    assert regular_cell(3, rigid_fold(3).sigma_hat * 0.99, 1e9).symmetric_index == 0


@pytest.mark.parametrize("n", quick_with([3], [2, 3, 4, 8]))
def test_no_smooth_cell_that_is_pulled_touches_itself(n):
    """Half sides stay in their sector, from the circle to the slack end of the curve."""
    y = 1.3 * np.cbrt(rigid_fold(n).sigma_hat)
    fold = fold_stiffness(n, y**3)
    angle = np.pi / n
    for share in (0.05, 0.5, 0.999):
        for cell in smooth_cells(n, y**3, share * fold.ks_hat):
            x, depth = cell.side.points(np.linspace(0.002, 0.998, 400)).T
            assert x.min() > 0
            assert (-depth * np.sin(angle) - x * np.cos(angle)).min() > 0


@pytest.mark.parametrize("n", [3, 4, 7])
def test_star_has_cusps_without_moment_and_turns_by_pi_times_two_minus_n(n):
    """Integrated from mid-side by Runge-Kutta; at the cusp sides are radial, kappa = 0."""
    found = star(n)

    def rates(s, y):
        return [y[1], 0.5 * (1 - y[0] ** 3), y[0], np.cos(y[2]), np.sin(y[2])]

    half = 0.5 * found.side_length
    start = [found.kappa_mid, 0, 0, 0, 0]
    end = solve_ivp(rates, [0, half], start, "DOP853", rtol=1e-13, atol=1e-14).y[:, -1]
    assert end[0] == pytest.approx(0.0, abs=1e-10)
    assert 2 * n * end[2] == pytest.approx(np.pi * (2 - n), rel=1e-10)
    assert end[3] / np.sin(np.pi / n) == pytest.approx(found.radius, rel=1e-10)
    # The force at the cusp is normal, 2 kappa' n, and balances the film: F - sigma J r.
    pull = 2 * found.kappa_slope * np.cos(end[2])
    assert pull == pytest.approx(end[3], rel=1e-10)


def test_protrusions_grow_with_contractility_from_nothing():
    found = star(3)
    assert found.protrusion(found.sigma_p) == pytest.approx(0.0, abs=1e-12)
    assert found.protrusion(8 * found.sigma_p) == pytest.approx(0.5, rel=1e-12)
    with pytest.raises(SpecError, match="sigma_p"):
        found.protrusion(0.9 * found.sigma_p)


def test_wrong_arguments_are_named():
    with pytest.raises(SpecError, match="adhesions"):
        star(2)
    with pytest.raises(SpecError, match="sigma_hat"):
        smooth_cells(3, 0.5, 10.0)
    with pytest.raises(SpecError, match="ks_hat"):
        folds(3, 0.0)
