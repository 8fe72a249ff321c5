"""The structured model of large loops against the dense one, which is the referee."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import Loop, LoopEnergy, length_metric, rigid_motions
from eulerplateau.loop.lengths import jacobian
from eulerplateau.mesh.disk import Disk
from eulerplateau.solvers import (
    Problem,
    TangentModel,
    quadratic,
    quadratic_models,
    solve,
    stability,
    tangent_model,
)
from eulerplateau.solvers.large_loops.coarse_start import coarsen
from eulerplateau.solvers.large_loops.shifted_inverse import shifted_inverse, tangent_space
from eulerplateau.solvers.large_loops.subspace_model import lowest_modes, subspace_model
from eulerplateau.solvers.trust_region import trust_region_step
from tests.helpers import equilibria, shapes
from tests.helpers.equilibria import loop_energy

STABLE_LOADS = {"ellipse": 600.0, "twisted": 700.0, "eight": 800.0, "bent": 2500.0}


def disk_film(n: int, sigma_hat: float) -> FloatArray:
    """Second derivatives of the relaxed film on a disk: |q| for the wave number q."""
    waves = np.abs(np.fft.fftfreq(n, 1 / n))
    unit = np.fft.ifft(waves[:, None] * np.fft.fft(np.eye(n), axis=0), axis=0).real
    return np.asarray(2 * np.pi * sigma_hat / n * 0.5 * (unit + unit.T))


@pytest.fixture(scope="module")
def problem(elongated: Disk) -> Problem:
    return Problem(elongated)


@pytest.fixture(scope="module")
def loop(problem: Problem) -> Loop:
    return problem.loop


def subspace(energy: LoopEnergy, loop: Loop, x: FloatArray) -> TangentModel:
    return subspace_model(energy, loop, energy.hessian(x), x)


@pytest.fixture(scope="module")
def states(elongated: Disk, problem: Problem) -> dict[str, TangentModel]:
    """Dense models: stable and unstable equilibria, and loops out of balance."""
    found = {}
    x = shapes.crumpled(elongated, 1e-3)
    for name, load in STABLE_LOADS.items():
        x = solve(problem, load, x).shape.x
        loop = x[elongated.loop]
        found[name] = tangent_model(loop_energy(problem, load), loop)
        found[f"{name}, other load"] = tangent_model(loop_energy(problem, 1.3 * load), loop)
    flat = equilibria.planar(problem, [500, 600, 650, 700, 750, 800, 1000])
    found["planar, at 700"] = flat[3]
    found["planar, at 1000"] = flat[-1]
    return found


@pytest.fixture(scope="module")
def energies(problem: Problem) -> dict[str, LoopEnergy]:
    loads = {
        **STABLE_LOADS,
        **{f"{name}, other load": 1.3 * load for name, load in STABLE_LOADS.items()},
        "planar, at 700": 700.0,
        "planar, at 1000": 1000.0,
    }
    return {name: loop_energy(problem, load) for name, load in loads.items()}


@pytest.fixture(
    params=[
        *STABLE_LOADS,
        *(f"{name}, other load" for name in STABLE_LOADS),
        "planar, at 700",
        "planar, at 1000",
    ]
)
def case(
    request: pytest.FixtureRequest,
    states: dict[str, TangentModel],
    energies: dict[str, LoopEnergy],
) -> tuple[LoopEnergy, TangentModel]:
    return energies[request.param], states[request.param]


def test_the_cases_hold_stable_and_unstable_states(states: dict[str, TangentModel]) -> None:
    indices = {name: stability(model).n_unstable for name, model in states.items()}
    assert all(indices[name] == 0 for name in STABLE_LOADS)
    assert indices["planar, at 700"] > 0
    assert indices["planar, at 1000"] > 0


def test_shifted_inverse_is_the_dense_one_and_counts_the_same_eigenvalues(
    loop: Loop, case: tuple[LoopEnergy, TangentModel]
) -> None:
    energy, dense = case
    space = tangent_space(loop, dense.x)
    operator = energy.lagrangian_hessian(dense.x, dense.tensions)
    operator /= space.root
    operator /= space.root[:, None]
    values = dense.eigen[0]
    right = np.random.default_rng(1).standard_normal((len(dense.x), 3, 2))
    between = -(values[[0, 2, 10]] + values[[1, 3, 11]]) / 2
    for shift in [-values[0] + 1e3, 1e5, *between]:
        inverse = shifted_inverse(space, operator, shift)
        assert inverse.n_below == np.sum(values < -shift)
        solved = inverse.solve(right).reshape(-1, 2)
        shifted = dense.hessian + shift * np.eye(len(values))
        expected = dense.basis @ np.linalg.solve(
            shifted, dense.basis.T @ right.reshape(-1, 2)
        )
        assert np.abs(solved - expected).max() < 1e-8 * np.abs(expected).max()


def test_lowest_eigenvalues_and_index_are_those_of_the_dense_model(
    loop: Loop, case: tuple[LoopEnergy, TangentModel]
) -> None:
    energy, dense = case
    expected = stability(dense)
    found, modes = lowest_modes(
        loop, energy.hessian(dense.x), subspace(energy, loop, dense.x)
    )
    assert found.n_unstable == expected.n_unstable
    assert found.n_neutral == expected.n_neutral
    m = len(found.eigenvalues)
    assert m > found.n_unstable + found.n_neutral
    assert found.error_bound < 2 * expected.error_bound
    np.testing.assert_allclose(
        found.eigenvalues, expected.eigenvalues[:m], rtol=0, atol=found.error_bound
    )
    # Its mode is the dense one, where the eigenvalue is single.
    first = dense.basis @ dense.eigen[1][:, 0]
    assert abs(first @ modes[:, 0]) == pytest.approx(1, abs=1e-7)


def test_basis_lies_in_the_tangent_space(
    loop: Loop, case: tuple[LoopEnergy, TangentModel]
) -> None:
    energy, dense = case
    model = subspace(energy, loop, dense.x)
    basis = model.basis
    np.testing.assert_allclose(basis.T @ basis, np.eye(basis.shape[1]), atol=1e-12)
    moved = basis / model.scale[:, None]
    assert np.abs(jacobian(loop, dense.x) @ moved).max() < 1e-9 * np.abs(moved).max()
    rigid = rigid_motions(dense.x) * model.scale[:, None]
    assert np.abs(rigid.T @ basis).max() < 1e-9 * np.abs(rigid).max()


def test_forces_and_tensions_are_those_of_the_dense_model(
    loop: Loop, case: tuple[LoopEnergy, TangentModel]
) -> None:
    energy, dense = case
    model = subspace(energy, loop, dense.x)
    scale = np.abs(dense.tensions).max()
    np.testing.assert_allclose(model.tensions, dense.tensions, atol=1e-9 * scale)
    assert abs(model.residual - dense.residual) < 1e-9


@pytest.mark.parametrize("radius", [1e-4, 1e-3, 1e-2, 0.1])
def test_steps_lower_the_model_nine_tenths_as_much_as_the_best_ones(
    loop: Loop, case: tuple[LoopEnergy, TangentModel], radius: float
) -> None:
    energy, dense = case
    if stability(dense).n_unstable == 0 and dense.residual < 1e-6:
        radius *= 1e-3  # The Newton step is nothing but rounding here.
    falls = []
    for model in (dense, subspace(energy, loop, dense.x)):
        values, vectors = model.eigen
        slope = vectors.T @ model.gradient
        step = trust_region_step(values, slope, radius)
        falls.append(-float(slope @ step + 0.5 * step @ (values * step)))
    noise = 1e-12 * energy.change(np.zeros_like(dense.x), dense.x)
    assert falls[1] <= falls[0] * (1 + 1e-6) + noise
    assert falls[1] >= 0.9 * falls[0] - noise


@pytest.mark.parametrize(("sigma_hat", "index"), [(2900.0, 0), (3050.0, 2)])
def test_double_eigenvalues_of_a_disk_are_counted_twice(
    sigma_hat: float, index: int
) -> None:
    # A disk loses its stability across the plane at 16 pi^3 n (n + 1), 2977 for n = 2.
    loop, x = equilibria.ring(100)
    energy = equilibria.quadratic_energy(loop, disk_film(100, sigma_hat))
    found, _ = lowest_modes(loop, energy.hessian(x), subspace(energy, loop, x))
    assert found.n_unstable == index
    assert found.n_neutral == 0
    m = len(found.eigenvalues)
    expected = stability(tangent_model(energy, x)).eigenvalues[:m]
    np.testing.assert_allclose(found.eigenvalues, expected, rtol=1e-7)


def set_dense_loop(monkeypatch: pytest.MonkeyPatch, largest: int) -> None:
    """Look at loops of more vertices on subspaces, and smooth them on a coarse one."""
    for module in (quadratic, quadratic_models):
        monkeypatch.setattr(module, "DENSE_LOOP", largest)


def test_newton_by_subspaces_reaches_what_the_dense_newton_reaches(
    elongated: Disk, problem: Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    start = shapes.crumpled(elongated, 1e-3)
    found = {}
    for name, largest in (("dense", elongated.n_b), ("subspace", 40)):
        set_dense_loop(monkeypatch, largest)
        x, found[name] = start, []
        for load in (1.0, 300.0, 650.0, 700.0, 800.0, 1500.0, 2500.0):
            found[name].append(solve(problem, load, x))
            x = found[name][-1].shape.x
    for dense, structured in zip(found["dense"], found["subspace"], strict=True):
        assert dense.converged
        assert structured.converged
        assert structured.n_unstable == 0
        assert structured.energy == pytest.approx(dense.energy, rel=1e-11)
        assert structured.lowest_eigenvalue == pytest.approx(
            dense.lowest_eigenvalue, rel=1e-5
        )


def test_a_saddle_that_turns_almost_for_free_does_not_stop_the_subspaces(
    hexagon: Disk, monkeypatch: pytest.MonkeyPatch
) -> None:
    set_dense_loop(monkeypatch, 40)
    problem = Problem(hexagon)
    x = shapes.crumpled(hexagon, 1e-3)
    for load in (800.0, 860.0, 900.0, 1000.0):
        found = solve(problem, load, x)
        assert found.converged
        assert found.iterations < 250  # half of what it may take
        x = found.shape.x


def test_bending_force_is_the_product_with_the_bending_matrix() -> None:
    rng = np.random.default_rng(3)
    loop = Loop(rng.uniform(0.5, 1.5, 40) / 40)
    x = rng.standard_normal((40, 3))
    expected = 2 * loop.bending_matrix @ x
    np.testing.assert_allclose(
        loop.bending_force(x), expected, rtol=0, atol=1e-13 * np.abs(expected).max()
    )


@pytest.mark.parametrize("n", [3, 4, 5, 60])
def test_length_metric_is_the_product_of_jacobians(n: int) -> None:
    rng = np.random.default_rng(n)
    loop, x = Loop(rng.uniform(0.5, 1.5, n) / n), rng.standard_normal((n, 3))
    rows = jacobian(loop, x)
    dense = rows / np.repeat(loop.mean_lengths, 3) @ rows.T
    right = rng.standard_normal((n, 2))
    metric = length_metric(loop, x)
    solution = np.linalg.solve(dense, right)
    np.testing.assert_allclose(metric.solve(right), solution, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(
        metric.solve(right[:, 0]), solution[:, 0], rtol=1e-9, atol=1e-12
    )


def test_coarse_loop_of_all_vertices_is_the_loop_itself(problem: Problem) -> None:
    energy = loop_energy(problem, 700.0)
    n = len(problem.loop.rest_lengths)
    coarse = coarsen(problem.loop, n)
    x = np.random.default_rng(0).standard_normal((n, 3))
    np.testing.assert_allclose(coarse.restrict(x), x, atol=1e-12)
    np.testing.assert_allclose(coarse.prolong(x), x, atol=1e-12)
    np.testing.assert_allclose(
        coarse.energy(energy).hessian(x), energy.hessian(x), atol=1e-9
    )


def test_coarse_energy_of_a_smooth_loop_converges_at_second_order() -> None:
    n = 480
    loop, x = equilibria.ring(n)
    fine = equilibria.quadratic_energy(loop, disk_film(n, 1e3))
    exact = fine.change(np.zeros_like(x), x)
    errors, sizes = [], [24, 48, 96]
    for n_c in sizes:
        coarse = coarsen(loop, n_c)
        kept = x[:: n // n_c]
        errors.append(
            abs(coarse.energy(fine).change(np.zeros_like(kept), kept) / exact - 1)
        )
    order = shapes.fitted_order([1 / size for size in sizes], errors)
    assert order == pytest.approx(2, abs=0.1)
