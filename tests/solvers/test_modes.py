"""Critical modes beside the shape, and neutral ones reported as neutral."""

from __future__ import annotations

import json

import numpy as np
import pytest

from eulerplateau.runs.spec import RunSpec
from eulerplateau.runs.sweep import run_sweep
from eulerplateau.settings import validate
from eulerplateau.solvers import (
    Problem,
    lowest_modes,
    quadratic_models,
    solve,
    tangent_model,
)
from tests.conftest import ROOT
from tests.helpers.equilibria import loop_energy


@pytest.mark.parametrize("dense", [True, False])
def test_lowest_mode_has_the_lowest_eigenvalue_and_keeps_lengths(
    elongated, monkeypatch, dense
):
    problem = Problem(elongated)
    found = solve(problem, 700.0, elongated.x)
    if not dense:
        monkeypatch.setattr(quadratic_models, "DENSE_LOOP", 40)
    mode = lowest_modes(problem, found, 1)["mode_0"]
    assert np.linalg.norm(mode, axis=1).max() == pytest.approx(1.0)
    loop = problem.disk.loop
    model = tangent_model(loop_energy(problem, 700.0), found.shape.x_loop)
    coefficients = model.basis.T @ (mode[loop].ravel() * model.scale)
    size = float(coefficients @ coefficients)
    # Nothing of it is a rigid motion or changes a length: it lies in the tangent space.
    assert size == pytest.approx(float(np.sum((mode[loop].ravel() * model.scale) ** 2)))
    quotient = float(coefficients @ model.hessian @ coefficients) / size
    assert quotient == pytest.approx(found.lowest_eigenvalue, rel=1e-6)


def test_mode_of_the_planar_film_at_its_onset_is_transverse(elongated):
    problem = Problem(elongated)
    found = solve(problem, 671.0, elongated.x)
    mode = lowest_modes(problem, found, 1)["mode_0"]
    assert np.sum(mode[:, 2] ** 2) == pytest.approx(np.sum(mode**2), rel=1e-9)


def run(tmp_path, **sections):
    data = {"mesh": {"file": str(ROOT / "meshes" / "hexagon.vtp")}, **sections}
    return run_sweep(validate(data, RunSpec, "test"), tmp_path / "run")


def test_turning_of_the_hexagons_saddle_is_reported_as_neutral(tmp_path):
    """Just above its onset the saddle turns in its plane for less than rounding shows."""
    result = run(tmp_path, sweep={"loads": [800.0, 853.0, 1000.0]})
    assert result.neutral == (1,)
    assert result.rows[1].n_unstable == 0
    summary = json.loads((tmp_path / "run" / "run.json").read_text())
    assert summary["totals"]["neutral"] == [1]


def test_modes_are_written_when_asked_for(tmp_path):
    run(tmp_path, sweep={"loads": [800.0]}, output={"modes": 2})
    text = (tmp_path / "run" / "shapes" / "shape_0000.vtp").read_bytes()
    assert b'"mode_1"' in text
    assert b'"mode_2"' not in text


def test_limit_of_the_dense_model_is_above_the_papers_mesh(elongated):
    assert elongated.n_b < quadratic_models.DENSE_LOOP
