"""Every compiled loop of the film in its plane against a plain NumPy twin."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.distance import pdist, squareform

from eulerplateau.arrays import FloatArray
from eulerplateau.film import follow_kernels
from eulerplateau.film.harmonic import follower
from eulerplateau.film.models import (
    area,
)
from eulerplateau.loop import kernels, slide_kernels
from eulerplateau.loop.lengths import jacobian
from eulerplateau.loop.loop import Loop
from eulerplateau.loop.motions import rigid_motions, sliding
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.polygon import polygon_area
from eulerplateau.mesh.triangles import cotangents
from eulerplateau.solvers.in_plane import kernels as plane_kernels, turn_kernels
from eulerplateau.solvers.in_plane.chain import Chain, Point
from eulerplateau.solvers.second_variation import tangent_model
from tests.helpers import shapes, twins
from tests.helpers.equilibria import energy_in_plane

LOAD = 1600.0


@pytest.fixture(scope="module")
def chain() -> Chain:
    """41 edges of uneven lengths."""
    lengths = np.random.default_rng(1).uniform(0.7, 1.3, 41)
    return Chain(Loop(lengths / lengths.sum()), LOAD)


def wavy(chain: Chain, size: float) -> FloatArray:
    """Angles of a rough loop that does not quite close."""
    s = chain.loop.rest_lengths
    noise = np.random.default_rng(2).standard_normal(len(s))
    return 2 * np.pi * np.cumsum(s) + 0.3 * np.sin(4 * np.pi * np.cumsum(s)) + size * noise


def closed_point(chain: Chain) -> Point:
    angles = chain.close(wavy(chain, 0.1))
    assert angles is not None
    return chain.at(angles)


def across(point: Point) -> FloatArray:
    """t_v turned to the left (n, 2)."""
    return np.stack([-point.units[:, 1], point.units[:, 0]], axis=1)


def moves(chain: Chain, point: Point) -> FloatArray:
    """d x_v / d theta_u (n, 2, n), the first vertex held."""
    n = len(point.angles)
    before = np.arange(n) < np.arange(n)[:, None]
    turned = (chain.loop.rest_lengths[:, None] * across(point)).T
    return before[:, None, :] * turned[None]


def hessian(chain: Chain, point: Point, pull: FloatArray) -> FloatArray:
    """Of E + pull . p_n, from E as a double sum over edges."""
    s, theta = chain.loop.rest_lengths, point.angles
    n, mean = len(s), chain.loop.mean_lengths
    turn = theta - np.roll(theta, 1)
    difference = np.eye(n) - np.roll(np.eye(n), -1, axis=1)
    bending = difference.T @ (2 * np.cos(turn) / mean * difference.T).T
    sine = np.triu(np.outer(s, s) * np.sin(theta - theta[:, None]), 1)
    film = 0.5 * chain.load * (sine + sine.T)
    film -= np.diag(film.sum(axis=1))
    return bending + film - np.diag(s * (point.units @ pull))


def constraints(chain: Chain, point: Point) -> FloatArray:
    s = chain.loop.rest_lengths
    return np.vstack([(s[:, None] * across(point)).T, point.sliding])


def test_energy_is_bending_and_area_of_the_polygon(chain: Chain) -> None:
    point = closed_point(chain)
    x = point.points[:-1]
    exact = np.sum(x * (chain.loop.bending_matrix @ x)) + LOAD * polygon_area(x)
    assert point.energy == pytest.approx(exact, rel=1e-12)
    assert chain.loop.length_error(x) < 1e-12


def test_gradient_and_hessian_are_the_energys(chain: Chain) -> None:
    angles = wavy(chain, 0.1)
    p = np.random.default_rng(4).standard_normal(len(angles))
    point = chain.at(angles)
    matrix = hessian(chain, point, np.zeros(2))

    def first(a: FloatArray) -> tuple[float, FloatArray]:
        at = chain.at(a)
        return at.energy, at.gradient

    assert twins.taylor_slope(first, angles, 0.1 * p) == pytest.approx(2.0, abs=0.05)
    sizes = [0.01, 0.005, 0.0025, 0.00125]
    rest = [
        float(
            np.abs(
                chain.at(angles + t * p).gradient - point.gradient - t * matrix @ p
            ).max()
        )
        for t in sizes
    ]
    assert shapes.fitted_order(sizes, rest) == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize("shift", [0.0, 5.0, 1e4])
def test_factors_have_the_determinant_and_the_index_of_the_hessian(
    chain: Chain, shift: float
) -> None:
    point, pull = chain.at(wavy(chain, 0.1)), np.array([3.0, -7.0])
    held = constraints(chain, point)
    matrix = hessian(chain, point, pull) + shift * np.diag(chain.loop.rest_lengths)
    whole = (matrix + chain.weight * held.T @ held)[:-1, :-1]
    factors = chain.factors(point, pull, shift)
    assert factors.negative == (np.linalg.eigvalsh(whole) < 0).sum()
    null = np.linalg.svd(held[:, :-1])[2][3:].T
    assert (
        factors.negative == (np.linalg.eigvalsh(null.T @ matrix[:-1, :-1] @ null) < 0).sum()
    )
    logs = np.log(np.abs(factors.gains[:-1, 4])).sum()
    assert logs == pytest.approx(np.linalg.slogdet(whole)[1], rel=1e-10)


def test_step_solves_the_equations_with_the_constraints(chain: Chain) -> None:
    point, pull = chain.at(wavy(chain, 0.1)), np.array([3.0, -7.0])
    held = constraints(chain, point)[:, :-1]
    matrix = hessian(chain, point, pull)[:-1, :-1]
    n = len(matrix)
    rhs, gap = np.random.default_rng(5).standard_normal(n + 1), np.array([0.01, 0.02])
    system = np.block([[matrix, held.T], [held, np.zeros((3, 3))]])
    exact = np.linalg.solve(system, np.concatenate([rhs[:-1], -gap, [0.0]]))
    turns, force = chain.solve(chain.factors(point, pull, 0.0), rhs, gap)
    scale = float(np.abs(exact[:n]).max())
    np.testing.assert_allclose(turns[:-1], exact[:n], atol=1e-9 * scale)
    np.testing.assert_allclose(force, exact[n : n + 2], rtol=1e-8)
    assert turns[-1] == 0.0


def test_closing_moves_edges_least(chain: Chain) -> None:
    """To first order along s t^perp over s, in the norm of the lengths."""
    open_chain = chain.at(wavy(chain, 1e-4))
    turned = open_chain.angles.copy()
    assert plane_kernels.close(turned, chain.loop.rest_lengths, 20) < 1e-14
    change = turned - open_chain.angles
    span = across(open_chain)
    left = change - span @ np.linalg.lstsq(span, change)[0]
    assert np.abs(left).max() < 10 * np.abs(change).max() ** 2


def test_lengths_are_solved_for_as_by_the_whole_matrix(chain: Chain) -> None:
    point = closed_point(chain)
    mean = chain.loop.mean_lengths
    rows = jacobian(chain.loop, point.points[:-1])
    matrix = rows @ (rows / np.repeat(mean, 2)).T
    rhs = np.random.default_rng(6).standard_normal(len(mean))
    found = rhs.copy()
    slide_kernels.solve_lengths(point.units, mean, found)
    np.testing.assert_allclose(matrix @ found, rhs, atol=1e-10)


def test_sliding_is_that_of_loops_in_general(chain: Chain) -> None:
    point = closed_point(chain)
    slide = sliding(chain.loop, point.points[:-1])
    assert slide is not None
    weighted = chain.loop.mean_lengths[:, None] * slide
    row = np.einsum("vd,vdu->u", weighted, moves(chain, point))
    np.testing.assert_allclose(point.sliding, row, atol=1e-12)


def test_circle_does_not_slide() -> None:
    n = 30
    chain = Chain(Loop(np.full(n, 1 / n)), LOAD)
    assert not chain.at(2 * np.pi * np.arange(n) / n).sliding.any()


def test_norm_of_turns_is_that_of_their_displacement(chain: Chain) -> None:
    point = closed_point(chain)
    turns = np.random.default_rng(7).standard_normal(len(point.angles))
    root = np.repeat(np.sqrt(chain.loop.mean_lengths), 2)
    rigid = np.linalg.qr(rigid_motions(point.points[:-1]) * root[:, None])[0]
    columns = root[:, None] * moves(chain, point).reshape(len(root), -1)
    columns -= rigid @ (rigid.T @ columns)
    row = np.empty(len(turns))
    size = turn_kernels.mass_row(
        point.units,
        point.points,
        chain.loop.mean_lengths,
        chain.loop.rest_lengths,
        turns,
        row,
    )
    exact = columns.T @ (columns @ turns)
    np.testing.assert_allclose(row, exact, atol=1e-11)
    assert size == pytest.approx(turns @ exact, rel=1e-11)


def test_tensions_are_the_least_squares_ones_of_the_tangent_model(chain: Chain) -> None:
    x = closed_point(chain).points[:-1]
    exact = tangent_model(energy_in_plane(chain.loop, chain.load), x).tensions
    scale = float(np.abs(exact).max())
    np.testing.assert_allclose(chain.tensions(x), exact, atol=1e-9 * scale)


@pytest.mark.parametrize("aspect", [1.0, 2.5, 6.0, 12.0])
def test_strands_are_within_reach_as_by_all_distances(aspect: float) -> None:
    rng, apart = np.random.default_rng(8), 6
    for n in (24, 61):
        turns = 2 * np.pi * np.arange(n) / n
        x = np.stack([aspect * np.cos(turns), np.sin(turns)], axis=1)
        x += 0.05 * rng.standard_normal(x.shape)
        number = np.arange(n)
        between = np.abs(number - number[:, None])
        far = np.minimum(between, n - between) >= apart
        nearest = squareform(pdist(x))[far].min()
        assert kernels.strands_within(x, nearest * (1 + 1e-9), apart)
        assert not kernels.strands_within(x, nearest * (1 - 1e-9), apart)


def test_inside_follows_harmonically(oval: Disk) -> None:
    film, x = area(oval).tiling(oval.triangles), np.ascontiguousarray(oval.x[:, :2])
    move = np.zeros_like(x)
    move[oval.loop] = 0.1 * np.random.default_rng(9).standard_normal((oval.n_b, 2))
    exact = follower(film, film.sides(oval.x)).extend(move[oval.loop])[oval.interior]
    corners = x[oval.triangles]
    edges = np.roll(corners, 1, axis=1) - np.roll(corners, -1, axis=1)
    weights = cotangents(edges, film.sides(oval.x).areas)
    left = follow_kernels.spread_inside(
        oval.triangles, weights, oval.interior, move, 1e-13, 500
    )
    assert left < 1e-13
    np.testing.assert_allclose(move[oval.interior], exact, atol=1e-12)
