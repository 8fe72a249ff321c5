"""Runs that are killed, or out of disk, and go on: they end as one that went through."""

from __future__ import annotations

import random
import resource
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import pytest

from eulerplateau.errors import ConflictError, OutputError
from eulerplateau.mesh import write_mesh
from eulerplateau.runs import RunSpec, folder, run_cell_branches, run_sweep
from tests.helpers.command import command_line
from tests.helpers.processes import PATIENCE, started
from tests.helpers.shapes import disk_points, mesh_of
from tests.runs.test_resuming import CELL, everything, status, sweep_of

ROOT = Path(__file__).parents[2]
BRANCHES = "[branches]\nload_min = 635.0\nload_max = 700.0\nspecial_points = 1\n"
SWEEP = "[sweep]\nloads = [{ start = 500.0, stop = 780.0, step = 1.0 }]\n"


@contextmanager
def disk_of(size: int) -> Iterator[None]:
    """No file may outgrow a size, as on a disk that is full."""
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, limits[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)


@pytest.mark.parametrize(
    ("kind", "pattern"),
    [
        pytest.param("cell", "*.vtp", id="special point's shape", marks=pytest.mark.slow),
        pytest.param("cell", "branches.csv", id="row", marks=pytest.mark.slow),
        pytest.param("cell", ".checkpoint*", id="checkpoint", marks=pytest.mark.slow),
        pytest.param("sweep", "*.vtp", id="shape"),
        pytest.param("sweep", "run.json", id="run.json"),
    ],
)
def test_run_on_a_full_disk_ends_with_5_and_goes_on_when_there_is_room(
    kind: str, pattern: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever it is that does not fit, by a byte."""
    # Checkpoints are written at every row, not those that time has come for.
    monkeypatch.setattr(folder, "_SECOND", 0.0)
    run: Callable[..., Any] = run_cell_branches if kind == "cell" else run_sweep
    spec = CELL if kind == "cell" else sweep_of(tmp_path)
    whole, sizes = tmp_path / "whole", []

    def measure(row: Any) -> None:
        sizes.append(max(file.stat().st_size for file in whole.rglob(pattern)))

    run(spec, whole, measure)
    with disk_of(max(sizes) - 1), pytest.raises(OutputError) as caught:
        run(spec, tmp_path / "run")
    assert caught.value.exit_code == 5
    run(spec, tmp_path / "run")
    assert everything(tmp_path / "run") == everything(whole)
    assert status(tmp_path / "run") == "finished"


@pytest.mark.slow
def test_second_writer_of_branches_is_refused_and_disturbs_nothing(tmp_path: Path) -> None:
    second = []

    def write_too(row: Any) -> None:
        with pytest.raises(ConflictError) as caught:
            run_cell_branches(CELL, tmp_path / "run", overwrite=True)
        second.append(caught.value.exit_code)

    run_cell_branches(CELL, tmp_path / "run", write_too)
    run_cell_branches(CELL, tmp_path / "whole")
    assert set(second) == {6}
    assert everything(tmp_path / "run") == everything(tmp_path / "whole")


def specification(kind: str, folder: Path) -> Path:
    path = folder / f"{kind}.toml"
    mesh = f'[mesh]\nfile = "{ROOT / "meshes" / "elongated.vtp"}"\n'
    path.write_text(mesh + (SWEEP if kind == "sweep" else SWEEP + BRANCHES))
    return path


def killed(words: list[str], number: signal.Signals, after: float) -> bool:
    """Start a program and end it after so many seconds; return whether it was over."""
    with started(words) as process:
        with suppress(subprocess.TimeoutExpired):
            process.communicate(timeout=after)
            return True
        process.send_signal(number)
        process.communicate(timeout=PATIENCE)
    return False


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["sweep", "branches"])
def test_run_killed_at_twenty_moments_ends_as_one_that_went_through(
    kind: str, tmp_path: Path
) -> None:
    """By SIGKILL and by SIGTERM, at random, and as often as it takes to be over."""
    dice = random.Random(1)
    words = command_line(kind, specification(kind, tmp_path), "--no-pictures", "--quiet")
    began = time.monotonic()
    assert killed([*words, "--out", str(tmp_path / "whole")], signal.SIGKILL, PATIENCE)
    seconds = time.monotonic() - began
    kills, ends = 0, 0
    while kills < 20 or ends == 0:
        parts = tmp_path / f"parts{ends}"
        number = dice.choice([signal.SIGKILL, signal.SIGTERM])
        after = dice.uniform(0.0, 0.8 * seconds) if kills < 20 else PATIENCE
        if killed([*words, "--out", str(parts)], number, after):
            assert status(parts) == "finished"
            assert everything(parts) == everything(tmp_path / "whole")
            ends += 1
        else:
            kills += 1


@pytest.mark.slow
def test_row_of_a_long_sweep_costs_the_same_at_its_end_as_at_its_beginning(
    tmp_path: Path,
) -> None:
    """5,000 loads, in seconds of this process, which other work does not lengthen."""
    write_mesh(mesh_of(*disk_points(2)), tmp_path / "mesh.vtp")
    spec = RunSpec(
        mesh={"file": str(tmp_path / "mesh.vtp")},
        sweep={"loads": [{"start": 100.0, "stop": 149.99, "step": 0.01}]},
    )
    at: list[float] = []
    run_sweep(spec, tmp_path / "run", lambda row: at.append(time.process_time()))
    assert len(at) == 5000
    # The first rows bring what is loaded and compiled.
    first, last = (at[600] - at[100]) / 500, (at[-1] - at[-501]) / 500
    assert last < 1.3 * first
