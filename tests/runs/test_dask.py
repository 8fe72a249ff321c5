"""Ensembles on a Dask cluster of this machine, by the command line as a user calls it."""

from __future__ import annotations

import csv
import os
import signal
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from eulerplateau.mesh import mesh_polygon, write_mesh
from eulerplateau.runs.ensembles import load_ensemble, run_ensemble
from tests.helpers.command import command_line, run_here
from tests.helpers.processes import PATIENCE, started

# Of Dask's own: what it leaves open where a worker is killed.
pytestmark = [
    pytest.mark.slow,
    pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning"),
    pytest.mark.filterwarnings("ignore::ResourceWarning"),
    pytest.mark.filterwarnings("ignore::DeprecationWarning"),
]

FILM = """
[mesh]
file = "oval.vtp"
[start]
displacement = 1e-2
[grid]
start.seed = [{{ start = 1, stop = {}, step = 1 }}]
sweep.loads = [[200, 250, 300, 350, 400]]
"""


@pytest.fixture
def cluster() -> Iterator[Any]:
    """Two workers, each with one thread; the one that is killed comes back."""
    from distributed import LocalCluster

    with LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    ) as made:
        yield made


def ensemble(folder: Path, cases: int) -> Path:
    write_mesh(mesh_polygon("ellipse", aspect=1.5, vertices=60), folder / "oval.vtp")
    (folder / "films.toml").write_text(FILM.format(cases))
    return folder / "films.toml"


def rows(folder: Path) -> list[dict[str, str]]:
    with (folder / "ensemble.csv").open(newline="") as file:
        return [
            {k: v for k, v in row.items() if k != "seconds"} for row in csv.DictReader(file)
        ]


def wait_for(folder: Path, cases: int) -> None:
    """Wait until so many cases have begun."""
    end = time.monotonic() + PATIENCE
    while len(list(folder.glob("cases/*/sweep.csv"))) < cases:
        assert time.monotonic() < end
        time.sleep(0.01)


def test_workers_that_are_killed_lose_nothing(cluster: Any, tmp_path: Path) -> None:
    path = ensemble(tmp_path, 24)
    words = ["ensemble", path, "--dask", cluster.scheduler_address, "--quiet"]
    with started(command_line(*words)) as process:
        for begun in (4, 14):
            wait_for(tmp_path / "films", begun)
            victim = min(cluster.workers.values(), key=lambda nanny: nanny.pid or 0)
            os.kill(victim.pid, signal.SIGKILL)
        out, err = process.communicate(timeout=PATIENCE)
    assert (process.returncode, out, err) == (0, "", "")
    run_ensemble(load_ensemble(path), tmp_path / "here", workers=2).table.write(
        tmp_path / "here/ensemble.csv"
    )
    assert len(rows(tmp_path / "films")) == 120
    assert rows(tmp_path / "films") == rows(tmp_path / "here")


def test_no_scheduler_is_a_line(tmp_path: Path) -> None:
    import dask

    path = ensemble(tmp_path, 1)
    with dask.config.set({"distributed.comm.timeouts.connect": "1s"}):
        result = run_here("ensemble", path, "--dask", "tcp://127.0.0.1:9", "--quiet")
    assert result.returncode == 2
    assert "--dask" in result.stderr.splitlines()[-1]
