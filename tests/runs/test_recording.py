"""Rows: every number of an equilibrium in its own column, in the units it was promised."""

from __future__ import annotations

from dataclasses import asdict, fields, replace

import numpy as np
import pytest

from eulerplateau.film import SPRING_LOAD, TENSION, Load
from eulerplateau.mesh import measure
from eulerplateau.mesh.disk import Disk
from eulerplateau.runs.rows import Row, make_row
from eulerplateau.solvers import Equilibrium, Problem, Stability, Status, solve
from tests.helpers.shapes import disk_points, fitted_order, mesh_of


def row_of(found: Equilibrium, disk: Disk, load: Load) -> Row:
    return make_row(0, found, load, Row, asdict(measure(disk, found.shape)))


def at_rest(problem: Problem, load: float) -> Equilibrium:
    """The rest shape, as a record."""
    shape, none = problem.disk.shape, np.zeros(problem.disk.n_b)
    return problem.equilibrium(shape, none, load, Status.CONVERGED)


def test_film_energy_of_a_soap_film_is_its_tension_times_its_area(oval: Disk) -> None:
    problem = Problem(oval, "area")
    for load in (300.0, 1000.0):
        found = solve(problem, load)
        assert found.converged
        row = row_of(found, oval, TENSION)
        assert row.load == row.sigma_hat == load
        assert row.kL3_alpha == pytest.approx(load / np.sqrt(12), rel=1e-15)
        assert row.film_energy == pytest.approx(row.sigma_hat * row.area, rel=1e-12)
        assert row.energy == pytest.approx(row.film_energy + row.bending_energy, rel=1e-15)


@pytest.mark.parametrize("film", ["springs", "area"])
def test_bending_energy_of_a_bare_circle_goes_to_four_pi_squared(film: str) -> None:
    """With no film, 4 n^2 sin^2(pi / n) of a regular n-gon: an error of second order."""
    load = TENSION if film == "area" else SPRING_LOAD
    sizes, errors = [], []
    for rings in (3, 6, 12):
        problem = Problem(mesh_of(*disk_points(rings)), film)
        row = row_of(at_rest(problem, 0.0), problem.disk, load)
        assert row.film_energy == 0
        sizes.append(1 / problem.disk.n_b)
        errors.append(4 * np.pi**2 - row.bending_energy)
    assert 0 < errors[-1] < 0.03
    assert fitted_order(sizes, errors) == pytest.approx(2.0, abs=0.02)


def test_every_number_of_an_equilibrium_is_in_the_column_of_its_name(
    oval: Disk, oval_problem: Problem
) -> None:
    """Numbers that all differ: no two columns can be swapped."""
    told = {
        "energy": 3.0, "film_energy": 1.25, "bending_energy": 1.75, "residual": 1e-7,
        "film_residual": 2e-8, "length_error": 3e-9, "iterations": 17, "seconds": 0.5,
    }  # fmt: skip
    stability = Stability(np.array([-5.0, -4.0, 0.25]), 1e-3)
    record = at_rest(oval_problem, 100.0)
    found = replace(record, **told, status=Status.SADDLE, stability=stability)
    row = row_of(found, oval, SPRING_LOAD)
    assert {name: getattr(row, name) for name in told} == told
    assert (row.n_unstable, row.lowest_eigenvalue) == (2, -5.0)
    assert row.status is Status.SADDLE
    assert not row.converged
    assert row.load == row.kL3_alpha == 100.0
    measured = asdict(measure(oval, found.shape))
    assert {name: getattr(row, name) for name in measured} == measured
    # Nothing else is in a row.
    others = {"step", "kL3_alpha", "sigma_hat", "n_unstable", "lowest_eigenvalue", "status"}
    names = {field.name for field in fields(Row)} - {"quantity"}
    assert names == told.keys() | measured.keys() | others
