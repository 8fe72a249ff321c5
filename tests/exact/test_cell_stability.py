"""The second variation of regular cells: derivatives, limits, and a polygon's spectrum."""

import numpy as np
import pytest

from eulerplateau.cells import (
    Cell,
    cell_near,
    regular_sites,
    solve_cell,
    symmetric_index,
)
from eulerplateau.errors import SpecError
from eulerplateau.exact.cell import (
    fold_stiffness,
    regular_cell,
    rigid_fold,
    smooth_cells,
    symmetry_breaking,
)
from eulerplateau.exact.cell.side import HalfSide, rule
from eulerplateau.exact.cell.stability import _bulge
from tests.helpers.marks import quick_with


def slopes(values, steps):
    """Return the powers of the step with which values fall."""
    return np.diff(np.log(np.abs(values))) / np.diff(np.log(steps))


@pytest.mark.parametrize("name", ["bending", "length", "radius", "area"])
def test_side_has_the_derivatives_it_says(name):
    """Taylor: remainders fall as the second power of the step, and as the third."""
    rng = np.random.default_rng(2)
    z = np.append(0.4 * rng.standard_normal(8) / np.arange(1, 9) ** 2, 1.3)
    move = rng.standard_normal(9)
    jet = getattr(HalfSide(3, z), name)()
    steps = np.array([1e-2, 5e-3])
    rest = np.array([getattr(HalfSide(3, z + t * move), name)().value for t in steps])
    rest -= jet.value + steps * (jet.slope @ move)
    bent = 0.5 * steps**2 * (move @ jet.curvature @ move)
    if name == "length":
        assert np.abs(rest).max() < 1e-15
        return
    assert slopes(rest, steps) == pytest.approx(2.0, abs=0.1)
    assert slopes(rest - bent, steps) == pytest.approx(3.0, abs=0.2)


def test_area_beyond_the_chord_has_the_derivatives_it_says():
    """The same, for a side that need not be symmetric."""
    rng = np.random.default_rng(3)
    r = rule(8)
    basis = r.integral @ np.polynomial.legendre.legvander(2 * r.places - 1, 6)
    a, move = rng.standard_normal((2, 7)) / np.arange(1, 8)
    value, slope, curvature = _bulge(r, basis, a)
    steps = np.array([1e-2, 5e-3])
    rest = np.array([_bulge(r, basis, a + t * move)[0] for t in steps])
    rest -= value + steps * (slope @ move)
    bent = 0.5 * steps**2 * (move @ curvature @ move)
    assert slopes(rest, steps) == pytest.approx(2.0, abs=0.1)
    assert slopes(rest - bent, steps) == pytest.approx(3.0, abs=0.1)


@pytest.mark.parametrize("n", [3, 6])
def test_what_moves_a_cell_as_a_whole_costs_nothing_without_springs(n):
    """Rotation is a wave with q = 0, shifts have q = 1; all costs are the springs'."""
    soft = [regular_cell(n, 20.0, k).waves for k in (1e-3, 1e-4)]
    for q in (0, 1):
        costs = [waves.lowest(q) for waves in soft]
        assert np.log10(costs[0] / costs[1]) == pytest.approx(1.0, abs=0.01)
    assert soft[0].lowest(2 if n > 3 else 1) > 0


@pytest.mark.parametrize("n", quick_with([3], [2, 3, 5]))
def test_index_within_the_symmetry_is_that_of_the_symmetric_shapes(n):
    """Beyond the fold one more wave with q = 0 is unstable than before it."""
    sigma = 2.0 * rigid_fold(n).sigma_hat
    fold = fold_stiffness(n, sigma)
    stable, unstable = smooth_cells(n, sigma, 0.9 * fold.ks_hat)
    assert [int((c.waves.eigenvalues(0) < 0).sum()) for c in (stable, unstable)] == [0, 1]
    assert [c.symmetric_index for c in (stable, unstable)] == [0, 1]


# Next to transitions of all kinds: (N, sigma_hat, ks_hat), stable and unstable.
SHAPES = [(3, 60.0, 100.0), (3, 67.0, 100.0), (4, 128.0, 60.0), (4, 128.0, 68.0)]


@pytest.mark.parametrize(("n", "sigma", "stiffness"), quick_with(SHAPES[:2], SHAPES))
def test_whole_index_is_that_of_the_polygon(n, sigma, stiffness):
    """Two ways that share nothing: polynomials and waves, polygons and all eigenvalues."""
    exact = regular_cell(n, sigma, stiffness)
    cell = Cell(regular_sites(n), 64)
    # The discrete equilibrium next to the exact one, stable or not.
    found = cell_near(cell, _turned(exact.outline(64), n), sigma, stiffness)
    assert found.n_unstable == exact.n_unstable
    assert symmetric_index(found) == exact.symmetric_index == 0


def _turned(x, n):
    """Return an exact outline with its first adhesion at (1, 0), as a polygon has it."""
    turned = (x[:, 0] + 1j * x[:, 1]) * np.exp(2j * np.pi * (0.5 / n + 0.25))
    return np.stack([turned.real, turned.imag], axis=-1)


@pytest.mark.slow
def test_cells_with_two_adhesions_stay_symmetric_and_others_do_not():
    for n in (2, 3, 4, 6):
        sigma = 3.0 * rigid_fold(n).sigma_hat
        points = symmetry_breaking(n, sigma)
        assert (points == ()) == (n == 2)
        for point in points[:1]:
            assert point.lost
            assert point.ks_hat < fold_stiffness(n, sigma).ks_hat
            assert point.cell.waves.lowest(point.q) == pytest.approx(0.0, abs=1e-9)
            below, above = (regular_cell(n, sigma, f * point.ks_hat) for f in (0.99, 1.01))
            assert below.n_unstable == 0
            assert above.n_unstable == (1 if point.q == n / 2 else 2)
    with pytest.raises(SpecError, match="sigma_hat"):
        symmetry_breaking(3, 0.9)


def test_stable_cell_is_where_the_polygon_goes_by_itself():
    """Downhill from arcs the polygon comes to the exact cell, to second order."""
    exact = regular_cell(3, 10.0, 50.0)
    off = []
    for edges in (16, 32):
        found = solve_cell(Cell(regular_sites(3), edges), 10.0, 50.0)
        off.append(found.energy - exact.energy)
    assert np.log2(off[0] / off[1]) == pytest.approx(2.0, abs=0.05)


@pytest.mark.slow
def test_symmetry_lost_on_a_small_part_of_the_way_is_found():
    """Twelve adhesions: unstable, stable again and unstable as the substrate stiffens."""
    indices = [regular_cell(12, 381.0, k).n_unstable for k in (40.0, 50.0, 80.0, 90.0)]
    assert indices == [0, 2, 0, 2]
    point = symmetry_breaking(12, 381.0)[0]
    assert point.q == 2
    assert 40.0 < point.ks_hat < 50.0
