"""Ensembles: what a case's name depends on, which cases a file makes, what is computed."""

from __future__ import annotations

import csv
import json
import shutil
from pathlib import Path

import pytest

from eulerplateau.errors import ConflictError, EulerPlateauError, OutputError, SpecError
from eulerplateau.mesh import mesh_polygon, write_mesh
from eulerplateau.runs import CellRunSpec, RunSpec, read_run, run_branches, run_sweep
from eulerplateau.runs.ensembles import (
    case_name,
    cases,
    joined,
    load_ensemble,
    read_runs_below,
    run_ensemble,
    running,
)
from tests.helpers.tasks import in_turn

FILM = """
[mesh]
file = "oval.vtp"
[grid]
start.seed = [1, 2]
sweep.loads = [200, 400]
"""
CELL = """
[ensemble]
kind = "cell sweep"
[cell]
edges_per_side = 8
[sweep]
values = [5.0, 10.0]
[grid]
cell.adhesions = [3, 4]
"""


@pytest.fixture(scope="module")
def oval_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("mesh") / "oval.vtp"
    write_mesh(mesh_polygon("ellipse", aspect=1.5, vertices=60), path)
    return path


@pytest.fixture
def home(tmp_path: Path, oval_file: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a mesh, where cases are carried out by this process."""
    monkeypatch.setattr(running, "in_workers", in_turn)
    shutil.copy(oval_file, tmp_path / "oval.vtp")
    return tmp_path


def write(folder: Path, text: str, name: str = "ensemble.toml") -> Path:
    (folder / name).write_text(text)
    return folder / name


def made(folder: Path, text: str) -> list[dict]:
    """Return the specifications of the cases of a file."""
    ensemble = load_ensemble(write(folder, text))
    return [case.spec.model_dump(mode="json") for case in ensemble.cases]


def computed(path: Path, out: Path, **options) -> list[str]:
    """Carry out an ensemble; return the labels of the cases that this call computed."""
    labels: list[str] = []
    ensemble = load_ensemble(path)
    run_ensemble(ensemble, out, lambda case, outcome: labels.append(case.label), **options)
    return labels


def lines(table, folder: Path) -> list[dict[str, str]]:
    """Return a table as it is read back, without what a clock says."""
    table.write(folder / "table.csv")
    with (folder / "table.csv").open(newline="") as file:
        return [
            {k: v for k, v in row.items() if k != "seconds"} for row in csv.DictReader(file)
        ]


# What decides the results of a case is in its name, and nothing else.


def film(path: Path, **sections) -> RunSpec:
    return RunSpec(**{"mesh": {"file": str(path)}, "sweep": {"loads": [500]}, **sections})


def test_name_depends_neither_on_paths_nor_on_order_nor_on_defaults_written_out(home):
    name = case_name("sweep", film(home / "oval.vtp"))
    (home / "elsewhere").mkdir()
    moved = shutil.copy(home / "oval.vtp", home / "elsewhere" / "other.vtp")
    assert case_name("sweep", film(Path(moved))) == name
    written_out = film(home / "oval.vtp").model_dump(mode="json")
    assert written_out["solver"]["name"] == "newton"
    assert case_name("sweep", RunSpec(**written_out)) == name
    backwards = {key: written_out[key] for key in reversed(written_out)}
    backwards["sweep"] = {key: backwards["sweep"][key] for key in ("direction", "loads")}
    assert case_name("sweep", RunSpec(**backwards)) == name


OTHERS = [
    {"film": {"model": "dirichlet"}},
    {"film": {"model": "area"}},
    {"film": {"model": "area", "plane": True}},
    {"loop": {"alpha": 2.0}},
    {"loop": {"length": 2.0}},
    {"start": {"seed": 2}},
    {"start": {"displacement": 2e-3}},
    {"sweep": {"loads": [500.0000000000001]}},
    {"sweep": {"loads": [500], "quantity": "k"}},
    {"sweep": {"loads": [500], "direction": "down"}},
    {"solver": {"name": "cg"}},
    {"solver": {"max_iterations": 7}},
    {"output": {"modes": 1}},
    {"branches": {"load_min": 2.0}},
    {"branches": {"special_points": 1}},
    {"mesh": {"polygon": {"kind": "regular", "sides": 6}}},
    {"mesh": {"polygon": {"kind": "regular", "sides": 7}}},
    {"mesh": {"polygon": {"kind": "regular", "sides": 6}, "vertices": 99}},
]


def test_every_key_changes_the_name(home):
    specs = [film(home / "oval.vtp"), *(film(home / "oval.vtp", **o) for o in OTHERS)]
    assert len({case_name("sweep", spec) for spec in specs}) == len(specs)


def test_contents_kind_and_version_of_the_results_change_the_name(home, monkeypatch):
    spec = film(home / "oval.vtp", start={"file": str(home / "shape.vtp")})
    names = [case_name("sweep", spec), case_name("branches", spec)]
    shutil.copy(home / "oval.vtp", home / "shape.vtp")
    names.append(case_name("sweep", spec))
    write_mesh(mesh_polygon("ellipse", aspect=1.5, vertices=61), home / "oval.vtp")
    names.append(case_name("sweep", spec))
    monkeypatch.setattr(cases, "RESULTS", cases.RESULTS + 1)
    names.append(case_name("sweep", spec))
    cell = CellRunSpec(cell={"points": str(home / "a.csv")}, sweep={"values": [1.0]})
    for points in ("1,0\n0,1\n-1,0\n", "1,0\n0,1\n-1,0.1\n"):
        (home / "a.csv").write_text(points)
        names.append(case_name("cell sweep", cell))
    assert len(set(names)) == len(names)


# Which cases a file makes.


def test_grid_makes_all_combinations_and_a_list_each_of_its_own(home):
    specs = made(home, FILM)
    found = [(spec["start"]["seed"], spec["sweep"]["loads"]) for spec in specs]
    assert found == [(1, [200.0]), (1, [400.0]), (2, [200.0]), (2, [400.0])]
    text = FILM + '[[case]]\nfilm.model = "dirichlet"\n[[case]]\n"loop.alpha" = 2.0\n'
    found = [
        (spec["film"]["model"], spec["loop"]["alpha"], spec["start"]["seed"])
        for spec in made(home, text)
    ]
    assert found[::2] == [
        ("dirichlet", 1.0, 1),
        ("dirichlet", 1.0, 2),
        ("springs", 2.0, 1),
        ("springs", 2.0, 2),
    ]


def test_keys_are_the_same_however_their_tables_are_written(home):
    nested = (
        FILM.replace("start.seed = [1, 2]\n", "").rstrip()
        + "\n[grid.start]\nseed = [1, 2]\n"
    )
    quoted = FILM.replace("start.seed", '"start.seed"')
    names = [
        sorted(case.name for case in load_ensemble(write(home, text)).cases)
        for text in (FILM, nested, quoted)
    ]
    assert names[0] == names[1] == names[2]


def test_ranges_stand_for_their_values_and_whole_ones_stay_whole(home):
    grid = "start.seed = [7, { start = 1, stop = 3, step = 1 }]\n"
    text = f'[mesh]\nfile = "oval.vtp"\n[sweep]\nloads = [5]\n[grid]\n{grid}'
    assert [spec["start"]["seed"] for spec in made(home, text)] == [7, 1, 2, 3]
    grid = "sweep.loads = [{ start = 1, stop = 2, step = 0.5 }, [8, 9]]\n"
    found = [
        spec["sweep"]["loads"] for spec in made(home, text[: text.index("start")] + grid)
    ]
    assert found == [[1.0], [1.5], [2.0], [8.0, 9.0]]


def test_sections_go_on_top_of_a_run_file_whose_files_lie_beside_it(home):
    (home / "runs").mkdir()
    shutil.copy(home / "oval.vtp", home / "runs" / "mine.vtp")
    base = '[mesh]\nfile = "mine.vtp"\n[start]\nseed = 5\n[sweep]\nloads = [9]\n'
    write(home / "runs", base, "run.toml")
    text = '[ensemble]\nbase = "runs/run.toml"\n[start]\ndisplacement = 0.5\n'
    (only,) = made(home, text)
    assert only["start"] == {"file": None, "displacement": 0.5, "seed": 5}
    assert Path(only["mesh"]["file"]).samefile(home / "runs" / "mine.vtp")
    files = text + '[grid]\nmesh.file = ["oval.vtp"]\n'
    assert Path(made(home, files)[0]["mesh"]["file"]).samefile(home / "oval.vtp")
    whole = text + '[grid]\nmesh = [{ file = "oval.vtp" }, { polygon.kind = "regular", '
    found = made(home, whole + "polygon.sides = 5 }]\n")
    assert Path(found[0]["mesh"]["file"]).samefile(home / "oval.vtp")
    assert found[1]["mesh"]["polygon"]["sides"] == 5


def test_cases_that_are_the_same_run_are_one(home):
    text = FILM.replace("[1, 2]", "[1, 1]").replace("[200, 400]", "[200, [200.0]]")
    assert len(made(home, text)) == 1


@pytest.mark.parametrize(
    ("old", "new", "key"),
    [
        ("[1, 2]", "1", "grid.start.seed"),
        ("[1, 2]", "[]", "grid.start.seed"),
        ("[1, 2]", "[-1]", "start.seed"),
        ("start.seed", "start.sed", "start.sed"),
        ("[grid]", "[grd]", "grd"),
        ("[mesh]", "[ensemble]\nkind = 'sweeps'\n[mesh]", "ensemble.kind"),
        ("[mesh]", "[ensemble]\nbase = 'no.toml'\n[mesh]", "no.toml"),
        ("[1, 2]", "[{ start = 2, stop = 1, step = 1 }]", "stop"),
        ("[1, 2]", "[{ start = 1, stop = 90_000, step = 1 }]", "grid"),
        ("[grid]", "[[case]]\nstart.seed = 3\n[grid]", "case[0].start.seed"),
    ],
)
def test_what_is_wrong_is_a_line_that_names_the_key(home, old, new, key):
    with pytest.raises(SpecError) as caught:
        load_ensemble(write(home, FILM.replace(old, new)))
    assert str(caught.value).startswith(key) or key in caught.value.key
    assert "\n" not in str(caught.value)


# What a call computes.


def test_repeated_call_computes_what_is_missing_and_nothing_that_is_out_of_date(home):
    path, out = write(home, FILM), home / "out"
    assert len(computed(path, out)) == 4
    assert computed(path, out) == []
    some = next((out / "cases").iterdir())
    shutil.rmtree(some)
    assert len(computed(path, out)) == 1
    write(home, FILM.replace("[1, 2]", "[2, 3]"))
    assert computed(path, out) == ["start.seed=3, sweep.loads=[200]",
                                   "start.seed=3, sweep.loads=[400]"]  # fmt: skip
    write_mesh(mesh_polygon("ellipse", aspect=1.5, vertices=61), home / "oval.vtp")
    assert len(computed(path, out)) == 4


def test_case_that_was_interrupted_goes_on(home):
    path = write(home, FILM.replace("[200, 400]", "[[200, 400]]"))
    (case, _) = load_ensemble(path).cases
    folder = home / "out" / "cases" / case.name
    running.open_ensemble(home / "out", [case.name])

    class StopError(Exception):
        pass

    def stop(row) -> None:
        raise StopError

    with pytest.raises(StopError):
        run_sweep(case.spec, folder, stop)
    unfinished = joined(read_runs_below([home / "out"]))
    assert (unfinished.unfinished, len(unfinished.lines)) == ((case.name,), 1)
    assert len(computed(path, home / "out")) == 2
    assert len(read_run(folder).rows) == 2
    assert joined(read_runs_below([home / "out"])).unfinished == ()


@pytest.mark.slow
def test_shards_are_the_whole_and_what_is_collected_is_its_table(home):
    ensemble = load_ensemble(write(home, FILM.replace("[1, 2]", "[1, 2, 3]")))
    whole = run_ensemble(ensemble, home / "whole").table
    for part in range(4):
        run_ensemble(ensemble, home / f"shard{part % 2}", shard=(part, 4))
    half = joined(read_runs_below([home / "shard0"]))
    assert len(half.missing) == 3
    parts = joined(read_runs_below([home / "shard1", home / "shard0"]))
    assert lines(parts, home) == lines(whole, home)
    assert parts.missing == ()
    with pytest.raises(SpecError, match="4/4"):
        run_ensemble(ensemble, home / "whole", shard=(4, 4))


def test_case_that_fails_is_a_row_with_its_reason_and_costs_no_other(home):
    path = write(home, FILM.replace('"oval.vtp"', '"oval.vtp"').replace(
        "[grid]\n", '[grid]\nmesh.file = ["none.vtp", "oval.vtp"]\n'))  # fmt: skip
    table = run_ensemble(load_ensemble(path), home / "out").table
    rows = lines(table, home)
    failed = [row for row in rows if row["status"] == "failed"]
    assert len(rows) == 8
    assert len(failed) == len(table.failed) == 4
    assert table.exit_code == SpecError.exit_code
    for row in failed:
        assert "none.vtp: there is no such file" in row["reason"]
        assert row["mesh.file"].endswith("none.vtp")
        assert row["energy"] == row["step"] == ""
    shutil.copy(home / "oval.vtp", home / "none.vtp")
    again = run_ensemble(load_ensemble(path), home / "out")
    assert (again.computed, again.cases) == (0, 4)  # the same mesh: the same cases
    assert again.table.exit_code == 0


def test_mistake_of_the_program_s_own_costs_its_case_alone(home, monkeypatch):
    def broken(spec, folder):
        if spec.start.seed == 1:
            raise ValueError("out of cheese")
        return run_sweep(spec, folder)

    monkeypatch.setattr("eulerplateau.runs.sweep.run_sweep", broken)
    table = run_ensemble(load_ensemble(write(home, FILM)), home / "out").table
    rows = lines(table, home)
    reasons = [row["reason"] for row in rows]
    assert "mesh.file" not in rows[0]  # it is the same, though no case says what is in it
    assert reasons == ["ValueError: out of cheese"] * 2 + ["", ""]
    assert table.exit_code == 1


def test_case_that_another_call_carries_out_is_that_call_s(home):
    """A failure to write where another process writes is no failure of the case."""
    ensemble = load_ensemble(write(home, FILM))
    case, *others = ensemble.cases
    folder = home / "out" / "cases" / case.name
    running.open_ensemble(home / "out", [case.name for case in ensemble.cases])

    def second(row) -> None:
        table = run_ensemble(ensemble, home / "out").table
        assert table.exit_code == ConflictError.exit_code
        assert table.failed == (case.name,)

    run_sweep(case.spec, folder, second)
    again = run_ensemble(ensemble, home / "out")
    assert again.computed == 0
    assert (again.table.failed, len(again.table.lines)) == ((), 1 + len(others))


def test_folder_of_something_else_is_left_alone(home):
    (home / "out").mkdir()
    (home / "out" / "thesis.tex").write_text("")
    with pytest.raises(OutputError, match="something else"):
        run_ensemble(load_ensemble(write(home, FILM)), home / "out")
    assert [path.name for path in (home / "out").iterdir()] == ["thesis.tex"]


def test_cells_are_cases_too(home):
    table = run_ensemble(load_ensemble(write(home, CELL)), home / "out").table
    rows = lines(table, home)
    assert [(row["cell.adhesions"], row["sigma_hat"]) for row in rows] == [
        ("3", "5.0"), ("3", "10.0"), ("4", "5.0"), ("4", "10.0")
    ]  # fmt: skip
    assert {row["status"] for row in rows} == {"converged"}
    assert not {"seed", "cell.points"} & rows[0].keys()


# One table of any runs.


def test_table_has_every_row_and_the_keys_that_differ(home):
    path, out = write(home, FILM), home / "out"
    table = run_ensemble(load_ensemble(path), out).table
    rows = lines(table, home)
    assert list(rows[0])[:5] == ["run", "seed", "mesh", "sweep.loads", "step"]
    for row in rows:
        folder = out / "cases" / row["run"]
        about = json.loads((folder / "run.json").read_text())
        (own,) = csv.DictReader((folder / "sweep.csv").read_text().splitlines())
        assert {key: row[key] for key in own if key != "seconds"} == {
            key: value for key, value in own.items() if key != "seconds"
        }
        assert row["seed"] == str(about["seed"])
        assert about["mesh"]["sha256"].startswith(row["mesh"])
        assert json.loads(row["sweep.loads"]) == about["spec"]["sweep"]["loads"]


def test_runs_of_other_commands_are_joined(home):
    moved = shutil.copy(home / "oval.vtp", home / "same.vtp")
    run_sweep(film(home / "oval.vtp", solver={"name": "cg"}), home / "all" / "a")
    run_sweep(film(Path(moved), start={"seed": 4}), home / "all" / "b")
    rows = lines(joined(read_runs_below([home / "all"])), home)
    assert [row["run"] for row in rows] == [str(home / "all" / name) for name in "ab"]
    assert [(row["seed"], row["solver.name"]) for row in rows] == [
        ("1", "cg"),
        ("4", "newton"),
    ]
    assert "mesh.file" not in rows[0]  # the same mesh, wherever it lies
    named = joined(read_runs_below([home / "all" / "b", home / "all", home / "all" / "b"]))
    assert [row["seed"] for row in lines(named, home)] == ["4", "1"]


def test_sweeps_and_branches_are_joined_films_and_cells_are_not(home):
    spec = film(home / "oval.vtp", sweep={"loads": [300, 320]})
    run_sweep(spec, home / "sweep")
    run_branches(spec, home / "branches")
    both = lines(joined(read_runs_below([home / "sweep", home / "branches"])), home)
    assert {row["branch"] for row in both} == {"", "0"}
    run_ensemble(load_ensemble(write(home, CELL)), home / "cells")
    with pytest.raises(OutputError, match="run of a cell: join one kind"):
        joined(read_runs_below([home / "sweep", home / "cells"]))
    with pytest.raises(OutputError, match="none in it"):
        read_runs_below([home / "sweep" / "shapes"])


@pytest.mark.slow
def test_parquet_holds_what_csv_holds(home):
    from pyarrow import parquet

    text = FILM.replace("[200, 400]", "[[200], [{ start = 200, stop = 400, step = 200 }]]")
    text = text.replace("[1, 2]", "[1]")
    text += "solver.max_iterations = [1, 100]\nstart.displacement = [1, 1e-3]\n"
    table = run_ensemble(load_ensemble(write(home, text)), home / "out").table
    table.write(home / "table.parquet")
    found = parquet.read_table(home / "table.parquet").to_pylist()
    rows = lines(table, home)
    assert len(found) == len(rows) == 12
    for line, row in zip(found, rows, strict=True):
        assert list(line) == list(table.columns)
        for key, text in row.items():
            value = line[key]
            same = value is None if text == "" else str(value) == text
            assert same or float(text) == value, key


def test_errors_of_a_case_are_those_of_the_program(home):
    """Whatever raises one of them fails with its line and its exit code."""
    spec = film(home / "none.vtp")
    case = cases.Case(case_name("sweep", spec), "sweep", spec, "")
    outcome = cases.carry_out((case, home / "run"))
    with pytest.raises(EulerPlateauError) as caught:
        run_sweep(spec, home / "run")
    assert (outcome.problem, outcome.exit_code) == (
        str(caught.value),
        caught.value.exit_code,
    )
    stale = cases.Case("0" * 16, "sweep", film(home / "oval.vtp"), "")
    assert "changed" in cases.carry_out((stale, home / "run")).problem
    assert not (home / "run").exists()
