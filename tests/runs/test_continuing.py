"""Runs that go on where they were interrupted, and folders that hold something else."""

from __future__ import annotations

import csv
import os
import shutil
from pathlib import Path

import pytest

from eulerplateau.errors import ConflictError
from eulerplateau.mesh import mesh_polygon, write_mesh
from eulerplateau.runs import CellRunSpec, RunSpec, run_branches, run_cell_sweep, run_sweep
from tests.helpers.command import run_here
from tests.helpers.marks import quick_with

LOADS = [500.0, 600.0, 660.0, 700.0, 720.0]
CELL = CellRunSpec(
    cell={"adhesions": 3, "edges_per_side": 16, "ks_hat": 100.0},
    sweep={"values": [10.0, 30.0, 50.0, 60.0]},
)


class StopError(Exception):
    """What a test interrupts a run with."""


@pytest.fixture(scope="module")
def mesh(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("mesh") / "oval.vtp"
    write_mesh(mesh_polygon("ellipse", aspect=1.5, vertices=120), path)
    return str(path)


def film(mesh: str, model: str, loads: list[float]) -> RunSpec:
    return RunSpec(mesh={"file": mesh}, film={"model": model}, sweep={"loads": loads})


def everything(folder: Path) -> dict[str, object]:
    """Return what a folder holds, seconds aside."""
    with (folder / "sweep.csv").open(newline="") as file:
        rows = [
            {k: v for k, v in row.items() if k != "seconds"} for row in csv.DictReader(file)
        ]
    files = [*sorted((folder / "shapes").iterdir()), folder / "sweep.pvd"]
    return {"rows": rows} | {file.name: file.read_bytes() for file in files}


def interrupted(run, folder: Path, after: int) -> None:
    def stop(row) -> None:
        if row.step == after:
            raise StopError

    with pytest.raises(StopError):
        run(folder, stop)


@pytest.mark.parametrize(
    "model", quick_with(["dirichlet"], ["springs", "dirichlet", "area"])
)
def test_interrupted_sweep_ends_as_one_that_went_through(mesh, model, tmp_path):
    """To the bit: rows, shapes and their series."""
    loads = LOADS if model == "springs" else [3 * load for load in LOADS[:4]]
    spec = film(mesh, model, loads)
    run_sweep(spec, tmp_path / "whole")
    interrupted(lambda *args: run_sweep(spec, *args), tmp_path / "parts", 1)
    interrupted(lambda *args: run_sweep(spec, *args), tmp_path / "parts", 2)
    result = run_sweep(spec, tmp_path / "parts")
    assert (result.kept, result.finished) == (3, False)
    assert everything(tmp_path / "parts") == everything(tmp_path / "whole")


def test_interrupted_sweep_of_a_cell_ends_as_one_that_went_through(tmp_path):
    run_cell_sweep(CELL, tmp_path / "whole")
    interrupted(lambda *args: run_cell_sweep(CELL, *args), tmp_path / "parts", 1)
    assert run_cell_sweep(CELL, tmp_path / "parts").kept == 2
    assert everything(tmp_path / "parts") == everything(tmp_path / "whole")


def test_finished_run_is_not_computed_again(mesh, tmp_path):
    spec = film(mesh, "springs", LOADS[:2])
    first = run_sweep(spec, tmp_path / "run")
    before = {file: file.stat().st_mtime_ns for file in tmp_path.rglob("*.vtp")}
    again = run_sweep(spec, tmp_path / "run", lambda row: pytest.fail("computed a row"))
    assert (again.finished, again.rows) == (True, first.rows)
    assert {file: file.stat().st_mtime_ns for file in tmp_path.rglob("*.vtp")} == before


@pytest.mark.parametrize("finished", quick_with([True], [False, True]))
def test_damaged_last_rows_are_computed_again(mesh, tmp_path, finished):
    """A row cut off by a loss of power, and a shape that is not whole."""
    spec = film(mesh, "springs", LOADS[:4] if finished else LOADS)
    run_sweep(spec, tmp_path / "whole")
    for damage in ("row", "shape"):
        folder = tmp_path / damage
        if finished:
            shutil.copytree(tmp_path / "whole", folder)
        else:
            interrupted(lambda *args: run_sweep(spec, *args), folder, 3)
        if damage == "row":
            table = folder / "sweep.csv"
            table.write_bytes(table.read_bytes()[:-40])
        else:
            shape = folder / "shapes/shape_0003.vtp"
            shape.write_bytes(shape.read_bytes()[:1000])
        again = run_sweep(spec, folder)
        assert (again.finished, again.kept) == (False, 3)
        assert everything(folder) == everything(tmp_path / "whole")


def test_loads_appended_continue_a_run_if_that_is_asked_for(mesh, tmp_path):
    short, long = (film(mesh, "springs", loads) for loads in (LOADS[:3], LOADS))
    run_sweep(short, tmp_path / "run")
    with pytest.raises(ConflictError, match=r"sweep\.loads"):
        run_sweep(long, tmp_path / "run")
    assert run_sweep(long, tmp_path / "run", resume=True).kept == 3
    run_sweep(long, tmp_path / "whole")
    assert everything(tmp_path / "run") == everything(tmp_path / "whole")
    with pytest.raises(ConflictError):
        run_sweep(film(mesh, "springs", LOADS[1:]), tmp_path / "run", resume=True)


def test_another_run_is_refused_by_the_keys_that_differ_and_kept(mesh, tmp_path):
    spec = film(mesh, "springs", LOADS[:2])
    run_sweep(spec, tmp_path / "run")
    before = everything(tmp_path / "run")
    other = RunSpec(
        mesh={"file": mesh},
        start={"seed": 2},
        sweep={"loads": LOADS[:2]},
        solver={"name": "cg"},
    )
    with pytest.raises(ConflictError) as caught:
        run_sweep(other, tmp_path / "run")
    assert caught.value.keys == ["solver.name", "start.seed"]
    with pytest.raises(ConflictError):
        run_branches(spec, tmp_path / "run")
    assert everything(tmp_path / "run") == before


def test_mesh_is_known_by_its_contents_not_by_its_path(mesh, tmp_path):
    run_sweep(film(mesh, "springs", LOADS[:2]), tmp_path / "run")
    copy = tmp_path / "copy.vtp"
    copy.write_bytes(Path(mesh).read_bytes())
    assert run_sweep(film(str(copy), "springs", LOADS[:2]), tmp_path / "run").finished


def test_second_writer_is_told_who_writes(mesh, tmp_path):
    spec = film(mesh, "springs", LOADS[:2])

    def second(row) -> None:
        with pytest.raises(ConflictError, match=f"process {os.getpid()}"):
            run_sweep(spec, tmp_path / "run")

    run_sweep(spec, tmp_path / "run", second)
    assert not (tmp_path / "run/.writer").exists()


def test_command_line_refuses_before_any_run_computes(mesh, tmp_path):
    text = f'[mesh]\nfile = "{mesh}"\n[sweep]\nloads = [500.0]\n'
    for name in ("a", "b"):
        (tmp_path / f"{name}.toml").write_text(text)
    words = [tmp_path / "a.toml", tmp_path / "b.toml", "--no-pictures", "--quiet"]
    assert run_here("sweep", tmp_path / "b.toml", *words[2:]).returncode == 0
    for name in ("a", "b"):
        (tmp_path / f"{name}.toml").write_text(f"{text}[start]\nseed = 7\n")
    changed = run_here("sweep", *words)
    assert changed.returncode == 6
    assert not (tmp_path / "a").exists()
    (line,) = changed.stderr.splitlines()
    assert "start.seed" in line
    assert "--overwrite" in line
    assert run_here("sweep", *words, "--overwrite").returncode == 0
    again = run_here("sweep", *words[:3])
    assert again.returncode == 0
    assert again.stderr.count("finished before") == 2
