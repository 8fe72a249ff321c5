"""SIGINT, SIGTERM and SIGHUP, at any moment: heeded in time, never lost, never a crash."""

from __future__ import annotations

import json
import random
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from eulerplateau.mesh import write_mesh
from eulerplateau.mesh.disk import Disk
from eulerplateau.runs.table import read_rows
from tests.helpers.command import command_line
from tests.helpers.processes import PATIENCE, Process, started

CODES = {"INT": 130, "TERM": 143, "HUP": 129}
# Does nothing but what is asked of it, with signals listened to.
PROGRAM = """
import sys, time
from eulerplateau import interruption
interruption.listen()
interruption.working_on(lambda: "folder", lambda: print("last act", flush=True))
print("listening", flush=True)
{}
interruption.stop_listening()
"""
BUSY = "time.sleep(1e6)"
# Holds on in native code, as Gmsh does: no handler of Python's runs before it returns.
NATIVE = "import hashlib; hashlib.pbkdf2_hmac('sha256', b'a', b'a', 2**31 - 1)"
ATTENTIVE = "while True: interruption.heed(); time.sleep(0.01)"


@pytest.fixture
def spec(tmp_path: Path, oval: Disk) -> Path:
    """A run of many loads on a stored mesh of 127 vertices."""
    write_mesh(oval, tmp_path / "oval.vtp")
    path = tmp_path / "run.toml"
    loads = "[{start = 1, stop = 3000, step = 0.1}]"
    path.write_text(f'[mesh]\nfile = "oval.vtp"\n[sweep]\nloads = {loads}\n')
    return path


def listening(does: str) -> list[str]:
    return [sys.executable, "-c", PROGRAM.format(does)]


def ended(process: Process, name: str, code: int) -> str:
    """Send a signal, see that the program ends by it; return what it says of that."""
    process.send_signal(signal.Signals[f"SIG{name}"])
    _, said = process.communicate(timeout=PATIENCE)
    assert process.returncode == code
    return said


def test_what_looks_is_ended_by_itself_and_says_what_there_is() -> None:
    with started(listening(ATTENTIVE)) as process:
        assert process.stdout.readline() == "listening\n"
        process.send_signal(signal.SIGTERM)
        out, said = process.communicate(timeout=PATIENCE)
    assert "Interrupted" in said
    assert out == ""


@pytest.mark.parametrize("busy", [BUSY, NATIVE])
def test_second_signal_ends_at_once_whatever_the_program_does(busy: str) -> None:
    """With the code of the first, the last act, and a line."""
    with started(listening(busy)) as process:
        assert process.stdout.readline() == "listening\n"
        process.send_signal(signal.SIGTERM)
        time.sleep(0.2)
        assert process.poll() is None
        process.send_signal(signal.SIGINT)
        out, said = process.communicate(timeout=PATIENCE)
    assert (process.returncode, out) == (143, "last act\n")
    assert said == "eulerplateau: interrupted: folder\n"


@pytest.mark.slow
def test_nobody_waits_longer_than_five_seconds() -> None:
    with started(listening(NATIVE)) as process:
        assert process.stdout.readline() == "listening\n"
        process.send_signal(signal.SIGHUP)
        began = time.monotonic()
        assert process.wait(PATIENCE) == 129
        assert 4.9 < time.monotonic() - began < 8.0


def test_signal_that_nobody_looks_for_any_more_is_not_lost() -> None:
    """It comes after the last iteration: the program ends with its code, not with 0."""
    with started(listening("import os; os.kill(os.getpid(), 15)")) as process:
        _, said = process.communicate(timeout=PATIENCE)
    assert "Interrupted" in said


def test_signal_that_was_ignored_stays_so() -> None:
    ignored = "import os, signal, sys; signal.signal(signal.SIGHUP, signal.SIG_IGN); "
    words = [sys.executable, "-c", f"{ignored}os.execv(sys.executable, sys.argv[1:])"]
    program = PROGRAM.format("time.sleep(0.5); print('went on', flush=True)")
    with started([*words, sys.executable, "-c", program]) as process:
        assert process.stdout.readline() == "listening\n"
        process.send_signal(signal.SIGHUP)
        assert process.stdout.readline() == "went on\n"
        assert process.wait(PATIENCE) == 0


def rows_of(spec: Path) -> int:
    table = spec.with_suffix("") / "sweep.csv"
    return table.read_bytes().count(b"\n") - 1 if table.is_file() else 0


def wait(process: Process, until: Callable[[], bool]) -> None:
    deadline = time.monotonic() + PATIENCE
    while not until():
        assert process.poll() is None
        assert time.monotonic() < deadline
        time.sleep(0.02)


def valid(folder: Path, said: str) -> None:
    """What an interrupted sweep leaves says so, and the message says what is there."""
    assert "Traceback" not in said
    if not (folder / "run.json").exists():
        assert not folder.exists()
        return
    about = json.loads((folder / "run.json").read_text())
    rows = read_rows(folder / "sweep.csv")
    assert about["status"] == "interrupted"
    assert about["totals"].get("loads", 0) == len(rows)
    there = f"{len(rows)} rows are there" if rows else "nothing is there yet"
    assert said == f"eulerplateau: interrupted: {folder}: {there}\n"


@pytest.mark.parametrize(
    "name",
    ["INT", *(pytest.param(other, marks=pytest.mark.slow) for other in ("TERM", "HUP"))],
)
def test_sweep_ends_with_the_code_of_its_signal_and_names_its_folder(
    spec: Path, name: str
) -> None:
    with started(command_line("sweep", "--no-pictures", "--quiet", spec)) as process:
        wait(process, lambda: rows_of(spec) > 2)
        valid(spec.with_suffix(""), ended(process, name, CODES[name]))
    assert rows_of(spec) > 2


def wait_until_it_listens(process: Process) -> None:
    """Python's own start is over, and our first lines."""
    status = Path(f"/proc/{process.pid}/status")

    def listens() -> bool:
        lines = status.read_text().splitlines()
        caught = next(line.split()[1] for line in lines if line.startswith("SigCgt:"))
        # A bit for each signal that the program catches; SIGHUP is the last of ours.
        return bool(int(caught, 16) >> (signal.SIGHUP - 1) & 1)

    wait(process, listens)


def test_signal_during_imports_is_heeded_after_them(spec: Path) -> None:
    """It comes as soon as somebody listens, long before there is a folder."""
    with started(command_line("sweep", "--no-pictures", "--quiet", spec)) as process:
        wait_until_it_listens(process)
        said = ended(process, "TERM", 143)
    assert "nothing is there yet" in said
    valid(spec.with_suffix(""), said)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(10))
def test_ten_signals_spread_over_the_life_of_a_sweep(spec: Path, seed: int) -> None:
    """Imports included: no crash, no signal or row lost, no folder left running."""
    dice = random.Random(seed)
    folder, kept = spec.with_suffix(""), 0
    for name in ("INT", "TERM") * 5:
        with started(command_line("sweep", "--no-pictures", "--quiet", spec)) as process:
            wait_until_it_listens(process)
            time.sleep(dice.uniform(0.0, 2.0))
            said = ended(process, name, CODES[name])
        (line,) = said.splitlines()
        assert line.startswith("eulerplateau: interrupted")
        if (folder / "run.json").exists():
            about = json.loads((folder / "run.json").read_text())
            assert about["status"] == "interrupted"
            before, kept = kept, len(read_rows(folder / "sweep.csv"))
            assert kept >= before
