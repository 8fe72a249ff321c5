"""The command line as a shell sees it: exit codes, folders, one line for every mistake."""

from __future__ import annotations

import json
import shlex
import subprocess
from pathlib import Path

import pytest

from eulerplateau.mesh import read_disk, write_mesh
from eulerplateau.mesh.disk import Disk
from eulerplateau.runs.rows import COLUMNS
from eulerplateau.runs.table import read_rows
from tests.helpers.command import Shell, command_line, run_here, run_in_shell
from tests.helpers.processes import shown_at_a_terminal


def sweep(*words: object, cwd: Path | None = None) -> Shell:
    return run_here("sweep", "--no-pictures", "--quiet", *words, cwd=cwd)


@pytest.fixture
def spec(tmp_path: Path, oval: Disk) -> Path:
    """A run of two loads on a stored mesh of 127 vertices."""
    write_mesh(oval, tmp_path / "oval.vtp")
    path = tmp_path / "run.toml"
    path.write_text('[mesh]\nfile = "oval.vtp"\n[sweep]\nloads = [500, 900]\n')
    return path


def edit(path: Path, old: str, new: str) -> Path:
    path.write_text(path.read_text().replace(old, new))
    return path


def assert_fails(result: Shell, code: int, *names: str) -> None:
    """One line on the error stream, naming what is at fault, and no traceback."""
    assert result.returncode == code
    assert result.stdout == ""
    assert len(result.stderr.strip().splitlines()) == 1
    assert "Traceback" not in result.stderr
    for name in names:
        assert name in result.stderr


def test_sweep_ends_with_0_and_writes_its_folder_beside_the_specification(
    spec: Path,
) -> None:
    result = run_in_shell("sweep", "--no-pictures", "--quiet", spec)
    assert (result.returncode, result.stdout, result.stderr) == (0, "", "")
    folder = spec.with_suffix("")
    assert [row.kL3_alpha for row in read_rows(folder / "sweep.csv")] == [500, 900]
    assert {path.name for path in folder.iterdir()} == {
        "run.json",
        "loops",
        "shapes",
        "sweep.csv",
        "sweep.pvd",
    }


def test_table_has_the_promised_columns_in_the_promised_order(spec: Path) -> None:
    sweep(spec)
    header = (spec.with_suffix("") / "sweep.csv").read_text().splitlines()[0]
    assert header == ",".join(COLUMNS)
    assert header.startswith(
        "step,kL3_alpha,sigma_hat,energy,film_energy,bending_energy,abs_kappa_n,"
        "total_gauss_curvature,area,n_unstable,lowest_eigenvalue,residual,length_error,"
        "iterations,seconds,status,"
    )
    assert {"max_turning", "waist_twist", "self_intersections", "aspect"} < set(COLUMNS)


def test_without_quiet_it_reports_on_what_it_did(spec: Path) -> None:
    result = run_here("sweep", "--no-pictures", spec)
    assert result.returncode == 0
    assert str(spec.with_suffix("")) in result.stdout
    # A bar is for people: this is no terminal.
    assert result.stderr == ""


@pytest.mark.slow
def test_at_a_terminal_a_sweep_shows_how_far_it_is(spec: Path) -> None:
    shown = shown_at_a_terminal(command_line("sweep", "--no-pictures", spec))
    assert b"|kappa_n|" in shown
    assert b"100%" in shown


def test_out_names_the_folder_and_the_solver_can_be_chosen(
    spec: Path, tmp_path: Path
) -> None:
    edit(spec, "[500, 900]", "[100]")
    result = sweep(spec, "--out", tmp_path / "deep" / "er", "--solver", "cg")
    assert result.returncode == 0
    row = read_rows(tmp_path / "deep" / "er" / "sweep.csv")[-1]
    assert row.converged
    assert row.n_unstable is None
    summary = json.loads((tmp_path / "deep" / "er" / "run.json").read_text())
    assert summary["spec"]["solver"]["name"] == "cg"


def test_several_specs_and_values_make_a_folder_for_every_combination(
    spec: Path, tmp_path: Path
) -> None:
    other = tmp_path / "other.toml"
    other.write_text(spec.read_text())
    result = sweep(
        spec,
        other,
        "--out",
        tmp_path / "all",
        "--set",
        "start.seed=1,2",
        "--set",
        "loop.alpha=1,2",
        "--set",
        "sweep.loads=[300]",
    )
    assert result.returncode == 0
    folders = sorted((tmp_path / "all").iterdir())
    assert len(folders) == 8
    met = set()
    for folder in folders:
        settings = json.loads((folder / "run.json").read_text())["spec"]
        assert len(read_rows(folder / "sweep.csv")) == 1
        name = "run" if folder.name.startswith("run") else "other"
        met.add((name, settings["start"]["seed"], settings["loop"]["alpha"]))
    assert len(met) == 8


def test_mesh_file_set_in_the_shell_is_looked_for_where_the_shell_is(
    spec: Path, tmp_path: Path
) -> None:
    here = tmp_path / "here"
    here.mkdir()
    (tmp_path / "oval.vtp").rename(here / "moved.vtp")
    result = sweep(spec, "--set", "mesh.file=moved.vtp", cwd=here)
    assert result.returncode == 0


@pytest.mark.parametrize(
    ("old", "new", "key"),
    [
        ("loads", "laods", "sweep.laods"),
        ("[500, 900]", "[]", "sweep.loads"),
        ("[500, 900]", "[500, -1]", "sweep.loads"),
        ("[500, 900]", "[500, nan]", "sweep.loads[1]"),
        ("[500, 900]", '"all"', "sweep.loads"),
        ("[sweep]", "[loop]\nalpha = -1\n[sweep]", "loop.alpha"),
        ("[sweep]", "[loop]\nalpha = 0\n[sweep]", "loop.alpha"),
        ("oval.vtp", "none.vtp", "none.vtp"),
        (
            'file = "oval.vtp"',
            'polygon = {kind = "corners", points = [[0,0],[1,1],[1,0],[0,1]]}',
            "mesh.polygon.points",
        ),
    ],
)
def test_bad_specification_ends_with_2_and_a_line_naming_the_key(
    spec: Path, old: str, new: str, key: str
) -> None:
    assert_fails(sweep(edit(spec, old, new)), 2, key)


def test_missing_file_and_bad_arguments_end_with_2(spec: Path, tmp_path: Path) -> None:
    missing = run_in_shell("sweep", "--no-pictures", "--quiet", tmp_path / "none.toml")
    assert_fails(missing, 2, "none.toml")
    assert_fails(sweep(spec, "--set", "solver.name=simplex"), 2, "solver.name")
    assert_fails(sweep(spec, "--set", "seed=1"), 2, "seed")
    assert_fails(sweep(spec, "--solver", "simplex"), 2, "solver.name")
    for words in ((spec, "--sovler", "cg"), (), (spec, "--set", "solver.name")):
        assert sweep(*words).returncode == 2
    assert run_here("swepe").returncode == 2


def test_two_runs_that_would_share_a_folder_end_with_2(spec: Path, tmp_path: Path) -> None:
    twin = tmp_path / "twin" / "run.toml"
    twin.parent.mkdir()
    twin.write_text(spec.read_text())
    assert_fails(sweep(spec, twin, "--out", tmp_path / "all"), 2)
    assert not (tmp_path / "all").exists()


def test_no_run_starts_if_one_of_the_specifications_is_wrong(
    spec: Path, tmp_path: Path
) -> None:
    bad = tmp_path / "zbad.toml"
    bad.write_text("[sweep]\nloads = [1]\n")
    assert_fails(sweep(spec, bad), 2, "mesh")
    assert not spec.with_suffix("").exists()


def test_bad_mesh_ends_with_3(spec: Path, tmp_path: Path) -> None:
    (tmp_path / "bow.off").write_text(
        "OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n3 0 1 4\n"
    )
    assert_fails(sweep(edit(spec, "oval.vtp", "bow.off")), 3, "edge")
    (tmp_path / "torn.vtp").write_bytes((tmp_path / "oval.vtp").read_bytes()[:700])
    result = sweep(edit(spec, "bow.off", "torn.vtp"))
    assert result.returncode in (3, 5)
    assert "Traceback" not in result.stderr


def test_load_that_does_not_converge_ends_with_4_and_is_a_row_all_the_same(
    spec: Path,
) -> None:
    result = sweep(spec, "--set", "solver.max_iterations=1")
    assert result.returncode == 4
    assert result.stdout == ""
    rows = read_rows(spec.with_name("run-max_iterations=1") / "sweep.csv")
    assert [row.status.value for row in rows] == 2 * ["iteration_limit"]


def test_output_that_cannot_be_written_ends_with_5(spec: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    assert_fails(sweep(spec, "--out", tmp_path / "file" / "out"), 5, "file")
    full = tmp_path / "mine"
    full.mkdir()
    (full / "thesis.txt").write_text("do not lose this")
    assert_fails(sweep(spec, "--out", full), 5, "mine")
    assert (full / "thesis.txt").read_text() == "do not lose this"


def test_one_bad_run_of_many_costs_the_others_nothing(spec: Path, tmp_path: Path) -> None:
    (tmp_path / "bow.off").write_text(
        "OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n3 0 1 4\n"
    )
    first = tmp_path / "abad.toml"
    first.write_text(spec.read_text().replace("oval.vtp", "bow.off"))
    assert sweep(first, spec).returncode == 3
    assert len(read_rows(spec.with_suffix("") / "sweep.csv")) == 2


def test_output_on_a_full_disk_ends_with_5() -> None:
    words = command_line("--version")
    with open("/dev/full", "w") as full:
        done = subprocess.run(words, stdout=full, stderr=subprocess.PIPE, check=False)
    assert done.returncode == 5
    assert done.stderr.count(b"\n") == 1


def test_mesh_command_writes_a_mesh_that_sweep_takes(tmp_path: Path) -> None:
    polygon = tmp_path / "polygon.toml"
    polygon.write_text("vertices = 100\n[polygon]\nkind = 'regular'\nsides = 6\n")
    result = run_here("mesh", polygon, "-o", tmp_path / "mesh.vtp", "--quiet")
    assert (result.returncode, result.stdout, result.stderr) == (0, "", "")
    assert read_disk(tmp_path / "mesh.vtp").n_v == pytest.approx(100, rel=0.02)
    spec = tmp_path / "run.toml"
    spec.write_text('[mesh]\nfile = "mesh.vtp"\n[sweep]\nloads = [500]\n')
    assert sweep(spec).returncode == 0


def test_mesh_command_ends_with_the_code_of_what_went_wrong(tmp_path: Path) -> None:
    crossed = tmp_path / "crossed.toml"
    crossed.write_text("[polygon]\nkind = 'corners'\npoints = [[0,0],[1,1],[1,0],[0,1]]\n")
    assert_fails(run_here("mesh", crossed, "-o", tmp_path / "a.vtp"), 2, "polygon.points")
    bow = tmp_path / "bow.off"
    bow.write_text(
        "OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n3 0 1 4\n"
    )
    assert_fails(run_here("mesh", bow, "-o", tmp_path / "a.vtp"), 3, "edge")
    good = tmp_path / "good.off"
    good.write_text("OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 1 3 2\n")
    (tmp_path / "file").write_text("in the way")
    assert_fails(run_here("mesh", good, "-o", tmp_path / "file" / "a.vtp"), 5, "file")


@pytest.mark.slow
@pytest.mark.parametrize(
    "stream", [1, *(pytest.param(other, marks=pytest.mark.slow) for other in (0, 2))]
)
def test_closed_stream_is_no_error_and_no_file_of_the_run(spec: Path, stream: int) -> None:
    words = command_line("sweep", "--no-pictures", spec, "--out", "out")
    line = f"exec {shlex.join(words)} {stream}>&-"
    result = subprocess.run(
        ["sh", "-c", line], cwd=spec.parent, capture_output=True, text=True, check=False
    )
    assert result.returncode == 0
    assert "Traceback" not in result.stderr
    assert len(read_rows(spec.parent / "out" / "sweep.csv")) == 2
