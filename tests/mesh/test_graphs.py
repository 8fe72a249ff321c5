"""Graphs by NumPy alone against SciPy's."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.graphs import around, components, neighbours_by_vertex


@pytest.mark.parametrize("edges", [0, 40, 95, 300])
def test_components_are_those_that_scipy_finds(edges: int) -> None:
    """Of random graphs in many pieces, in a few and in one, numbered the same way."""
    one, other = np.random.default_rng(edges).integers(100, size=(2, edges))
    graph = coo_array((np.ones(edges), (one, other)), shape=(100, 100))
    expected = connected_components(graph, directed=False)[1]
    np.testing.assert_array_equal(components(one, other, 100), expected)


def test_a_path_in_any_order_is_one_component() -> None:
    order = np.random.default_rng(0).permutation(1000)
    assert not components(order[1:], order[:-1], 1000).any()


def test_second_ring_is_what_two_steps_along_edges_reach(oval: Disk) -> None:
    first, neighbours = neighbours_by_vertex(oval.edges, oval.n_v)
    reach = np.zeros((oval.n_v, oval.n_v), dtype=bool)
    whose, beside = around(first, neighbours, np.arange(oval.n_v))
    reach[whose, beside] = True
    assert len(whose) == 2 * len(oval.edges) == reach.sum()
    two = (reach @ reach) | reach
    np.fill_diagonal(two, False)
    begin, ring = oval.second_ring
    for v, near in zip(oval.loop, np.split(ring, begin[1:]), strict=True):
        np.testing.assert_array_equal(near, np.flatnonzero(two[v]))
