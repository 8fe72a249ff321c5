"""Polygons against the boundary-value problem: second order in the edges, everywhere."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.cells import Cell, regular_sites, solve_cell, symmetric_index
from eulerplateau.exact.cell import regular_cell
from tests.helpers.marks import quick_with

# (N, sigma_hat, ks_hat, beta_hat): two adhesions, the paper's, line tension.
INFLECTED = (3, 50.0, 100.0, 0.0)
CELLS = [(2, 5.0, 20.0, 0.0), (3, 10.0, 50.0, 0.0), INFLECTED, (5, 30.0, 60.0, 8.0)]
EDGES = (24, 48, 96)


@pytest.mark.parametrize(("n", "sigma", "stiffness", "beta"), quick_with(CELLS[:1], CELLS))
def test_polygon_converges_to_the_exact_cell_with_order_two(n, sigma, stiffness, beta):
    exact = regular_cell(n, sigma, stiffness, beta)
    assert (exact.kappa_mid < 0) == (sigma == INFLECTED[1])
    off: dict[str, list[float]] = {}
    for edges in EDGES:
        found = solve_cell(Cell(regular_sites(n), edges, beta), sigma, stiffness)
        assert found.converged
        assert (found.n_unstable, symmetric_index(found)) == (0, exact.symmetric_index)
        for name, value in {
            "perimeter": found.perimeter,
            "area": found.area,
            "energy": found.energy,
            "traction": found.traction.mean(),
            "extension": found.extensions.mean(),
            "kappa_mid": found.kappa_mid.mean(),
            "kappa_adhesion": found.kappa_adhesion.mean(),
        }.items():
            off.setdefault(name, []).append(value - getattr(exact, name))
    for name, errors in off.items():
        slope = np.polyfit(np.log(EDGES), np.log(np.abs(errors)), 1)[0]
        assert slope == pytest.approx(-2.0, abs=0.1), name


def test_curvature_and_angle_along_an_edge_are_the_exact_ones():
    """At every vertex of a side, to second order; arc length from one adhesion on."""
    exact = regular_cell(3, 10.0, 50.0)
    worst = []
    for edges in (32, 64):
        found = solve_cell(Cell(regular_sites(3), edges), 10.0, 50.0)
        chords = np.diff(np.vstack([found.x, found.x[:1]]), axis=0)[:edges]
        angles = np.unwrap(np.arctan2(chords[:, 1], chords[:, 0]))
        u = 2 * (np.arange(edges) + 0.5) / edges - 1
        turned = angles - angles.mean()
        kappa = np.diff(angles) / np.hypot(*chords[0])
        at = 2 * np.arange(1, edges) / edges - 1
        worst.append(
            [
                np.abs(turned - exact.side.tangent_angle(u)).max(),
                np.abs(kappa - exact.side.curvature(at)).max(),
            ]
        )
    orders = np.log2(np.array(worst[0]) / worst[1])
    np.testing.assert_allclose(orders, 2.0, atol=0.1)
