"""Processes that may die: it costs one retry of one task, and nothing else."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from eulerplateau.runs.ensembles.workers import Died, in_workers
from tests.helpers.processes import PATIENCE
from tests.helpers.tasks import noted


def begun(folder: Path, word: str) -> int:
    """Return how often a task was begun."""
    return len((folder / word).read_text().splitlines())


def test_a_worker_that_dies_costs_one_retry_of_one_task(tmp_path: Path) -> None:
    words = ["a", "die", "b", "c", "die-again", "d", "leave", "e"]
    ended = dict(in_workers(noted, [(word, tmp_path) for word in words], 2))
    results = {word: result for (word, _), result in ended.items()}
    assert results.keys() == set(words)
    assert {word: begun(tmp_path, word) for word in words} == {
        **dict.fromkeys("abcde", 1),
        **{"die": 2, "die-again": 2, "leave": 2},
    }
    assert results["die-again"] == Died("its process was killed by SIGKILL")
    assert results["leave"] == Died("its process ended with code 7")
    assert all(results[word][0] == word for word in (*"abcde", "die"))


def test_workers_keep_their_processes_and_are_no_more_than_asked_for(
    tmp_path: Path,
) -> None:
    tasks = [(str(number), tmp_path) for number in range(20)]
    processes = {result[1] for _, result in in_workers(noted, tasks, 2)}
    assert len(processes) <= 2
    assert os.getpid() not in processes
    for process in processes:
        with pytest.raises(ProcessLookupError):
            os.kill(process, 0)


@pytest.fixture
def interrupt_when_waiting(tmp_path: Path) -> Iterator[None]:
    """SIGINT, for the whole program as a terminal sends it, once a task waits."""

    def watch() -> None:
        end = time.monotonic() + PATIENCE
        while not (tmp_path / "wait").is_file() and time.monotonic() < end:
            time.sleep(0.01)
        for process in [int((tmp_path / "wait").read_text()), os.getpid()]:
            os.kill(process, signal.SIGINT)

    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    watcher = threading.Thread(target=watch)
    watcher.start()
    yield
    watcher.join()
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("interrupt_when_waiting")
def test_interruption_ends_workers_in_good_order(tmp_path: Path) -> None:
    """They are deaf to a terminal's signals, and are told to end by who started them."""
    with pytest.raises(KeyboardInterrupt):
        list(in_workers(noted, [("wait", tmp_path)], 1))
    assert (tmp_path / "ended").read_text() == str(128 + signal.SIGTERM)
    with pytest.raises(ProcessLookupError):
        os.kill(int((tmp_path / "wait").read_text()), 0)
