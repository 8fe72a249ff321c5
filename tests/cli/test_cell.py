"""`eulerplateau cell shape`, `sweep`, `branches`, `phase-diagram` from a shell."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from eulerplateau.exact.cell import regular_cell
from tests.helpers.command import run_here

KEYS = [
    "perimeter",
    "area",
    "kappa_adhesion",
    "kappa_mid",
    "extension",
    "traction",
    "energy",
    "n_unstable",
    "status",
]
SHAPE = ["cell", "shape", "--sigma-hat", 10, "--ks-hat", 50, "--json"]
RUN = """
[cell]
adhesions = 3
edges_per_side = 24
ks_hat = 100.0
[sweep]
values = [20.0, 40.0, 80.0]
"""


@pytest.fixture
def run(tmp_path: Path) -> Path:
    path = tmp_path / "run.toml"
    path.write_text(RUN)
    return path


def test_shape_on_regular_adhesions_is_the_boundary_value_solution():
    done = run_here(*SHAPE, "--adhesions", 3)
    assert done.returncode == 0
    numbers = json.loads(done.stdout)
    assert list(numbers) == KEYS
    exact = regular_cell(3, 10.0, 50.0)
    assert numbers["perimeter"] == exact.perimeter
    assert numbers["traction"] == 2 * 50.0 * numbers["extension"]
    assert (numbers["n_unstable"], numbers["status"]) == (0, "converged")


def test_discrete_shape_has_the_same_keys_and_nearly_the_same_numbers():
    exact = json.loads(run_here(*SHAPE, "--adhesions", 3).stdout)
    for edges, within in ((32, 2e-3), (64, 5e-4)):
        done = run_here(*SHAPE, "--adhesions", 3, "--discrete", edges)
        numbers = json.loads(done.stdout)
        assert list(numbers) == KEYS
        for key in KEYS[:-2]:
            assert numbers[key] == pytest.approx(exact[key], rel=within)


def test_shape_on_points_of_ones_own_has_a_value_for_each(tmp_path: Path):
    path = tmp_path / "points.csv"
    path.write_text("x,y,stiffness\n1,0,1\n0,0.8,2\n-1,0,1\n0,-1.2,1\n")
    done = run_here(*SHAPE, "--points", path, "--discrete", 16)
    numbers = json.loads(done.stdout)
    assert [len(numbers[key]) for key in ("traction", "kappa_mid")] == [4, 4]
    assert numbers["status"] == "converged"


def test_shape_beyond_the_fold_says_so_and_ends_with_4():
    words = ["--sigma-hat", 70, "--ks-hat", 100, "--adhesions", 3, "--json"]
    done = run_here("cell", "shape", *words)
    assert done.returncode == 4
    numbers = json.loads(done.stdout)
    assert numbers["status"] == "collapsed"
    assert {numbers[key] for key in KEYS[:-1]} == {None}


@pytest.mark.parametrize(
    ("words", "culprit"),
    [
        (["--adhesions", 1], "adhesions"),
        (["--adhesions", 3, "--ks-hat", 0], "ks_hat"),
        (["--adhesions", 3, "--sigma-hat", -1], "sigma_hat"),
        (["--adhesions", 3, "--discrete", 7], "edges_per_side"),
        (["--points", "missing.csv"], "missing.csv"),
        ([], "--adhesions"),
        (["--adhesions", 3, "--points", "x.csv"], "--points"),
    ],
)
def test_wrong_argument_is_one_line_and_ends_with_2(words, culprit):
    done = run_here(*SHAPE, *words)
    assert done.returncode == 2
    assert culprit in done.stderr.splitlines()[-1]
    assert done.stdout == ""


def test_sweep_says_where_it_ended_and_why(run: Path):
    done = run_here("cell", "sweep", run, "--no-pictures", "--quiet")
    assert done.returncode == 4
    (line,) = done.stderr.splitlines()
    assert "sigma_hat 80 touching" in line
    assert (run.with_name("run") / "sweep.csv").read_text().count("\n") == 4


def test_several_values_of_a_key_make_several_runs(run: Path):
    words = ["--set", "sweep.values=[20.0]", "--set", "cell.ks_hat=50,100"]
    done = run_here("cell", "sweep", run, *words, "--no-pictures", "--quiet")
    assert done.returncode == 0
    folders = {path.parent.name for path in run.parent.glob("*/sweep.csv")}
    assert folders == {"run-values=20.0-ks_hat=50", "run-values=20.0-ks_hat=100"}


@pytest.mark.slow
def test_branches_prints_its_special_points(run: Path):
    words = ["--set", "branches.low=60", "--set", "branches.high=80"]
    words += ["--set", "branches.special_points=0", "--set", "branches.unstable_modes=0"]
    done = run_here("cell", "branches", run, *words, "--no-pictures")
    assert done.returncode == 0
    assert "bifurcation 0 (double) at sigma_hat = 6" in done.stdout


def test_phase_diagram_asks_for_a_regular_cell(run: Path, tmp_path: Path):
    (tmp_path / "points.csv").write_text("1,0\n0,1\n-1,0\n")
    run.write_text('[cell]\npoints = "points.csv"\n')
    done = run_here("cell", "phase-diagram", run, "--quiet")
    assert done.returncode == 2
    assert "cell.adhesions" in done.stderr
