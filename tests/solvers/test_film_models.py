"""A soap film and its loop in one sparse matrix, against the dense model of its loop."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.film import AreaOfLoop
from eulerplateau.loop import Loop, close_with_lengths
from eulerplateau.mesh.disk import Disk
from eulerplateau.solvers import Problem, soap, solve, stability
from eulerplateau.solvers.equilibrium import Status
from eulerplateau.solvers.large_loops.film_models import FilmModel, FilmModels
from tests.helpers import shapes, soap_films

# sigma_hat: the flat disk is stable below 48 pi^3 = 1488, and loses two more pairs of modes
# up to 3000, of which one leads out of the plane.
STABLE, BELOW, ABOVE = 1200.0, 1700.0, 3100.0


@pytest.fixture(scope="module")
def problem() -> Problem:
    return Problem(soap_films.irregular_disk(9), "area")


def model_at(problem: Problem, x: FloatArray, load: float) -> FilmModel:
    """Near the shape with these positions, its loop closed."""
    x_loop = close_with_lengths(problem.loop, x[problem.disk.loop])
    assert x_loop is not None
    shape = problem.film.carried(problem.disk.shape.moved(x), x_loop)
    film = problem.film.of_loop(problem.film.prepared(shape))
    assert isinstance(film, AreaOfLoop)
    energy = film.energy(problem.loop, load)
    return FilmModels(energy, film, problem.loop, load).at(x_loop)


def saddle(mesh: Disk, height: float = 1.5) -> FloatArray:
    """A film bent so far that its strip makes a difference."""
    x = mesh.x * [1.1, 0.9, 1.0]
    x[:, 2] += height * x[:, 0] * x[:, 1]
    return x


def test_loop_without_its_matrix_is_that_of_its_matrix(oval: Disk) -> None:
    loop = Loop(oval.rest_lengths * np.linspace(0.8, 1.2, oval.n_b))
    tensions = np.random.default_rng(1).standard_normal(oval.n_b)
    whole = 2 * loop.bending_matrix + loop.tension_stiffness(tensions)
    chain, v = loop.chain(tensions), np.arange(oval.n_b)
    for step in range(3):
        there = whole[v, (v + step) % oval.n_b]
        np.testing.assert_allclose(chain[step], there, atol=1e-13 * np.abs(whole).max())


@pytest.mark.parametrize("load", [STABLE, BELOW, ABOVE])
@pytest.mark.parametrize("bent", [False, True])
def test_as_many_ways_lead_down_as_the_dense_spectrum_has_below_zero(
    problem: Problem, load: float, bent: bool
) -> None:
    mesh = problem.disk
    model = model_at(problem, saddle(mesh) if bent else mesh.x, load)
    factor = model.factorised(strip=True)
    assert factor is not None
    assert model.n_below(factor) == int((model.dense.eigenvalues < 0).sum())


@pytest.mark.parametrize("strip", [False, True])
def test_forces_move_a_flat_loop_as_by_the_dense_hessian(
    problem: Problem, strip: bool
) -> None:
    model = model_at(problem, problem.disk.x * [1.1, 0.9, 1.0], BELOW)
    assert moves_as_dense(model, strip) < 1e-8


def test_forces_move_a_curved_loop_so_with_its_strip_and_nearly_so_without(
    problem: Problem,
) -> None:
    model = model_at(problem, saddle(problem.disk), BELOW)
    assert moves_as_dense(model, strip=True) < 1e-8
    assert 1e-6 < moves_as_dense(model, strip=False) < 0.3


def moves_as_dense(model: FilmModel, strip: bool) -> float:
    """The relative difference of what the two inverses make of forces."""
    factor, dense = model.factorised(strip), model.dense
    assert factor is not None
    forces = np.random.default_rng(2).standard_normal((model.x.size, 3))
    moved = model.moved(factor, forces)
    by_columns = dense.coordinates.slope(forces)
    expected = dense.coordinates.displacement(np.linalg.solve(dense.hessian, by_columns))
    return float(np.abs(moved - expected).max() / np.abs(expected).max())


def test_step_keeps_the_lengths_and_promises_what_the_dense_model_does(
    problem: Problem,
) -> None:
    model = model_at(problem, problem.disk.x * [1.05, 0.95, 1.0], STABLE)
    step, dense = model.newton_step(10.0), model.dense.newton_step(10.0)
    assert step is not None
    assert dense is not None
    np.testing.assert_allclose(
        step.moved, dense.moved, atol=1e-8 * np.abs(dense.moved).max()
    )
    assert step.size == pytest.approx(dense.size, rel=1e-8)
    assert step.promised == pytest.approx(dense.promised, rel=1e-8)
    # Cut short it promises what the model says of it.
    half, part = model.newton_step(0.5 * step.size), 0.5
    assert half is not None
    assert half.size == pytest.approx(0.5 * step.size)
    curved = -step.promised
    slope = 2 * step.promised
    assert half.promised == pytest.approx(part * slope + part**2 * curved)


def test_near_rest_a_step_by_the_matrix_of_the_loop_before_is_as_good(
    problem: Problem,
) -> None:
    found = solve(problem, STABLE, problem.disk.x * [1.05, 0.95, 1.0])
    film = problem.film.of_loop(found.shape)
    assert isinstance(film, AreaOfLoop)
    models = FilmModels(film.energy(problem.loop, STABLE), film, problem.loop, STABLE)

    def away(size: float) -> FilmModel:
        moved = found.shape.x_loop + shapes.wave(problem.disk.n_b, size)
        x = models.energy.constraint.project(moved)
        assert x is not None
        return models.at(x, models.at(x))

    # Not farther from rest, where it would leave more than rounding.
    assert away(1e-4).near is None
    model = away(1e-12)
    assert model.residual < 1e-8
    before = models.at(found.shape.x_loop + 0)
    lent, own = replace(model, near=before), replace(model, near=None)
    step, expected = lent.newton_step(1.0), own.newton_step(1.0)
    assert step is not None
    assert expected is not None
    assert "bare" not in lent.__dict__
    np.testing.assert_allclose(step.moved, expected.moved, atol=1e-4 * expected.size)


def test_what_is_factorised_is_kept_for_the_same_load_and_tensions(
    problem: Problem,
) -> None:
    model = model_at(problem, problem.disk.x * [1.05, 0.95, 1.0], STABLE)
    again = replace(model)
    assert model.bare is again.bare
    assert model.factorised(strip=True) is not model.bare
    assert replace(model, load=BELOW).bare is not model.bare
    assert replace(model, tensions=1.1 * model.tensions).bare is not model.bare


def test_no_newton_step_leads_to_a_saddle(problem: Problem) -> None:
    assert model_at(problem, problem.disk.x, BELOW).newton_step(10.0) is None


def test_far_from_a_saddle_the_step_is_that_of_a_shifted_hessian(problem: Problem) -> None:
    """It promises what the dense model says of it, and the energy falls by about that."""
    model = model_at(problem, problem.disk.x * [1.05, 0.95, 1.0], 2500.0)
    assert model.residual > 1e-2
    assert model.dense.eigenvalues[0] < 0
    step = model.newton_step(1e-4)
    assert step is not None
    assert step.size == pytest.approx(1e-4)
    said = model.dense.step(model.dense.coefficients(step.moved))
    assert step.promised == pytest.approx(said.promised, rel=1e-8)
    x = model.energy.constraint.project(model.x + step.moved)
    assert x is not None
    fallen = model.energy.change(model.x, x - model.x)
    assert step.promised < 0
    assert fallen == pytest.approx(step.promised, rel=0.05)


@pytest.mark.parametrize("bent", [False, True])
def test_lowest_eigenvalue_is_the_dense_one_within_its_bound(
    problem: Problem, bent: bool
) -> None:
    mesh = problem.disk
    model = model_at(problem, saddle(mesh, 0.3) if bent else mesh.x, STABLE)
    found, expected = model.spectrum(), stability(model.dense)
    assert expected.n_unstable == 0
    assert len(found.eigenvalues) == 1
    assert found.lowest == pytest.approx(expected.lowest, abs=found.error_bound, rel=1e-9)
    # Bending's largest row stands for the largest eigenvalue, to which a film adds little.
    assert 0.98 * expected.error_bound < found.error_bound < 2 * expected.error_bound


def test_where_ways_lead_down_the_whole_spectrum_is_given(problem: Problem) -> None:
    model = model_at(problem, problem.disk.x, BELOW)
    found = model.spectrum()
    assert found.n_unstable == 2
    np.testing.assert_array_equal(found.eigenvalues, model.dense.eigenvalues)


def test_a_solve_comes_to_what_it_comes_to_without_the_sparse_matrix(
    problem: Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    start = shapes.crumpled(problem.disk, 2e-3) * [1.25, 0.8, 1.0]
    sparse = solve(problem, BELOW, start)
    monkeypatch.setattr(soap, "_DENSE", 1000)
    dense = solve(problem, BELOW, start)
    for found in (sparse, dense):
        assert found.status is Status.CONVERGED
    assert sparse.energy == pytest.approx(dense.energy, rel=1e-11)
    assert sparse.lowest_eigenvalue == pytest.approx(dense.lowest_eigenvalue, rel=1e-6)
