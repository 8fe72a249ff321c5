"""A run folder read back: what it says of itself, its rows as a table, its curves."""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from eulerplateau.errors import EulerPlateauError, MissingLibraryError, OutputError
from eulerplateau.film.load import SPRING_LOAD, TENSION
from eulerplateau.mesh.disk import Disk
from eulerplateau.runs.continuing import differences
from eulerplateau.runs.record import Run, read_run, read_runs
from eulerplateau.runs.rows import COLUMNS, BranchRow, columns
from eulerplateau.runs.run_files import read_summary
from eulerplateau.runs.series import read_legs
from eulerplateau.runs.series_file import shape_name
from eulerplateau.solvers.equilibrium import Status
from tests.helpers.marks import quick_with
from tests.helpers.plotted_runs import pitchfork, record, row_at
from tests.helpers.shapes import disk_points, mesh_of
from tests.runs.test_output import ROW


@pytest.fixture(scope="module")
def mesh() -> Disk:
    return mesh_of(*disk_points(4))


@pytest.fixture
def sweep(tmp_path: Path, mesh: Disk) -> Path:
    return record(
        tmp_path / "sweep", mesh, [row_at(i, v) for i, v in enumerate((1.0, 9.0))]
    )


@pytest.fixture
def branches(tmp_path: Path, mesh: Disk) -> Path:
    return record(tmp_path / "explored", mesh, pitchfork())


def test_a_run_prints_in_a_line_that_says_what_it_is(sweep: Path, branches: Path) -> None:
    for folder, words in (
        (sweep, ("sweep", "2 loads", SPRING_LOAD.text, "1 to 9")),
        (branches, ("explored", "10 points", "2 branches", "100 to 900")),
    ):
        run = read_run(folder)
        assert str(run) == repr(run)
        assert "\n" not in repr(run)
        for word in words:
            assert word in repr(run)


def broken(value: Any, *keys: str) -> dict[str, Any]:
    """What a run.json says, but for one value."""
    spec = {"film": {"model": "springs"}, "solver": {"name": "newton"}}
    about: dict[str, Any] = {"spec": spec, "mesh": {"vertices": 61}, "totals": {}}
    place = about
    for key in keys[:-1]:
        place = place[key]
    place[keys[-1]] = value
    return about


@pytest.mark.parametrize(
    "value", quick_with([None, ["area"], 1e308], [None, [], ["area"], {}, "x", 1, 1e308])
)
@pytest.mark.parametrize(
    "keys",
    [
        ("spec",), ("mesh",), ("totals",), ("spec", "film"), ("spec", "film", "model"),
        ("spec", "solver", "name"), ("mesh", "vertices"), ("totals", "neutral"),
    ],
)  # fmt: skip
def test_a_run_whose_summary_says_nonsense_is_read_all_the_same(
    sweep: Path, branches: Path, value: Any, keys: tuple[str, ...]
) -> None:
    (sweep / "run.json").write_text(json.dumps(broken(value, *keys)))
    one, other = read_runs([sweep, branches])
    assert "\n" not in repr(one)
    assert len({one.label, other.label}) == 2
    assert differences(read_summary(sweep), broken("dirichlet", "spec", "film", "model"))


@pytest.mark.parametrize("content", ["[" * 100_000, "[1]", "1", "\x00"])
def test_a_summary_that_is_none_says_nothing(sweep: Path, content: str) -> None:
    (sweep / "run.json").write_text(content)
    assert read_summary(sweep) == {}


def test_loads_to_look_at_are_those_of_the_first_bent_films(
    tmp_path: Path, mesh: Disk
) -> None:
    """Between the planar ones below and above, in whatever order they come."""
    bends = {1.0: 0.0, 2.0: 0.01, 3.0: 0.6, 4.0: 1.0, 5.0: 0.4, 6.0: 0.0, 7.0: 0.3}
    rows = [
        replace(row_at(step, load), abs_kappa_n=bend)
        for step, (load, bend) in enumerate(sorted(bends.items(), reverse=True))
    ]
    assert read_run(record(tmp_path / "run", mesh, rows)).between == (3.0, 5.0)
    assert read_run(record(tmp_path / "flat", mesh, rows[-2:])).between is None


def test_a_run_in_progress_or_without_rows_prints_too(sweep: Path) -> None:
    (sweep / "run.json").write_text('{"status": "interrupted"}')
    assert "interrupted" in repr(read_run(sweep))
    assert "empty" in repr(Run(Path("empty"), ()))


def test_rows_shapes_and_load_are_those_of_the_folder(sweep: Path, mesh: Disk) -> None:
    run = read_run(str(sweep))
    assert [row.kL3_alpha for row in run.rows] == [1.0, 9.0]
    assert run.load is SPRING_LOAD
    assert [run.shape_path(row) for row in run.rows] == [
        sweep / shape_name(step) for step in (0, 1)
    ]
    shapes = run.shapes()
    assert shapes.x.shape == (2, mesh.n_v, 3)
    assert shapes.triangles(1).tolist() == mesh.triangles.tolist()


def test_table_of_special_points_is_read_with_the_branches(branches: Path) -> None:
    assert read_run(branches).special == {}
    (branches / "special_points.csv").write_text("number,kind\n0,bifurcation\n")
    assert read_run(branches).special == {0: {"number": "0", "kind": "bifurcation"}}
    (branches / "special_points.csv").write_text("kind\nfold\n")
    with pytest.raises(OutputError) as caught:
        read_run(branches)
    assert caught.value.path == branches / "special_points.csv"


def test_runs_of_different_films_are_over_one_load(
    tmp_path: Path, mesh: Disk, sweep: Path
) -> None:
    other = record(tmp_path / "area", mesh, [row_at(0, 1.0)], model="area")
    assert read_run(other).load is TENSION
    assert {run.load for run in read_runs([sweep, other])} == {TENSION}
    assert read_runs([]) == []


def test_rows_are_a_data_frame_where_pandas_is(
    sweep: Path, branches: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With a stand-in for pandas, which is no requirement: the cells by column."""
    monkeypatch.setitem(sys.modules, "pandas", SimpleNamespace(DataFrame=dict))
    table: dict[str, Any] = read_run(sweep).table()
    assert tuple(table) == COLUMNS
    assert table["kL3_alpha"] == [1.0, 9.0]
    assert table["status"] == [Status.CONVERGED.value] * 2
    assert tuple(read_run(branches).table()) == columns(BranchRow)


def test_without_pandas_the_error_says_what_to_install(
    sweep: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(MissingLibraryError) as caught:
        read_run(sweep).table()
    assert isinstance(caught.value, EulerPlateauError)
    assert "pip install pandas" in str(caught.value)


def test_branches_and_legs_start_where_they_leave_another(branches: Path) -> None:
    first, side = read_run(branches).series
    assert (first.first, first.last, first.start) == (0, 5, None)
    assert (side.first, side.last, side.start) == (6, 9, 3)
    assert side.rows[0] == first.rows[3]
    rows = [replace(ROW, step=i, kL3_alpha=v) for i, v in enumerate((1.0, 3.0, 2.0))]
    up, down = read_legs(rows)
    assert (up.rising, down.rising) == (True, False)
    assert (up.name, down.name) == ("load rising", "load falling")
    assert up.rows[-1] is down.rows[0] is rows[1]
    assert [(leg.first, leg.last, leg.start) for leg in (up, down)] == [
        (0, 1, None),
        (2, 2, 1),
    ]


def test_row_that_does_not_converge_is_on_no_curve() -> None:
    rows = [replace(ROW, step=i, kL3_alpha=v) for i, v in enumerate((1.0, 3.0, 5.0))]
    rows[1] = replace(rows[1], status=Status.STALLED)
    (leg,) = read_legs(rows)
    (piece,) = leg.pieces(leg.values(lambda row: row.energy))
    assert piece.loads.tolist() == [1.0, 5.0]
    assert not list(leg.pieces(leg.values(lambda row: row.lowest_eigenvalue)))


def test_branch_has_a_gap_at_a_jump_and_where_it_is_not_finite(branches: Path) -> None:
    first, _ = read_run(branches).branches
    stable, unstable = first.pieces(first.loads)
    assert (stable.solid, unstable.solid) == (True, False)
    assert [*stable.loads[[0, -1]], *unstable.loads[[0, -1]]] == pytest.approx(
        [100.0, 500.0, 500.0, 900.0]
    )
    jumps = first.values(lambda row: 100.0 * (row.load > 350.0))
    assert [piece.loads[0] for piece in first.pieces(jumps, jump=90.0)] == pytest.approx(
        [100.0, 400.0, 500.0]
    )
    holes = first.values(lambda row: None if row.load == 300.0 else row.load)
    assert [piece.loads[0] for piece in first.pieces(holes)] == pytest.approx(
        [400.0, 500.0]
    )
