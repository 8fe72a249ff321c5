"""Cells on regular adhesions: the boundary-value problem against other ways, and laws."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from eulerplateau.errors import SpecError
from eulerplateau.exact.cell import CellStatus, HalfSide, arc_cell, regular_cell
from eulerplateau.exact.cell.regular import cell_energy

# (N, sigma_hat, ks_hat, beta_hat): convex, inflected, two adhesions, many, line tension,
# springs that push.
CELLS = [
    (3, 10.0, 50.0, 0.0),
    (3, 60.0, 100.0, 0.0),
    (2, 5.0, 20.0, 0.0),
    (8, 500.0, 600.0, 0.0),
    (4, 20.0, 80.0, 15.0),
    (5, 0.1, 1e3, 0.0),
]


@pytest.mark.parametrize("args", CELLS)
def test_edge_obeys_the_shape_equation_and_the_jump_at_adhesions(args):
    """Integrated from mid-side by Runge-Kutta: curvature, turning, place, spring force."""
    n, sigma, _, beta = args
    cell = regular_cell(*args)

    def rates(s, y):
        kappa, slope, theta = y[:3]
        bend = 0.5 * (sigma + beta * kappa - kappa**3)
        return [slope, bend, kappa, np.cos(theta), np.sin(theta)]

    side = cell.side
    end = solve_ivp(
        rates, [0, side.h], [cell.kappa_mid, 0, 0, 0, 0], "DOP853", rtol=3e-14, atol=1e-14
    ).y[:, -1]
    assert end[0] == pytest.approx(cell.kappa_adhesion, rel=1e-9)
    assert end[2] == pytest.approx(np.pi / n, rel=1e-9)
    assert end[3] / np.sin(np.pi / n) == pytest.approx(1 - cell.extension, rel=1e-9)
    # 4 kappa' = 2 k_s Delta before an adhesion (eq. discontinuity, two sides).
    assert 4 * end[1] == pytest.approx(cell.traction, rel=1e-8)
    middle, corner = side.points(np.array([0.0, 1.0]))
    assert (corner - middle)[1] == pytest.approx(end[4], abs=1e-9)


@pytest.mark.parametrize("args", CELLS)
def test_twice_the_polynomials_change_no_digit_of_nine(args):
    """The solution is good to 1e-9 by its own refinement."""
    _, sigma, stiffness, beta = args
    cell = regular_cell(*args)
    side = cell.side
    finer = side.refined(2 * (len(side.z) - 1))
    for _ in range(3):
        jet = cell_energy(finer, sigma, stiffness, beta)
        finer = HalfSide(
            finer.adhesions, finer.z - np.linalg.solve(jet.curvature, jet.slope)
        )
    assert finer.h == pytest.approx(side.h, rel=1e-9)
    assert finer.kappa_mid == pytest.approx(side.kappa_mid, rel=1e-9, abs=1e-9)
    assert finer.kappa_adhesion == pytest.approx(side.kappa_adhesion, rel=1e-9)


@pytest.mark.parametrize("args", CELLS)
def test_force_across_a_side_balances_the_film(args):
    """F = (kappa^2 - beta) t + 2 kappa' n, and F - sigma J r is constant along a side."""
    n, sigma, _, beta = args
    cell = regular_cell(*args)
    angle = np.pi / n
    along, across = cell.kappa_adhesion**2 - beta, 0.5 * cell.traction
    upwards = along * np.sin(angle) + across * np.cos(angle)
    half_chord = (1 - cell.extension) * np.sin(angle)
    assert upwards == pytest.approx(sigma * half_chord, rel=1e-8)


def test_energy_changes_with_each_parameter_by_what_it_multiplies():
    """DE/dsigma = area, dE/dks = N Delta^2, dE/dbeta = perimeter (Hellmann, Feynman)."""
    args = np.array([10.0, 50.0, 5.0])
    cell = regular_cell(4, *args)
    slopes = cell.area, 4 * cell.extension**2, cell.perimeter
    for place, slope in enumerate(slopes):
        step = np.zeros(3)
        step[place] = 1e-4 * args[place]
        ends = [regular_cell(4, *(args + sign * step)).energy for sign in (1, -1)]
        assert (ends[0] - ends[1]) / (2 * step[place]) == pytest.approx(slope, rel=1e-7)


@pytest.mark.parametrize("n", [2, 3, 7])
def test_cell_as_large_as_its_film_wants_is_a_circle_on_any_substrate(n):
    for stiffness in (1e-2, 1.0, 1e4):
        cell = regular_cell(n, 1.0, stiffness)
        assert cell.perimeter == pytest.approx(2 * np.pi, rel=1e-12)
        assert cell.extension == pytest.approx(0.0, abs=1e-12)


def test_soft_substrate_leaves_the_free_circle_to_first_order():
    """As k_s -> 0 the radius is xi = sigma^(-1/3), with an error in proportion to k_s."""
    free = 2 * np.pi * np.cbrt(1 / 20)
    off = [regular_cell(3, 20.0, k).perimeter / free - 1 for k in (1e-3, 1e-4)]
    assert np.log10(off[0] / off[1]) == pytest.approx(1.0, abs=1e-2)
    assert abs(off[1]) < 1e-4


def test_rigid_substrate_holds_the_adhesions_to_first_order():
    """As k_s -> infinity the extension falls as 1 / k_s."""
    pulls = [regular_cell(3, 20.0, k).traction for k in (1e6, 1e7, 1e8)]
    changes = np.diff(pulls)
    assert np.log10(changes[0] / changes[1]) == pytest.approx(1.0, abs=1e-2)


def test_many_adhesions_are_a_continuous_one():
    """N springs of k_s each on N corners: the radius solves the cubic of the circle."""
    sigma, total = 20.0, 100.0
    cell = [regular_cell(n, sigma, total / n) for n in (8, 16)]
    # sigma pi R^2 + 2 pi / R + total (1 - R)^2 is stationary.
    roots = np.roots([2 * np.pi * sigma + 2 * total, -2 * total, 0, -2 * np.pi])
    radius = float(max(roots[np.abs(roots.imag) < 1e-9].real))
    off = [abs(c.perimeter / (2 * np.pi * radius) - 1) for c in cell]
    assert off[0] < 1e-3
    assert off[1] < off[0] / 8


def test_outline_is_closed_counter_clockwise_and_has_the_area():
    cell = regular_cell(3, 60.0, 100.0)
    areas = []
    for count in (64, 128):
        x, y = cell.outline(count).T
        areas.append(0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)))
    off = np.array(areas) / cell.area - 1
    assert np.log2(off[0] / off[1]) == pytest.approx(2.0, abs=0.02)
    places = cell.outline(64)[::64]
    np.testing.assert_allclose(places, (1 - cell.extension) * cell.adhesions(), atol=1e-12)


@pytest.mark.slow
def test_tight_edges_become_circular_arcs_as_the_root_of_alpha():
    """The limit alpha -> 0 with line tension: arcs of radius beta / sigma (Bischofs)."""
    arcs = arc_cell(4, 0.8, 10.0, 1.0)
    small = np.array([1e-5, 1e-6])
    cells = [regular_cell(4, 0.8 / e, 10.0 / e, 1.0 / e) for e in small]
    for name, scale in (("energy", small), ("perimeter", 1), ("extension", 1)):
        exact = [getattr(cell, name) for cell in cells] * np.asarray(scale)
        off = exact - getattr(arcs, name)
        power = np.log(off[0] / off[1]) / np.log(small[0] / small[1])
        assert power == pytest.approx(0.5, abs=0.02), name
    assert cells[1].kappa_mid == pytest.approx(-1 / arcs.arc_radius, rel=1e-3)


@pytest.mark.parametrize(
    ("args", "culprit"),
    [
        ((1, 10.0, 50.0), "adhesions"),
        ((3.5, 10.0, 50.0), "adhesions"),
        ((3, -1.0, 50.0), "sigma_hat"),
        ((3, np.nan, 50.0), "sigma_hat"),
        ((3, 10.0, 0.0), "ks_hat"),
        ((3, 10.0, np.inf), "ks_hat"),
        ((3, 10.0, 50.0, -1.0), "beta_hat"),
    ],
)
def test_wrong_argument_is_named(args, culprit):
    with pytest.raises(SpecError, match=culprit):
        regular_cell(*args)


def test_cell_beyond_the_fold_has_collapsed_and_has_no_numbers():
    cell = regular_cell(3, 70.0, 100.0)
    assert cell.status is CellStatus.COLLAPSED
    assert np.isnan([cell.perimeter, cell.energy, cell.traction, cell.kappa_mid]).all()
