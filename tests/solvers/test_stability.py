"""Spectra of rings and thresholds of disks against analysis; what rounding leaves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.film.load import SPRING_TENSION
from eulerplateau.mesh.disk import Disk
from eulerplateau.solvers import (
    Problem,
    Stability,
    Status,
    TangentModel,
    solve,
    stability,
    tangent_model,
    with_stability,
)
from tests.helpers import equilibria, shapes
from tests.helpers.equilibria import loop_energy

# Mode n of an inextensible ring with energy int |x''|^2 ds and radius R = 1 / 2 pi, in the
# norm int |p|^2 ds. The tension -2/R^2 balances the ring, so that the second variation is
# 2 int (|p''|^2 - |p'|^2 / R^2) ds. Across the plane p = cos(n theta) e_z gives
# 2 n^2 (n^2 - 1) / R^4. In the plane p = u t + v n with u' = v / R has p' = phi n, which
# leaves 2 int phi'^2 ds, and v = cos(n theta) gives 2 n^2 (n^2 - 1)^2 / (n^2 + 1) / R^4.
# Each occurs twice.
R4 = (2 * np.pi) ** 4


def across(n: int) -> float:
    return 2 * n**2 * (n**2 - 1) * R4


def within(n: int) -> float:
    return 2 * n**2 * (n**2 - 1) ** 2 / (n**2 + 1) * R4


def disk_problem(rings: int) -> tuple[Disk, Problem]:
    """A disk whose film is exactly the Dirichlet energy; the load is sigma_hat."""
    mesh = shapes.mesh_of(*shapes.disk_points(rings))
    return mesh, Problem(mesh, "dirichlet")


def split(model: TangentModel, n: int) -> tuple[FloatArray, FloatArray]:
    """Eigenvalues of modes in the plane and across it, each ascending."""
    values, vectors = model.eigen
    across = np.array(
        [
            np.abs(model.displacement(vector)[:, 2]).max()
            > np.abs(model.displacement(vector)[:, :2]).max()
            for vector in vectors.T
        ]
    )
    return values[~across][:n], values[across][:n]


@pytest.mark.parametrize("n", [2, 3, 4])
def test_spectrum_of_a_free_ring_converges_to_the_analytic_one_at_second_order(
    n: int,
) -> None:
    sizes, errors = [24, 48, 96], []
    for n_b in sizes:
        loop, x = equilibria.ring(n_b)
        model = tangent_model(equilibria.quadratic_energy(loop), x)
        assert model.residual < 10 * model.rounding
        np.testing.assert_allclose(model.tensions, -8 * np.pi**2, rtol=10 / n_b**2)
        flat, high = (values[2 * n - 4 : 2 * n - 2] for values in split(model, 6))
        assert flat[1] == pytest.approx(flat[0], rel=1e-8)
        assert high[1] == pytest.approx(high[0], rel=1e-8)
        errors.append((flat[0] / within(n) - 1, high[0] / across(n) - 1))
    for column in np.array(errors).T:
        order = -shapes.fitted_order([float(n_b) for n_b in sizes], list(column))
        assert order == pytest.approx(2.0, abs=0.1)
        assert abs(column[-1]) < 10 * (n / sizes[-1]) ** 2


def test_spectrum_of_a_free_ring_has_no_zero_and_starts_with_the_planar_ellipse() -> None:
    loop, x = equilibria.ring(96)
    model = tangent_model(equilibria.quadratic_energy(loop), x)
    expected = sorted(2 * [within(2), across(2), within(3), across(3)])
    np.testing.assert_allclose(model.eigen[0][:8], expected, rtol=0.01)


@pytest.mark.parametrize("n", [2, 3])
def test_disk_loses_transverse_mode_n_at_16_pi_cubed_n_n_plus_1_at_second_order(
    n: int,
) -> None:
    """Across the plane bending and tension of the loop give 2 n^2 (n^2 - 1) / R^4, the film
    sigma n (1 - n) / R."""
    sizes, errors = [6, 12, 24], []
    for rings in sizes:
        errors.append(threshold(rings, "across", n) / (16 * np.pi**3 * n * (n + 1)) - 1)
    assert -shapes.fitted_order([float(r) for r in sizes], errors) == pytest.approx(
        2.0, abs=0.15
    )
    assert abs(errors[-1]) < 0.005 * n


@pytest.mark.parametrize("n", [2, 3])
def test_dirichlet_disk_loses_planar_mode_n_where_the_harmonic_map_says(n: int) -> None:
    """At 16 pi^3 n^2 (n^2 - 1) / (n^2 - n - 1); a soap film does at 16 pi^3 (n^2 - 1).

    As a complex number p has the harmonics 1 + n and 1 - n, of amplitudes (1 -+ 1/n) / 2:
    the film adds pi sigma (n^2 - 1)/n, the tension it puts into the loop takes
    pi sigma (n^2 - 1)^2 / n^2 away, and bending holds with 2 pi (n^2 - 1)^2 / R^3. The area
    itself is lower than this energy where the map is not conformal, so a soap film gives
    way four times earlier; across the plane the two agree.
    """
    sizes, errors = [6, 12, 24], []
    expected = 16 * np.pi**3 * n**2 * (n**2 - 1) / (n**2 - n - 1)
    for rings in sizes:
        errors.append(threshold(rings, "within", n) / expected - 1)
    assert -shapes.fitted_order([float(r) for r in sizes], errors) == pytest.approx(
        2.0, abs=0.15
    )
    assert abs(errors[-1]) < 0.02


def threshold(rings: int, where: str, n: int) -> float:
    """Load at which the double mode n of a disk reaches zero.

    The disk is in equilibrium at every load, and its Hessian is linear in the load: in the
    modes of the symmetric mesh two loads near the threshold give it.
    """
    mesh, problem = disk_problem(rings)
    base = (
        16
        * np.pi**3
        * (n * (n + 1) if where == "across" else n**2 * (n**2 - 1) / (n**2 - n - 1))
    )
    x = mesh.x[mesh.loop]
    pair = []
    for load in (0.95 * base, 1.05 * base):
        model = tangent_model(loop_energy(problem, load), x)
        assert model.residual < 10 * model.rounding
        pair.append(near_zero(model, x, where, n))
    low, high = pair
    return float(base * (0.95 + 0.1 * low / (low - high)))


def near_zero(model: TangentModel, x: FloatArray, where: str, n: int) -> float:
    """The Rayleigh quotient of the eigenvectors most like the continuum's mode n."""
    theta = np.arctan2(x[:, 1], x[:, 0])
    normal = -np.stack([np.cos(theta), np.sin(theta)], axis=1)
    tangent = np.stack([-np.sin(theta), np.cos(theta)], axis=1)
    mode = np.zeros_like(x)
    if where == "across":
        mode[:, 2] = np.cos(n * theta)
    else:
        mode[:, :2] = np.cos(n * theta)[:, None] * normal
        mode[:, :2] += (np.sin(n * theta) / n)[:, None] * tangent
    values, vectors = model.eigen
    overlap = (vectors.T @ (model.basis.T @ (model.scale * mode.ravel()))) ** 2
    return float(values[np.argmax(overlap)])


def onset(mesh: Disk) -> float:
    """Load k at which the planar film first gives way, by bisection."""
    problem, low, high = Problem(mesh), 700.0, 900.0
    x = equilibria.planar(problem, [100, 300, 500, low])[-1].x
    while high - low > 1e-3:
        middle = 0.5 * (low + high)
        model = equilibria.critical_point(loop_energy(problem, middle), x)
        if model.eigen[0][0] > 0:
            low, x = middle, model.x
        else:
            high = middle
    return 0.5 * (low + high)


def test_hexagonal_lattice_leaves_the_plane_within_a_percent_of_the_disks_threshold() -> (
    None
):
    """2 sqrt 3 k is its exact tension, but the map from the hexagon is not the disk's.

    So the limit is not 96 pi^3 itself but a number near it, approached at second order:
    the limits extrapolated from two pairs of meshes agree ten times better.
    """
    coarse, middle, fine = (
        SPRING_TENSION * onset(shapes.mesh_of(*shapes.hexagon_points(r)))
        for r in (3, 6, 12)
    )
    assert fine == pytest.approx(96 * np.pi**3, rel=0.01)
    assert np.log2((middle - coarse) / (fine - middle)) == pytest.approx(2.0, abs=0.2)
    limits = [middle + (middle - coarse) / 3, fine + (fine - middle) / 3]
    assert limits[0] == pytest.approx(limits[1], rel=0.001)


def test_neutral_and_unstable_are_told_apart_by_the_error_bound() -> None:
    found = Stability(np.array([-2.0, -1e-9, 1e-9, 3.0]), 1e-8)
    assert (found.n_unstable, found.n_neutral, found.lowest) == (1, 2, -2.0)


def test_rounding_is_blinding_from_a_tenth_of_the_bare_circles_lowest_eigenvalue() -> None:
    """And only where it hides an eigenvalue; what converged blindly has stalled."""
    values = np.array([0.0, 10 * within(2)])
    below, above = (Stability(values, part * within(2)) for part in (0.0999, 0.1001))
    assert (below.n_neutral, above.n_neutral) == (1, 1)
    assert not below.blind
    assert above.blind
    assert not Stability(values[1:], above.error_bound).blind
    problem = Problem(shapes.mesh_of(*shapes.disk_points(3)))
    found = solve(problem, 1.0)
    assert found.status is Status.CONVERGED
    assert with_stability(found, below).status is Status.CONVERGED
    assert with_stability(found, above).status is Status.STALLED


def test_loop_without_freedom_is_stable() -> None:
    loop, x = equilibria.ring(3)
    model = tangent_model(equilibria.quadratic_energy(loop), x)
    found = stability(model)
    assert (found.n_unstable, found.n_neutral, found.lowest) == (0, 0, np.inf)


def test_error_bound_covers_what_a_rotation_changes_the_eigenvalues_by(
    oval_problem: Problem,
) -> None:
    """Exactly equal but for rounding, and rounding is what the bound is for."""
    energy = loop_energy(oval_problem, 700.0)
    model = equilibria.planar(oval_problem, [300.0, 700.0])[-1]
    here = stability(model)
    turned = stability(tangent_model(energy, model.x @ shapes.rotation().T))
    # The largest have lost what the Gram matrix of the edges' turns costs them.
    allowed = 10 * here.error_bound + 1e-12 * np.abs(here.eigenvalues)
    assert (np.abs(here.eigenvalues - turned.eigenvalues) < allowed).all()
    assert here.error_bound < 1e-9 * here.eigenvalues[-1]


@pytest.mark.parametrize(("residual", "balanced"), [(1e-7, True), (1e-5, False)])
@pytest.mark.parametrize(("lowest", "end"), [(1.0, "CONVERGED"), (-1.0, "SADDLE")])
def test_stall_in_balance_is_an_equilibrium_a_minimum_or_a_saddle(
    residual: float, balanced: bool, lowest: float, end: str
) -> None:
    """And one out of balance is a stall, whatever its modes."""
    problem = Problem(shapes.mesh_of(*shapes.disk_points(3)))
    stalled = replace(solve(problem, 1.0), status=Status.STALLED, residual=residual)
    found = with_stability(stalled, Stability(np.array([lowest, 10.0]), 1e-9))
    assert found.status is (Status[end] if balanced else Status.STALLED)
    assert found.n_unstable == int(lowest < 0)
