"""What rounding makes of a flat film is within the error that its row admits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import eulerplateau as ep
from eulerplateau.mesh.disk import Disk
from eulerplateau.runs.noise import FLAT_ERRORS, bend_error, without_noise
from eulerplateau.runs.rows import Row
from eulerplateau.solvers.equilibrium import Equilibrium, Status
from tests.runs.test_output import ROW

LOAD = 300.0


@pytest.fixture(scope="module")
def disk() -> Disk:
    return ep.mesh_polygon("stretched-hexagon", factor=1.5, vertices=60)


@pytest.fixture(scope="module")
def flat(disk: Disk) -> Equilibrium:
    return ep.solve(ep.Problem(disk), LOAD)


def row_of(disk: Disk, flat: Equilibrium, height: float, wave: int) -> Row:
    """The row of a flat film that waves of its loop have lifted out of its plane."""
    problem = ep.Problem(disk)
    loop = flat.shape.x_loop.copy()
    normal = np.linalg.svd(loop - loop.mean(axis=0))[2][2]
    angle = 2 * np.pi * wave * np.arange(disk.n_b) / disk.n_b
    loop += height * np.cos(angle)[:, None] * normal
    shape = problem.film.of_loop(flat.shape).shape(loop)
    found = ep.measure(disk, shape)
    return replace(
        ROW,
        sigma_hat=2 * np.sqrt(3) * LOAD,
        bending_energy=flat.bending_energy,
        residual=problem.residual(shape, flat.tensions, LOAD),
        lowest_eigenvalue=flat.lowest_eigenvalue,
        **{name: getattr(found, name) for name in FLAT_ERRORS},
    )


@pytest.mark.parametrize("wave", [2, 3, 5])
@pytest.mark.parametrize("height", [1e-12, 1e-9, 1e-6])
def test_a_film_out_of_balance_is_flat_within_its_error(
    disk: Disk, flat: Equilibrium, height: float, wave: int
) -> None:
    """Lifted by a wave it bends by some (2 pi wave)^2 height; its residual says so."""
    row = row_of(disk, flat, height, wave)
    assert row.abs_kappa_n > 0.3 * (2 * np.pi * wave) ** 2 * height
    for name, error in FLAT_ERRORS.items():
        assert abs(getattr(row, name)) <= error(row)


def test_a_curve_within_its_error_is_zero_and_any_other_is_left_alone() -> None:
    rows = [replace(ROW, residual=1e-12, lowest_eigenvalue=2e4, bending_energy=40.0)] * 3
    error = bend_error(rows[0])
    noise = np.array([0.5, -1.0, 0.1]) * error
    assert np.array_equal(without_noise(rows, noise, bend_error), np.zeros(3))
    for bent in (np.array([0.5, 2.0, 0.1]) * error, np.array([0.0, 1.0, 0.0])):
        assert without_noise(rows, bent, bend_error) is bent


def test_rows_that_say_nothing_do_not_decide() -> None:
    rows = [replace(ROW, residual=1e-12, lowest_eigenvalue=2e4, bending_energy=40.0)] * 3
    rows[1] = replace(rows[1], status=Status.STALLED)
    noise = np.array([1e-15, 1.0, np.nan])
    found = without_noise(rows, noise, bend_error)
    assert np.array_equal(found, [0.0, 1.0, np.nan], equal_nan=True)
    # One that says nothing but is noise itself does not set an axis's scale.
    noise = np.array([1e-15, -0.9 * bend_error(rows[0]), 1e-15])
    assert np.array_equal(without_noise(rows, noise, bend_error), np.zeros(3))
    nothing = np.full(3, np.nan)
    assert without_noise(rows, nothing, bend_error) is nothing


def test_next_to_a_bifurcation_nothing_is_known_and_in_balance_all_is() -> None:
    critical = replace(ROW, lowest_eigenvalue=0.0)
    assert bend_error(critical) == np.inf
    assert bend_error(replace(critical, residual=0.0)) == 0.0
