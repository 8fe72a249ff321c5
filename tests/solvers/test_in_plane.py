"""Newton in the plane: minima from afar, their spectra, and meshes that follow."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.planar import planar_film
from eulerplateau.film.models import (
    area,
)
from eulerplateau.loop import Loop, LoopEnergy, close_with_lengths
from eulerplateau.mesh.disk import Disk
from eulerplateau.solvers import Problem, Status, solve, stability, tangent_model
from eulerplateau.solvers.in_plane import newton
from eulerplateau.solvers.in_plane.chain import Chain
from eulerplateau.solvers.in_plane.newton import COARSE, minimum_in_plane, settle_in_plane
from tests.helpers import shapes
from tests.helpers.equilibria import energy_in_plane, ring

EDGES = (48, COARSE, 100, 2 * COARSE, 2 * COARSE + 1, 300)


def even(edges: int) -> Loop:
    return Loop(np.full(edges, 1 / edges))


def waved(loop: Loop, seed: int) -> FloatArray:
    """A loop that turns once, waved along and rough from vertex to vertex."""
    rng, n = np.random.default_rng(seed), len(loop.rest_lengths)
    place = 2 * np.pi * np.arange(n) / n
    phase = rng.uniform(0.0, 2 * np.pi, 4)
    waves = rng.normal(0.0, 0.3, 4) @ np.cos(np.outer([2, 3, 4, 5], place) + phase[:, None])
    angle = place + waves
    steps = np.stack([np.cos(angle), np.sin(angle)], axis=1) / n
    x = np.cumsum(steps, axis=0) + rng.normal(0.0, 0.1 / n, (n, 2))
    found = close_with_lengths(loop, x)
    assert found is not None
    return found


def energy_of(energy: LoopEnergy, x: FloatArray) -> float:
    return energy.change(np.zeros_like(x), x)


def unseen(polygon: FloatArray) -> None:
    """Nobody looks."""


@pytest.mark.parametrize("edges", [64, 150])
@pytest.mark.parametrize("sigma_hat", [1000.0, 1600.0, 2400.0])
def test_twenty_random_starts_come_to_one_minimum(sigma_hat: float, edges: int) -> None:
    loop = even(edges)
    energy = energy_in_plane(loop, sigma_hat)
    energies = []
    for seed in range(20):
        found = minimum_in_plane(loop, sigma_hat, waved(loop, seed), 500, unseen)
        assert found is not None
        flat, spectrum = found
        model = tangent_model(energy, flat.x)
        assert model.residual < 1e-9
        assert spectrum.n_unstable == (model.eigenvalues < 0).sum() == 0
        energies.append(energy_of(energy, flat.x))
    # Where on its curve the vertices of a loop come to lie makes a difference.
    assert np.ptp(energies) < 1e-4 * energies[0]


@pytest.mark.parametrize("edges", EDGES)
@pytest.mark.parametrize("sigma_hat", [1400.0, 1600.0, 2000.0, 2400.0])
def test_lowest_eigenvalue_is_that_of_the_whole_matrix(
    sigma_hat: float, edges: int
) -> None:
    loop = even(edges)
    energy = energy_in_plane(loop, sigma_hat)
    found = minimum_in_plane(loop, sigma_hat, waved(loop, 1), 500, unseen)
    assert found is not None
    exact = stability(tangent_model(energy, found[0].x))
    assert found[1].lowest == pytest.approx(exact.lowest, rel=1e-6)
    assert found[1].n_unstable == exact.n_unstable == 0
    assert found[1].n_neutral == exact.n_neutral == 0


@pytest.mark.parametrize("edges", [60, 150])
@pytest.mark.parametrize("lobes", [2, 3])
def test_saddles_are_left(lobes: int, edges: int) -> None:
    """From the disk, and from three lobes, both exact equilibria with negative modes."""
    loop, load = even(edges), 4500.0 if lobes == 3 else 1600.0
    energy = energy_in_plane(loop, load)
    turns = 2 * np.pi * np.arange(edges) / edges
    start = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    start /= 2 * edges * np.sin(np.pi / edges)
    if lobes == 3:
        guess = planar_film(3, 4500.0).positions(np.arange(edges) / edges)
        saddle = settle_in_plane(loop, load, guess, 20)
        assert saddle is not None
        start = saddle.x
    model = tangent_model(energy, start)
    assert model.residual < 1e-9
    assert model.eigenvalues[0] < 0
    found = minimum_in_plane(loop, load, start, 500, unseen)
    assert found is not None
    assert energy_of(energy, found[0].x) < energy_of(energy, start) - 1e-3
    assert tangent_model(energy, found[0].x).eigenvalues[0] > 0


def test_uneven_edges_come_to_the_same_film() -> None:
    exact = planar_film(2, 2000.0).energy
    errors = []
    for edges in (60, 120, 240):
        place = np.arange(edges) / edges
        lengths = 1 + 0.6 * np.cos(2 * np.pi * place + 1)
        loop = Loop(lengths / lengths.sum())
        energy = energy_in_plane(loop, 2000.0)
        found = minimum_in_plane(loop, 2000.0, waved(loop, 3), 500, unseen)
        assert found is not None
        model = tangent_model(energy, found[0].x)
        assert model.residual < 1e-8
        scale = float(np.abs(model.tensions).max())
        np.testing.assert_allclose(found[0].tensions, model.tensions, atol=1e-8 * scale)
        errors.append(energy_of(energy, found[0].x) - exact)
    assert shapes.fitted_order([1 / 60, 1 / 120, 1 / 240], errors) == pytest.approx(
        2.0, abs=0.1
    )


def test_three_edges_cannot_move() -> None:
    loop = Loop(np.array([0.3, 0.4, 0.3]))
    start = close_with_lengths(loop, np.array([[0.0, 0.0], [0.3, 0.0], [0.0, 0.3]]))
    assert start is not None
    found = minimum_in_plane(loop, 100.0, start, 500, unseen)
    assert found is not None
    np.testing.assert_allclose(found[0].x, start, atol=1e-14)
    assert found[1].lowest == np.inf


@pytest.mark.parametrize("sigma_hat", [1600.0, 2400.0])
def test_mesh_follows_without_folding_and_stays_good(sigma_hat: float) -> None:
    points, triangles = shapes.disk_points(14, jitter=0.1)
    mesh = shapes.mesh_of(points * [1.4, 0.7], triangles)
    problem = Problem(mesh, "area", in_plane=True)
    found = solve(problem, sigma_hat, mesh.x)
    assert found.status is Status.CONVERGED
    sides = area(mesh).tiling(found.shape.triangles).sides(found.shape.x)
    assert (sides.normals @ [0, 0, 1] > 0.999).all()
    assert sides.smallest_angle > 12


def test_fan_about_one_vertex_needs_no_better_mesh() -> None:
    """Its energy is the polygon's, and the same as with any inside."""
    points, triangles = shapes.disk_points(12)
    mesh = shapes.mesh_of(points * [1.4, 0.7], triangles)
    spokes = np.arange(mesh.n_b)
    fan = Disk.from_triangles(
        np.concatenate([np.zeros((1, 3)), mesh.x[mesh.loop]]),
        np.stack([0 * spokes, 1 + spokes, 1 + (spokes + 1) % mesh.n_b], axis=1),
    )
    energies = []
    for inside in (mesh, fan):
        problem = Problem(inside, "area", in_plane=True)
        found = solve(problem, 2400.0, inside.x)
        assert found.status is Status.CONVERGED
        energies.append(found.energy)
    np.testing.assert_array_equal(found.shape.triangles, fan.triangles)
    assert energies[1] == pytest.approx(energies[0], rel=1e-12)


def test_coarse_loop_that_leads_to_a_saddle_is_not_believed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Here to the circle, beyond the tension at which it turns oval."""
    load = 2000.0
    loop, circle = ring(4 * COARSE)
    flat = circle[:, :2]
    chain = Chain(loop, load)
    monkeypatch.setattr(
        newton, "_find_coarse_minimum", lambda *arguments: (chain.angles(flat), 5)
    )
    found = minimum_in_plane(loop, load, flat * [1.1, 0.9], 500, unseen)
    assert found is not None
    film, stability = found
    assert stability.n_unstable == 0
    assert np.ptp(film.x, axis=0).max() > 1.2 * np.ptp(flat, axis=0).max()
