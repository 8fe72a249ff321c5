"""Sweeps: rows as they come, reproducible, independent of units, interruptible."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT

from eulerplateau.output.table import Row, read_rows
from eulerplateau.parameters import validate
from eulerplateau.runs.spec import RunSpec
from eulerplateau.runs.sweep import carry_out
from eulerplateau.solution import LENGTH_TOLERANCE, RESIDUAL_TOLERANCE


def spec(**sections: object) -> RunSpec:
    data = {
        "mesh": {"file": str(ROOT / "meshes" / "elongated.vtp")},
        "sweep": {"loads": [300.0, 660.0, 700.0, 800.0]},
        **sections,
    }
    return validate(data, RunSpec, "test")


def without_time(rows: list[Row]) -> list[dict[str, object]]:
    return [{**asdict(row), "seconds": None} for row in rows]


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return carry_out(spec(), tmp_path_factory.mktemp("sweep") / "run")


def test_disk_saddle_and_eight_follow_each_other_and_are_stable(run):
    flat, ellipse, saddle, eight = run.rows
    for row in run.rows:
        assert row.converged
        assert row.n_unstable == 0
        assert row.residual <= RESIDUAL_TOLERANCE
        assert row.length_error <= LENGTH_TOLERANCE
    assert flat.abs_kappa_n < 1e-8 > ellipse.abs_kappa_n
    assert ellipse.aspect < flat.aspect < 1
    assert saddle.abs_kappa_n > 0.5
    assert eight.abs_kappa_n < 1e-8
    assert abs(abs(eight.waist_twist) - 180) < 1e-6


def test_energy_rises_with_the_load_by_the_film_energy(run):
    """DE/dload = film energy / load at an equilibrium (envelope theorem)."""
    found = carry_out(
        spec(sweep={"loads": [699.99, 700.0, 700.01]}), run.folder.parent / "e"
    )
    low, mid, high = found.rows
    slope = (high.energy - low.energy) / (high.kL3_alpha - low.kL3_alpha)
    assert slope == pytest.approx(mid.film_energy / mid.kL3_alpha, rel=1e-7)


def test_rows_are_on_disk_when_they_are_announced(tmp_path):
    seen = []

    def on_row(row: Row) -> None:
        seen.append(row)
        assert read_rows(tmp_path / "run" / "sweep.csv") == seen

    carry_out(spec(), tmp_path / "run", on_row)
    assert len(seen) == 4


def test_same_spec_gives_the_same_rows_bit_for_bit(run, tmp_path):
    again = carry_out(spec(), tmp_path / "run")
    assert without_time(again.rows) == without_time(run.rows)


def test_units_do_not_matter(run, tmp_path):
    """The spring constant of a loop of length L and modulus alpha: load alpha / L^3."""
    alpha, length = 0.25, 4.0
    constants = [row.kL3_alpha * alpha / length**3 for row in run.rows]
    scaled = spec(
        loop={"alpha": alpha, "length": length},
        sweep={"loads": constants, "quantity": "k"},
    )
    again = carry_out(scaled, tmp_path / "run")
    assert without_time(again.rows) == without_time(run.rows)


def test_up_and_down_agree_where_there_is_no_hysteresis(tmp_path):
    sweep = {"loads": [660.0, 690.0, 720.0], "direction": "up-down"}
    rows = carry_out(spec(sweep=sweep), tmp_path / "run").rows
    assert [row.kL3_alpha for row in rows] == [660, 690, 720, 690, 660]
    for up, down in ((0, 4), (1, 3)):
        assert rows[down].energy == pytest.approx(rows[up].energy, rel=1e-12)


def test_interrupt_leaves_a_usable_folder(tmp_path):
    def stop(row: Row) -> None:
        if row.step == 1:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        carry_out(spec(), tmp_path / "run", stop)
    assert len(read_rows(tmp_path / "run" / "sweep.csv")) == 2
    summary = json.loads((tmp_path / "run" / "run.json").read_text())
    assert summary["status"] == "interrupted"
    assert summary["totals"]["loads"] == 2


def test_summary_says_what_was_run(run, elongated):
    summary = json.loads((Path(run.folder) / "run.json").read_text())
    assert summary["status"] == "finished"
    assert summary["mesh"]["sha256"] == elongated.digest
    assert summary["mesh"]["loop_edges_B"] == elongated.n_b
    assert summary["mesh"]["edges_E"] == len(elongated.edges)
    assert summary["seed"] == 1
    assert set(summary["blas_threads"]) == {1}
    assert summary["totals"]["not_converged"] == []


def test_what_does_not_converge_says_so_and_the_sweep_goes_on(tmp_path):
    rows = carry_out(spec(solver={"max_iterations": 1}), tmp_path / "run").rows
    assert len(rows) == 4
    assert not rows[0].converged
    assert np.isfinite(rows[0].energy)


@pytest.mark.slow
def test_conjugate_gradients_find_the_same_sweep(run, tmp_path):
    found = carry_out(spec(solver={"name": "cg"}), tmp_path / "run")
    for cg, newton in zip(found.rows, run.rows, strict=True):
        assert cg.converged
        assert cg.n_unstable is None
        assert cg.energy == pytest.approx(newton.energy, rel=1e-8)
        assert cg.abs_kappa_n == pytest.approx(newton.abs_kappa_n, abs=2e-2)
