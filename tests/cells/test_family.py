"""Branches of cells: the fold of the three-fold cell, and what its modes break."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.branches import FOLD
from eulerplateau.cells import (
    Cell,
    CellPoint,
    Sites,
    explore_cell,
    regular_sites,
    solve_cell,
    symmetric_index,
    symmetric_part,
)
from eulerplateau.cells.touching import touches
from eulerplateau.errors import SpecError
from tests.helpers.polygons import order


def fold_of(m: int, parameter: str, window: tuple[float, float], fixed: float) -> CellPoint:
    """The first fold of the symmetric branch of three sites, m edges a side."""
    cell = Cell(regular_sites(3), m)
    points = explore_cell(
        cell, parameter, window, fixed, special_points=0, unstable_modes=5
    )
    for point in points:
        if point.special is not None and point.special.kind == FOLD:
            return point
    raise AssertionError("no fold")


# Folds (sigma_hat, ks_hat) of the smooth boundary-value problem, solved independently.
@pytest.mark.slow
@pytest.mark.parametrize(
    ("parameter", "window", "fixed", "exact"),
    [
        ("load", (50.0, 60.0), 123.101, 54.536),
        ("load", (62.0, 75.0), 99.685, 68.283),
        ("stiffness", (110.0, 130.0), 54.536, 123.101),
    ],
)
def test_the_fold_converges_to_that_of_a_smooth_edge_with_the_square_of_the_edges(
    parameter: str, window: tuple[float, float], fixed: float, exact: float
) -> None:
    counts = [16, 24, 32]
    found = [fold_of(m, parameter, window, fixed).value for m in counts]
    sizes = [1 / m for m in counts]
    assert order(sizes, np.subtract(found, exact).tolist()) == pytest.approx(2, abs=0.1)
    limit = np.polyfit(np.square(sizes), found, 2)[2]
    assert limit == pytest.approx(exact, rel=5e-4)


@pytest.fixture(scope="module")
def diagram() -> list[CellPoint]:
    cell = Cell(regular_sites(3), 16)
    points = explore_cell(cell, "load", (40.0, 80.0), 99.685, special_points=0)
    return list(points)


@pytest.mark.slow
def test_the_mode_of_the_fold_is_symmetric_and_that_of_the_pair_before_it_is_not(
    diagram: list[CellPoint],
) -> None:
    special = [p.special for p in diagram if p.special is not None]
    pair, fold = special[:2]
    cell = diagram[0].equilibrium.cell
    assert (pair.kind, pair.multiplicity) == ("bifurcation", 2)
    assert symmetric_part(cell, pair.mode) < 1e-9
    assert fold.kind == FOLD
    assert symmetric_part(cell, fold.mode) == pytest.approx(1, abs=1e-9)
    assert pair.point.value < fold.point.value


@pytest.mark.slow
def test_the_symmetric_index_counts_what_the_fold_turns_unstable(
    diagram: list[CellPoint],
) -> None:
    kinds = [None if p.special is None else p.special.kind for p in diagram]
    before, after = diagram[: kinds.index(FOLD)], diagram[kinds.index(FOLD) + 1 :]
    assert {symmetric_index(p.equilibrium) for p in before[::4]} == {0}
    assert {symmetric_index(p.equilibrium) for p in after[1:8:2]} == {1}
    assert after[1].point.stability.n_unstable == 3
    assert before[0].point.stability.n_unstable == 0


def test_branch_points_are_equilibria_and_none_lies_beyond_a_contact(
    diagram: list[CellPoint],
) -> None:
    assert all(p.equilibrium.residual < 1e-9 for p in diagram[::5])
    assert not any(touches(p.point.x) for p in diagram[:-1])
    assert "\n" not in repr(diagram[0])


def test_a_branch_ends_where_the_edge_meets_itself() -> None:
    """Between two sites the film is pulled in until its long sides meet."""
    cell = Cell(regular_sites(2), 16)
    points = list(explore_cell(cell, "load", (10.0, 60.0), 100.0, special_points=0))
    assert touches(points[-1].point.x)
    assert points[-1].equilibrium.status.value == "touching"
    assert not any(touches(p.point.x) for p in points[:-1])


def test_a_branch_goes_both_ways_from_a_start_inside_the_window() -> None:
    cell = Cell(regular_sites(4), 8)
    start = solve_cell(cell, 5.0, 50.0)
    points = list(explore_cell(cell, "load", (4.0, 6.0), 50.0, start, special_points=0))
    values = [p.value for p in points]
    assert min(values) < 4 < 6 < max(values)
    again = solve_cell(cell, points[-1].value, 50.0, start)
    assert points[-1].equilibrium.energy == pytest.approx(again.energy, rel=1e-10)


def test_only_symmetric_cells_have_a_symmetric_index() -> None:
    uneven = Sites(np.array([[0, 0], [1, 0], [0.2, 1.1]]), np.ones(3))
    with pytest.raises(SpecError, match="regular"):
        symmetric_index(solve_cell(Cell(uneven, 8), 1.0, 10.0))
    sites = regular_sites(3)
    with pytest.raises(SpecError, match="regular"):
        symmetric_part(
            Cell(Sites(sites.points, np.array([1.0, 2, 1])), 8), np.ones((24, 2))
        )


def test_what_makes_no_sense_is_refused() -> None:
    cell = Cell(regular_sites(3), 8)
    start = solve_cell(cell, 2.0, 10.0)
    for arguments in (
        ("tension", (1.0, 2.0), 10.0),
        ("load", (2.0, 1.0), 10.0),
        ("load", (0.0, 1.0), 10.0),
        ("load", (3.0, 4.0), 10.0, start),
        ("load", (1.0, 4.0), 11.0, start),
    ):
        with pytest.raises(SpecError):
            next(explore_cell(cell, *arguments))
