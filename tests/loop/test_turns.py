"""Turns of a loop's edges: matrices and forces by turns are those by positions."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import EdgeTurns, edge_turns
from eulerplateau.loop.loop import Loop

RNG = np.random.default_rng(8)
N = 11


@pytest.fixture(params=[2, 3])
def turns(request: pytest.FixtureRequest) -> EdgeTurns:
    """Those of a loop of uneven edges, in a plane or in space."""
    angle = np.sort(RNG.uniform(0, 2 * np.pi, N))
    x = np.stack([np.cos(angle), np.sin(angle), 0.3 * np.cos(3 * angle)], axis=1)
    x = x[:, : request.param]
    lengths = np.linalg.norm(np.roll(x, -1, axis=0) - x, axis=1)
    return edge_turns(Loop(lengths), x)


def displacements(turns: EdgeTurns) -> FloatArray:
    """The columns (d n, size): how the loop moves by each of its unknowns."""
    return turns.displacement(np.eye(turns.size))


def symmetric(n: int) -> FloatArray:
    form = RNG.standard_normal((n, n))
    return form + form.T


def test_an_unknown_turns_its_edge_or_moves_the_whole_loop(turns: EdgeTurns) -> None:
    """Each keeps all edges but its own, and the loop's mean where it does not move it."""
    d = turns.across.shape[2]
    moved = displacements(turns).reshape(N, d, -1)
    np.testing.assert_allclose(np.ptp(moved[:, :, -d:], axis=0), 0, atol=1e-14)
    mean = np.einsum("v,vdk->dk", turns.weights, moved[:, :, :-d])
    np.testing.assert_allclose(mean, 0, atol=1e-14)
    # The last edge closes the loop: it takes what the others do.
    edges = np.diff(moved[:, :, :-d], axis=0)
    own = np.concatenate([np.eye(N)[:-1]] * (d - 1), axis=1)
    across = turns.across.reshape(-1, d)
    expected = own[:, None, :] * across.T[None]
    np.testing.assert_allclose(edges, expected, atol=1e-13)


def test_work_is_that_of_the_displacements(turns: EdgeTurns) -> None:
    moved = displacements(turns)
    forces = RNG.standard_normal((len(moved), 3))
    np.testing.assert_allclose(turns.work(forces), moved.T @ forces, atol=1e-12)


def test_mass_is_the_square_of_the_displacements(turns: EdgeTurns) -> None:
    moved = displacements(turns)
    weights = np.repeat(turns.weights, turns.across.shape[2])
    expected = moved.T @ (weights[:, None] * moved)
    np.testing.assert_allclose(turns.mass(), expected, atol=1e-13)


@pytest.mark.parametrize("alike", [False, True])
def test_matrix_is_the_quadratic_form_of_the_displacements(
    turns: EdgeTurns, alike: bool
) -> None:
    """One for all coordinates or a full one, translations included; and one by edges."""
    d, moved = turns.across.shape[2], displacements(turns)
    hessian, by_edges = symmetric(N if alike else N * d), symmetric(N)
    whole = np.kron(hessian, np.eye(d)) if alike else hessian
    across = np.zeros((N, d, turns.size))
    for k, columns in enumerate(turns.across):
        across[np.arange(N), :, k * N + np.arange(N)] = columns
    expected = moved.T @ whole @ moved
    expected += np.einsum("vdk,vw,wdl->kl", across, by_edges, across)
    found = turns.matrix(hessian, by_edges)
    np.testing.assert_allclose(found, expected, atol=1e-12)
