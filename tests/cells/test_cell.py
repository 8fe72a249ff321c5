"""The cell: its terms, its starts, and where its edge meets itself."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.cells import Cell, Sites, crosses_itself, regular_sites, strands_near
from eulerplateau.cells.touching import Apart, collapsed
from eulerplateau.errors import SpecError
from eulerplateau.loop import edges_of

UNEVEN = Sites(np.array([[0, 0], [1, 0.1], [1.3, 0.9], [0.2, 1.0]]), np.ones(4))


def test_line_tension_is_a_term_where_there_is_some() -> None:
    plain, tense = Cell(UNEVEN), Cell(UNEVEN, beta_hat=2.0)
    assert [*plain.energy(1.0, 2.0).terms] == ["bending", "film", "adhesions"]
    assert "line_tension" in tense.energy(1.0, 2.0).terms
    assert plain.energy(1.0, 2.0).free_motions(plain.round_start()).shape == (256, 0)


@pytest.mark.parametrize(("m", "beta"), [(5, 0.0), (2, 0.0), (8, -1.0), (8, np.nan)])
def test_a_cell_that_makes_no_sense_is_refused(m: int, beta: float) -> None:
    with pytest.raises(SpecError):
        Cell(UNEVEN, m, beta)


@pytest.mark.parametrize("n", [2, 3, 5, 12])
def test_starts_pass_through_the_sites_with_equal_edges_and_no_folds(n: int) -> None:
    cell = Cell(regular_sites(n), 8)
    for x in (cell.round_start(), cell.straight_start()):
        np.testing.assert_allclose(x[cell.vertices], cell.sites.points, atol=1e-15)
        edges = edges_of(x)
        np.testing.assert_allclose(edges.lengths, edges.lengths[0], rtol=1e-13)
        assert np.abs(edges.turning).max() < 0.9 * np.pi
        assert edges.turning.sum() == pytest.approx(2 * np.pi)
        assert not crosses_itself(x)


def test_the_round_start_of_a_regular_polygon_is_its_circle() -> None:
    x = Cell(regular_sites(5), 16).round_start()
    np.testing.assert_allclose(np.hypot(*x.T), 1, rtol=1e-14)


def eight() -> FloatArray:
    t = 2 * np.pi * (np.arange(64) + 0.5) / 64
    return np.column_stack([np.sin(t), np.sin(2 * t)])


def waist(width: float) -> FloatArray:
    t = 2 * np.pi * np.arange(128) / 128
    return np.column_stack([np.cos(t), np.sin(t) * (width + np.cos(t) ** 2)])


def test_crossings_and_contacts_are_found() -> None:
    assert crosses_itself(eight())
    assert not crosses_itself(waist(0.01))
    square = np.array([[0, 0], [2, 0], [2, 2], [0, 2.0]])
    assert not crosses_itself(square)
    on_the_edge = np.insert(square, 2, [1.0, 0.0], axis=0)
    assert crosses_itself(on_the_edge)


def test_strands_are_near_within_an_edge() -> None:
    assert strands_near(waist(0.01))
    assert not strands_near(waist(0.2))
    # Scale is no matter, nor where the loop begins, nor which way it runs.
    for x in (100 * waist(0.01), np.roll(waist(0.01), 37, axis=0), waist(0.01)[::-1]):
        assert strands_near(x)


def test_short_edges_next_to_long_ones_are_no_contact() -> None:
    corners = np.array([[0, 0], [1, 0], [1, 0.02], [0, 1.0]])
    cell = Cell(Sites(corners, np.ones(4)), 32)
    assert not strands_near(cell.straight_start())


def test_a_side_that_has_all_but_gone_is_no_contact() -> None:
    angle = np.array([0, 2, 2.0001, 4])
    sites = Sites(np.column_stack([np.cos(angle), np.sin(angle)]), np.ones(4))
    assert not strands_near(Cell(sites, 24).straight_start())


def test_a_step_through_another_strand_is_refused() -> None:
    guard = Apart(np.array([1.0]))
    apart, shrink = waist(0.3), waist(-0.1) - waist(0.3)
    assert guard.change(apart, 0.1 * shrink) == 0.0
    with pytest.raises(LinAlgError):
        guard.change(apart, 0.99 * shrink)
    near = waist(0.28) - waist(0.01)
    assert not guard.holds(waist(0.01))
    assert Apart(np.array([1.0]), close=True).change(waist(0.01), 0.1 * near) == 0.0


def test_a_side_without_its_share_has_collapsed() -> None:
    cell = Cell(UNEVEN, 8)
    x = cell.straight_start()
    assert not collapsed(x, cell.shares)
    corners = UNEVEN.points.copy()
    corners[1] = [0.002, 0.0]
    gone = Cell(Sites(corners, np.ones(4)), 8)
    assert collapsed(gone.straight_start(), cell.shares)
    assert not collapsed(gone.straight_start(), gone.shares)
