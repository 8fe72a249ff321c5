"""The second-order model of the condensed problem against the energy itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import LoopEnergy, project_lengths, rigid_motions
from eulerplateau.loop.lengths import Lengths, jacobian
from eulerplateau.mesh.disk import Disk
from eulerplateau.solvers import Problem, TangentModel, tangent_model
from tests.helpers import equilibria, shapes
from tests.helpers.equilibria import loop_energy

RNG = np.random.default_rng(8)
LOAD = 900.0


def model_at(problem: Problem, x_loop: FloatArray, load: float) -> TangentModel:
    return tangent_model(loop_energy(problem, load), x_loop)


def energy_of(problem: Problem, x_loop: FloatArray) -> float:
    """The energy as the kernels have it, on the relaxed film."""
    shape = equilibria.spanned(problem, x_loop)
    film = problem.film.energy_gradient(shape, LOAD)[0]
    return film + problem.bending_energy(shape)[0]


@pytest.fixture
def bent(oval: Disk, oval_problem: Problem) -> FloatArray:
    """A loop in space that keeps its lengths and is no equilibrium."""
    found = project_lengths(oval_problem.loop, shapes.crumpled(oval, 0.004)[oval.loop])
    assert found is not None
    return found


def test_basis_is_orthonormal_tangent_to_the_constraint_and_free_of_rigid_motions(
    oval_problem: Problem, bent: FloatArray
) -> None:
    model = model_at(oval_problem, bent, LOAD)
    n = len(bent)
    assert model.basis.shape == (3 * n, 2 * n - 6)
    np.testing.assert_allclose(model.basis.T @ model.basis, np.eye(2 * n - 6), atol=1e-12)
    rows = jacobian(oval_problem.loop, bent)
    for k in (0, n, 2 * n - 7):
        unit = np.zeros(2 * n - 6)
        unit[k] = 1.0
        step = model.displacement(unit)
        mass = np.repeat(oval_problem.loop.mean_lengths, 3)
        assert np.abs(rows @ step.ravel()).max() < 1e-10
        assert np.abs(rigid_motions(bent).T @ (mass * step.ravel())).max() < 1e-12
        # Coordinates in which the length of a step is that of integral |p|^2 ds.
        assert (mass * step.ravel() ** 2).sum() == pytest.approx(1.0)


def test_rigid_motions_keep_lengths_and_energy(
    oval_problem: Problem, bent: FloatArray
) -> None:
    motions = rigid_motions(bent)
    rows = jacobian(oval_problem.loop, bent)
    energy = loop_energy(oval_problem, LOAD)
    np.testing.assert_allclose(rows @ motions, 0, atol=1e-13)
    pull = energy.hessian(bent) @ bent
    assert np.abs(motions.T @ pull.ravel()).max() < 1e-12 * np.abs(pull).sum()
    assert np.linalg.matrix_rank(motions) == 6


def test_loop_energy_and_its_changes_are_those_of_the_kernels(
    oval_problem: Problem, bent: FloatArray
) -> None:
    energy = loop_energy(oval_problem, LOAD)
    pull = energy.hessian(bent) @ bent
    value = 0.5 * np.sum(bent * pull)
    assert value == pytest.approx(energy_of(oval_problem, bent), rel=1e-12)
    step = 1e-3 * RNG.standard_normal(bent.shape)
    after = energy_of(oval_problem, bent + step)
    assert energy.change(bent, step) == pytest.approx(after - value, rel=1e-9)
    # At 1e-12 the energies agree in all their digits, and their difference still has some.
    slope = float(np.sum(step * pull))
    assert energy.change(bent, 1e-9 * step) == pytest.approx(1e-9 * slope, rel=1e-6)


def leftovers(
    energy: LoopEnergy, model: TangentModel, p: FloatArray, sizes: list[float]
) -> tuple[list[float], list[float]]:
    """What the first and second order in t leave of the energy along a projected curve."""
    first, second = [], []
    for t in sizes:
        x = energy.constraint.project(model.x + t * model.displacement(p))
        assert x is not None
        change = energy.change(model.x, x - model.x)
        first.append(change - t * model.gradient @ p)
        second.append(first[-1] - 0.5 * t**2 * p @ model.hessian @ p)
    return first, second


@pytest.mark.parametrize("seed", range(3))
def test_gradient_and_hessian_have_taylor_slopes_2_and_3_along_projected_curves(
    oval_problem: Problem, bent: FloatArray, seed: int
) -> None:
    """Off equilibrium too, thanks to least-squares tensions: the projection bends the
    curve along the constraint's normals, and they leave no force there."""
    energy = loop_energy(oval_problem, LOAD)
    model = tangent_model(energy, bent)
    # Among the thirty softest modes: stiffer ones are nonlinear at a smaller amplitude.
    weights = np.random.default_rng(seed).standard_normal(30)
    p = model.eigen[1][:, :30] @ (weights / np.linalg.norm(weights))
    sizes = list(np.geomspace(3e-5, 1e-6, 8))
    first, second = leftovers(energy, model, p, sizes)
    assert shapes.fitted_order(sizes, first) == pytest.approx(2.0, abs=0.05)
    assert shapes.fitted_order(sizes, second) == pytest.approx(3.0, abs=0.05)


def test_second_derivative_of_the_energy_at_an_equilibrium_is_the_hessian(
    oval_problem: Problem,
) -> None:
    energy = loop_energy(oval_problem, LOAD)
    model = equilibria.planar(oval_problem, [300.0, LOAD])[-1]
    values, vectors = model.eigen
    for mode in (0, 1, 5, 20):
        t = 1e-4 / np.sqrt(1 + mode)
        change = 0.0
        for sign in (1, -1):
            x = energy.constraint.project(
                model.x + sign * t * model.displacement(vectors[:, mode])
            )
            assert x is not None
            change += energy.change(model.x, x - model.x)
        assert change / t**2 == pytest.approx(values[mode], rel=0.01)


def test_tensions_balance_the_forces_at_an_equilibrium(
    oval_problem: Problem,
) -> None:
    model = equilibria.planar(oval_problem, [300.0, LOAD])[-1]
    shape = equilibria.spanned(oval_problem, model.x)
    assert model.residual < 1e-11
    assert oval_problem.residual(shape, model.tensions, LOAD) < 1e-10
    # Euler's theorem for a quadratic energy: 2 E + sum lambda_v |e_v|^2 / s_v = 0.
    virial = np.sum(model.tensions * oval_problem.loop.rest_lengths)
    assert virial == pytest.approx(-2 * energy_of(oval_problem, model.x), rel=1e-9)


def test_model_turns_with_the_loop_and_stays_when_it_is_moved(
    oval_problem: Problem, bent: FloatArray
) -> None:
    here = model_at(oval_problem, bent, LOAD)
    there = model_at(oval_problem, bent @ shapes.rotation().T + [0.3, -0.2, 0.7], LOAD)
    scale = here.eigen[0][-1]
    np.testing.assert_allclose(there.eigen[0], here.eigen[0], atol=1e-11 * scale)
    tension = np.abs(here.tensions).max()
    np.testing.assert_allclose(there.tensions, here.tensions, atol=1e-9 * tension)


def test_triangle_with_two_interior_edges_has_no_freedom_left() -> None:
    """Three lengths and six rigid motions fix three vertices."""
    loop, x = equilibria.ring(3)
    model = tangent_model(equilibria.quadratic_energy(loop), x)
    assert model.hessian.shape == (0, 0)
    assert model.residual < 1e-13


class OneByOne(Lengths):
    """Lengths of edges that are not kept by turning."""

    def turns(self, x: FloatArray) -> None:  # type: ignore[override]
        return None


@pytest.mark.parametrize("plane", [False, True])
def test_model_by_turns_is_the_one_by_columns(
    oval: Disk, oval_problem: Problem, bent: FloatArray, plane: bool
) -> None:
    """Of a loop of uneven edges that is no equilibrium, and free to slide in its plane."""
    loop = oval_problem.loop
    x = bent[:, :2] if plane else bent
    kept = project_lengths(loop, x)
    assert kept is not None
    energy = (
        equilibria.energy_in_plane(loop, LOAD) if plane else loop_energy(oval_problem, LOAD)
    )
    one = tangent_model(energy, kept)
    other = tangent_model(replace(energy, constraint=OneByOne(loop)), kept)
    assert type(one.coordinates) is not type(other.coordinates)
    assert one.residual == pytest.approx(other.residual, rel=1e-8)
    largest = np.abs(other.tensions).max()
    np.testing.assert_allclose(one.tensions, other.tensions, atol=1e-9 * largest)
    np.testing.assert_allclose(one.eigenvalues, other.eigenvalues, rtol=1e-6)
