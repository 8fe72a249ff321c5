"""`eulerplateau ensemble` and `collect` as a shell sees them."""

from __future__ import annotations

import csv
import os
import signal
import subprocess
import time
from pathlib import Path

import pytest

from eulerplateau.mesh import mesh_polygon, write_mesh
from eulerplateau.runs.ensembles import running
from tests.helpers.command import Shell, command_line, run_here
from tests.helpers.processes import PATIENCE, shown_at_a_terminal, started

ROOT = Path(__file__).parents[2]
FILM = """
[mesh]
file = "oval.vtp"
[grid]
start.seed = [1, 2]
sweep.loads = [200, 400]
"""


@pytest.fixture(scope="module")
def oval_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("mesh") / "oval.vtp"
    write_mesh(mesh_polygon("ellipse", aspect=1.5, vertices=60), path)
    return path


@pytest.fixture
def spec(tmp_path: Path, oval_file: Path) -> Path:
    (tmp_path / "oval.vtp").write_bytes(oval_file.read_bytes())
    path = tmp_path / "films.toml"
    path.write_text(FILM)
    return path


@pytest.fixture
def _in_turn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Cases are carried out by this process."""

    def in_turn(function, tasks, count):
        return ((task, function(task)) for task in tasks)

    monkeypatch.setattr(running, "in_workers", in_turn)


def table(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return [
            {k: v for k, v in row.items() if k != "seconds"} for row in csv.DictReader(file)
        ]


def assert_is_a_line(result: Shell, code: int, name: str) -> None:
    assert (result.returncode, result.stdout) == (code, "")
    assert name in result.stderr.splitlines()[-1]
    assert "Traceback" not in result.stderr


@pytest.mark.usefixtures("_in_turn")
def test_scripts_are_told_a_line_a_case_and_nothing_if_they_ask_for_quiet(
    spec: Path,
) -> None:
    result = run_here("ensemble", spec)
    assert result.returncode == 0
    said = result.stderr.splitlines()
    assert [line.split()[0] for line in said] == ["1/4", "2/4", "3/4", "4/4"]
    assert "start.seed=1, sweep.loads=[200]: 1 row in " in said[0]
    assert "4 rows of 4 cases" in result.stdout
    again = run_here("ensemble", spec)
    assert (again.stderr, again.stdout.count("4 of them before")) == ("", 1)
    quiet = run_here("ensemble", spec, "--quiet", "--out", spec.parent / "other")
    assert (quiet.returncode, quiet.stdout, quiet.stderr) == (0, "", "")
    assert table(spec.parent / "other/ensemble.csv") == table(
        spec.parent / "films/ensemble.csv"
    )


@pytest.mark.usefixtures("_in_turn")
def test_shards_are_joined_by_collect(spec: Path, tmp_path: Path) -> None:
    assert run_here("ensemble", spec, "--quiet", "--out", tmp_path / "all").returncode == 0
    first = run_here("ensemble", spec, "--shard", "0/2")
    assert f"eulerplateau collect {spec.with_suffix('')}" in first.stdout
    assert not (tmp_path / "films/ensemble.csv").exists()
    words = ["collect", tmp_path / "films", "-o", tmp_path / "table.csv"]
    half = run_here(*words)
    assert half.returncode == 0
    assert half.stderr.startswith("eulerplateau: not computed: ")
    assert len(table(tmp_path / "table.csv")) == 2
    assert run_here("ensemble", spec, "--shard", "1/2", "--quiet").returncode == 0
    whole = run_here(*words, "--quiet")
    assert (whole.returncode, whole.stdout, whole.stderr) == (0, "", "")
    assert table(tmp_path / "table.csv") == table(tmp_path / "all/ensemble.csv")


@pytest.mark.slow
@pytest.mark.usefixtures("_in_turn")
def test_worst_of_all_cases_is_the_exit_code(spec: Path, tmp_path: Path) -> None:
    spec.write_text(FILM.replace("[grid]", "[grid]\nsolver.max_iterations = [1, 500]"))
    result = run_here("ensemble", spec, "--quiet")
    assert_is_a_line(result, 4, "0 of 8 cases failed, 4 rows did not converge")
    spec.write_text(FILM.replace("[grid]", '[grid]\nmesh.file = ["oval.vtp", "flat.vtp"]'))
    (tmp_path / "flat.vtp").write_text("nothing of the kind")
    result = run_here("ensemble", spec)
    assert result.returncode == 3
    assert "4 of 8 cases failed" in result.stderr.splitlines()[-1]
    assert result.stderr.count("failed: ") == 4


@pytest.mark.parametrize(
    ("words", "code", "name"),
    [
        (["--shard", "2/2"], 2, "--shard: found 2/2"),
        (["--shard", "half"], 2, "should be I/N"),
        (["--workers", "0"], 2, "--workers: found 0"),
        (["--workers", "2", "--dask", "tcp://x:1"], 2, "--workers or --dask"),
        (["--out", "/proc/none"], 5, "/proc/none"),
    ],
)
@pytest.mark.usefixtures("_in_turn")
def test_wrong_arguments_are_a_line(
    spec: Path, words: list[str], code: int, name: str
) -> None:
    assert_is_a_line(run_here("ensemble", spec, *words), code, name)
    assert not spec.with_suffix("").exists()


@pytest.mark.parametrize(
    ("words", "code", "name"),
    [
        (["."], 5, "none in it"),
        ([".", "-o", "table.xlsx"], 2, ".csv or .parquet"),
    ],
)
def test_collect_says_what_it_lacks(
    tmp_path: Path, words: list[str], code: int, name: str
) -> None:
    assert_is_a_line(run_here("collect", *words, cwd=tmp_path), code, name)


@pytest.mark.parametrize("missing", ["pyarrow", "distributed"])
def test_extra_that_is_missing_is_named(
    spec: Path, monkeypatch: pytest.MonkeyPatch, missing: str
) -> None:
    monkeypatch.setitem(__import__("sys").modules, missing, None)
    words = {"pyarrow": ["--parquet"], "distributed": ["--dask", "tcp://127.0.0.1:9"]}
    extra = {"pyarrow": "parquet", "distributed": "dask"}[missing]
    result = run_here("ensemble", spec, *words[missing])
    assert_is_a_line(result, 1, f"pip install 'eulerplateau[{extra}]'")


# As programs of their own, with workers that take a second or two to begin.


@pytest.mark.slow
def test_people_see_a_bar_with_the_time_left(spec: Path) -> None:
    shown = shown_at_a_terminal(command_line("ensemble", spec))
    assert b"films:" in shown
    assert b"4/4" in shown
    assert b"<" in shown.rpartition(b"4/4")[2]  # time gone < time left


@pytest.mark.slow
def test_example_ends_with_0_within_a_minute(tmp_path: Path) -> None:
    began = time.monotonic()
    words = ["ensemble", ROOT / "runs/ensemble.toml", "--quiet", "--out", tmp_path / "out"]
    done = subprocess.run(command_line(*words), check=False)
    assert done.returncode == 0
    assert time.monotonic() - began < 60
    assert {row["status"] for row in table(tmp_path / "out/ensemble.csv")} == {"converged"}


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_interrupted_call_leaves_folders_that_a_repeated_one_completes(
    spec: Path, number: signal.Signals
) -> None:
    spec.write_text(FILM.replace("[1, 2]", "[{ start = 1, stop = 200, step = 1 }]"))
    out = spec.with_suffix("")
    with started(command_line("ensemble", spec, "--workers", 2)) as process:
        for _ in range(3):
            assert process.stderr.readline()
        os.killpg(process.pid, number) if number == signal.SIGINT else process.send_signal(
            number
        )
        _, err = process.communicate(timeout=PATIENCE)
    assert process.returncode == 128 + number
    assert err.splitlines()[-1].startswith("eulerplateau: interrupted")
    assert "Traceback" not in err
    before = {file: file.stat().st_mtime_ns for file in out.glob("cases/*/sweep.csv")}
    finished = run_here("collect", out, "-o", spec.parent / "part.csv")
    assert finished.returncode == 0
    spec.write_text(FILM)
    assert run_here("ensemble", spec, "--quiet").returncode == 0
    assert len(table(out / "ensemble.csv")) == 4
    kept = [file for file in before if file.stat().st_mtime_ns == before[file]]
    assert len(kept) >= 3


@pytest.mark.slow
def test_worker_that_is_killed_costs_nothing_but_time(spec: Path) -> None:
    """Once by a signal from outside, as by one who is out of memory."""
    spec.write_text(FILM.replace("[1, 2]", "[{ start = 1, stop = 60, step = 1 }]"))
    with started(command_line("ensemble", spec, "--workers", 2)) as process:
        assert process.stderr.readline()
        children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text()
        workers = [
            int(child)
            for child in children.split()
            if b"spawn_main" in Path(f"/proc/{child}/cmdline").read_bytes()
        ]
        assert len(workers) == 2
        os.kill(workers[0], signal.SIGKILL)
        _, err = process.communicate(timeout=PATIENCE)
    assert process.returncode == 0, err
    rows = table(spec.with_suffix("") / "ensemble.csv")
    assert len(rows) == 120
    assert {row["status"] for row in rows} == {"converged"}


THOUSAND = """
[mesh]
file = "{}"
[grid]
sweep.loads = [{{ start = 100, stop = 1099, step = 1 }}]
"""


@pytest.mark.slow
@pytest.mark.skipif(len(os.sched_getaffinity(0)) < 2, reason="is about two cores")
def test_a_thousand_cases_take_three_minutes_and_two_workers_share_them(
    tmp_path: Path,
) -> None:
    """One load each on the stored mesh of 474 vertices, start-up included."""
    (tmp_path / "films.toml").write_text(THOUSAND.format(ROOT / "meshes/hexagon.vtp"))
    seconds = {}
    for workers in (2, 1):
        out = tmp_path / str(workers)
        words = ["ensemble", tmp_path / "films.toml", "--quiet", "--out", out]
        began = time.monotonic()
        done = subprocess.run(command_line(*words, "--workers", workers), check=False)
        seconds[workers] = time.monotonic() - began
        assert done.returncode == 0
        assert len(table(out / "ensemble.csv")) == 1000
    assert seconds[2] <= 180
    # How much less is the machine's: what two processes on it do to each other.
    assert seconds[2] < seconds[1]
