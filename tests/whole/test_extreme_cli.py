"""What a shell sees of extreme cases: exit codes, and a line where a number is doubtful."""

from __future__ import annotations

from pathlib import Path

import pytest

from eulerplateau.mesh.writing import write_vtp
from eulerplateau.runs.rows import BranchRow
from eulerplateau.runs.table import read_rows
from tests.helpers.command import Shell, run_here
from tests.helpers.extremes import cases, oval

COARSE = '[mesh]\nfile = "film.vtp"\n[sweep]\nloads = [{loads}]\n'


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with the film of a pentagon, unresolved at any load."""
    case = cases.polygon(5)
    write_vtp(tmp_path / "film.vtp", case.points, case.triangles)
    return tmp_path


def called(folder: Path, command: str, loads: str, *words: str) -> Shell:
    spec = folder / "run.toml"
    spec.write_text(COARSE.format(loads=loads))
    return run_here(command, "--quiet", spec, "--out", folder / "out", *words)


@pytest.mark.parametrize("solver", cases.SOLVERS)
def test_sweep_with_unresolved_rows_ends_with_4_and_a_line_for_each(
    folder: Path, solver: str
) -> None:
    done = called(folder, "sweep", "1, 2", f"--solver={solver}", "--no-pictures")
    assert done.returncode == 4
    assert len(done.stderr.splitlines()) == 2
    rows = read_rows(folder / "out" / "sweep.csv")
    assert [row.status.value for row in rows] == 2 * ["unresolved"]
    assert all(row.max_turning > 30 for row in rows)


@pytest.mark.usefixtures("coarse_pictures")
def test_branches_with_unresolved_points_end_with_4_and_one_line_for_all(
    folder: Path,
) -> None:
    done = called(folder, "branches", "1, 2", "--set=branches.special_points=0")
    assert done.returncode == 4
    assert len(done.stderr.splitlines()) == 1
    rows = read_rows(folder / "out" / "branches.csv", BranchRow)
    assert {row.status.value for row in rows} == {"unresolved"}
    assert (folder / "out" / "branches.png").stat().st_size > 0


@pytest.mark.parametrize(("sizes", "lines"), [(0.0, 0), (1e6, 1)])
def test_mesh_far_from_the_origin_is_warned_of_in_one_line_and_run(
    tmp_path: Path, sizes: float, lines: int
) -> None:
    case = cases.offset(oval(), sizes)
    write_vtp(tmp_path / "film.vtp", case.points, case.triangles)
    done = called(tmp_path, "sweep", "300", "--no-pictures")
    assert done.returncode == 0
    assert len(done.stderr.splitlines()) == lines
