"""Explorations that go on, and runs that take the place of others: nothing is lost."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from eulerplateau.errors import SpecError
from eulerplateau.mesh import write_mesh
from eulerplateau.runs import (
    CellRunSpec,
    RunSpec,
    load_cell_run,
    load_run,
    run_branches,
    run_cell_branches,
    run_sweep,
)
from eulerplateau.runs.checkpoint import CHECKPOINTS
from tests.helpers.command import run_here
from tests.helpers.marks import quick_with
from tests.helpers.shapes import disk_points, mesh_of

ROOT = Path(__file__).parents[2]
WINDOW = {"branches.load_min": 640.0, "branches.load_max": 670.0}
CELL = CellRunSpec(
    cell={"adhesions": 3, "edges_per_side": 8, "ks_hat": 100.0},
    sweep={"values": [55.0, 57.0]},
    branches={"special_points": 1},
)
RUNS = {"springs": run_branches, "soap": run_branches, "cell": run_cell_branches}


class StopError(Exception):
    """What a test interrupts a run with."""


def spec_of(kind: str, folder: Path) -> Any:
    if kind == "springs":
        settings = {**WINDOW, "branches.special_points": 1}
        return load_run(ROOT / "runs" / "elongated.toml", settings)
    if kind == "cell":
        return CELL
    points, triangles = disk_points(6)
    write_mesh(mesh_of(points * [1.3, 1.0], triangles), folder / "oval.vtp")
    return RunSpec(
        mesh={"file": str(folder / "oval.vtp")},
        film={"model": "area"},
        sweep={"loads": [1790.0, 1820.0]},
        branches={"special_points": 1},
    )


def everything(folder: Path) -> dict[str, object]:
    """Return what a folder holds, seconds aside, and what run.json says."""
    found: dict[str, object] = {}
    for file in folder.rglob("*"):
        if file.suffix == ".csv":
            with file.open(newline="") as text:
                rows = list(csv.DictReader(text))
            found[file.name] = [{**row, "seconds": ""} for row in rows]
        elif file.is_file() and file.name != "run.json":
            found[file.name] = file.read_bytes()
    return found


def status(folder: Path) -> str:
    return str(json.loads((folder / "run.json").read_text())["status"])


def interrupted(run: Callable[..., Any], spec: Any, folder: Path, after: int) -> None:
    def stop(row: Any) -> None:
        if row.step == after:
            raise StopError

    with pytest.raises(StopError):
        run(spec, folder, stop)
    assert status(folder) == "interrupted"


@pytest.mark.parametrize("kind", quick_with(["cell"], ["springs", "cell", "soap"]))
def test_interrupted_exploration_ends_as_one_that_went_through(
    kind: str, tmp_path: Path
) -> None:
    """To the bit: rows, special points, shapes and their series; and no row twice."""
    run, spec = RUNS[kind], spec_of(kind, tmp_path)
    whole = run(spec, tmp_path / "whole")
    assert len(whole.special) > 0
    parts = tmp_path / "parts"
    for after in (len(whole.rows) // 3, len(whole.rows) - 2):
        interrupted(run, spec, parts, after)
    computed = []
    result = run(spec, parts, computed.append)
    assert result.kept > 0
    assert [row.step for row in computed] == list(range(result.kept, len(whole.rows)))
    assert everything(parts) == everything(tmp_path / "whole")
    assert status(parts) == "finished"


@pytest.fixture(scope="module")
def left(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, RunSpec, Path]:
    """A whole exploration, its specification, and one that was interrupted late."""
    folder = tmp_path_factory.mktemp("left")
    spec = spec_of("springs", folder)
    rows = run_branches(spec, folder / "whole").rows
    interrupted(run_branches, spec, folder / "parts", len(rows) - 2)
    return folder / "whole", spec, folder / "parts"


def copied(folder: Path, to: Path) -> Path:
    for file in folder.rglob("*"):
        if file.is_file():
            target = to / file.relative_to(folder)
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(file.read_bytes())
    return to


@pytest.mark.parametrize(
    "damage",
    quick_with(["rows"], ["last checkpoint", "all checkpoints", "rows", "special"]),
)
def test_what_is_damaged_is_computed_again(
    left: tuple[Path, RunSpec, Path], damage: str, tmp_path: Path
) -> None:
    """From the checkpoint before that is whole, from the beginning if there is none."""
    whole, spec, folder = left
    folder = copied(folder, tmp_path / "run")
    broken = {"last checkpoint": [newest(folder)], "all checkpoints": CHECKPOINTS}
    for name in CHECKPOINTS:
        content = (folder / name).read_bytes()
        if name in broken.get(damage, []):
            (folder / name).write_bytes(content[:-9] + b"x" + content[-8:])
    table = folder / "branches.csv"
    if damage == "rows":
        # Cut in the row after those that the checkpoint before the last goes on from.
        older = min(rows_of(folder / name) for name in CHECKPOINTS)
        lines = table.read_bytes().split(b"\n")
        table.write_bytes(b"\n".join(lines[: older + 1]) + b"\n0,1")
    if damage == "special":
        (folder / "special_points.csv").write_bytes(b"")
    result = run_branches(spec, folder)
    # Without its special points a run goes on from before the first, if it was kept there.
    if damage != "special":
        assert (result.kept > 0) == (damage != "all checkpoints")
    assert ("begins again" in result.before) == (result.kept == 0)
    assert everything(folder) == everything(whole)


def rows_of(checkpoint: Path) -> int:
    content = checkpoint.read_bytes().split(b"\n", 1)[1]
    with np.load(io.BytesIO(content)) as arrays:
        return int(arrays["rows"])


def newest(folder: Path) -> str:
    return max(CHECKPOINTS, key=lambda name: (folder / name).stat().st_mtime_ns)


def test_exploration_goes_on_elsewhere_with_a_line_that_says_so(
    left: tuple[Path, RunSpec, Path], tmp_path: Path
) -> None:
    whole, _, folder = left
    folder = copied(folder, tmp_path / "run")
    about = json.loads((folder / "run.json").read_text())
    about["versions"]["numpy"] = "1.0"
    (folder / "run.json").write_text(json.dumps(about))
    words = [f"--set={key}={value}" for key, value in WINDOW.items()]
    words += ["--set=branches.special_points=1", "--no-pictures", "--out", str(folder)]
    done = run_here("branches", ROOT / "runs" / "elongated.toml", *words, "--resume")
    assert done.returncode == 0
    assert "other versions" in done.stderr
    assert everything(folder) == everything(whole)
    again = run_here("branches", ROOT / "runs" / "elongated.toml", *words)
    assert "finished before" in again.stderr


@pytest.mark.slow
def test_command_goes_on_and_tells_special_points_of_both_calls(tmp_path: Path) -> None:
    path = tmp_path / "cell.toml"
    path.write_text(
        "[cell]\nadhesions = 3\nedges_per_side = 8\nks_hat = 100.0\n"
        "[sweep]\nvalues = [55.0, 57.0]\n[branches]\nspecial_points = 1\n"
    )
    spec, folder = load_cell_run(path, {}), tmp_path / "out"
    words = "--no-pictures", "--out"
    whole = run_here("cell", "branches", path, *words, tmp_path / "whole")
    last = len((tmp_path / "whole" / "branches.csv").read_text().splitlines()) - 3
    interrupted(run_cell_branches, spec, folder, last)
    done = run_here("cell", "branches", path, *words, folder, "--resume")
    assert done.returncode == whole.returncode
    assert "goes on after" in done.stderr
    told = whole.stdout.splitlines()[:-1]
    assert done.stdout.splitlines()[:-1] == told != []


def sweep_of(folder: Path, **more: Any) -> RunSpec:
    write_mesh(mesh_of(*disk_points(4)), folder / "mesh.vtp")
    return RunSpec(
        mesh={"file": str(folder / "mesh.vtp")}, sweep={"loads": [300.0, 400.0]}, **more
    )


def test_another_run_is_replaced_once_the_new_one_has_a_row(tmp_path: Path) -> None:
    old, new = sweep_of(tmp_path), sweep_of(tmp_path, start={"seed": 2})
    run_sweep(old, tmp_path / "run")
    before = everything(tmp_path / "run")
    seen = []

    def look(row: Any) -> None:
        seen.append(set(everything(tmp_path / "run")))

    run_sweep(new, tmp_path / "fresh")
    run_sweep(new, tmp_path / "run", look, overwrite=True)
    assert seen[0] == set(before) - {"shape_0001.vtp", "loop_0001.vtp"} | {".writer"}
    assert everything(tmp_path / "run") == everything(tmp_path / "fresh")


@pytest.mark.parametrize("end", [KeyboardInterrupt, SpecError("load", "is wrong")])
def test_run_that_fails_before_its_first_row_replaces_nothing(
    tmp_path: Path, end: BaseException, monkeypatch: pytest.MonkeyPatch
) -> None:
    old, new = sweep_of(tmp_path), sweep_of(tmp_path, start={"seed": 2})
    run_sweep(old, tmp_path / "run")
    before = everything(tmp_path / "run")

    def fails(*args: object, **more: object) -> None:
        raise end

    monkeypatch.setattr("eulerplateau.runs.sweep.follow_steps", fails)
    with pytest.raises((KeyboardInterrupt, SpecError)):
        run_sweep(new, tmp_path / "run", overwrite=True)
    assert everything(tmp_path / "run") == before
    assert status(tmp_path / "run") == "finished"


def test_run_that_cannot_start_leaves_no_folder(tmp_path: Path) -> None:
    spec = sweep_of(tmp_path)
    wrong = spec.model_copy(
        update={"branches": spec.branches.model_copy(update={"load_max": 1e6})}
    )
    assert wrong.branches.load_max == 1e6
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            "eulerplateau.runs.exploration.first_equilibrium",
            lambda *args: (_ for _ in ()).throw(SpecError("start", "none")),
        )
        with pytest.raises(SpecError):
            run_branches(wrong, tmp_path / "run")
    assert not (tmp_path / "run").exists()


def test_finished_exploration_solves_for_nothing(
    left: tuple[Path, RunSpec, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    whole, spec, _ = left
    monkeypatch.setattr("eulerplateau.runs.exploration.first_equilibrium", None)
    result = run_branches(spec, whole)
    assert (result.finished, len(result.special)) == (True, 1)


def test_finished_sweep_tells_of_its_neutral_rows_again(tmp_path: Path) -> None:
    """By what run.json says of them: nothing is computed."""
    spec = sweep_of(tmp_path)
    first = run_sweep(spec, tmp_path / "run")
    about = json.loads((tmp_path / "run" / "run.json").read_text())
    assert about["totals"]["neutral"] == list(first.neutral)
    about["totals"]["neutral"] = [1]
    (tmp_path / "run" / "run.json").write_text(json.dumps(about))
    again = run_sweep(spec, tmp_path / "run")
    assert again.finished
    assert again.neutral == (1,)
