"""What tests rely on when they start a program beside themselves."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from select import select

import pytest

from tests.helpers.processes import PATIENCE, started

# Says that it is there, then waits until it is told to end.
WAITING = "import time; print(flush=True); time.sleep(1e6)"

# Does not wait for what it started, which holds the pipe open as long as it lives.
PARENT = "sleep 1000000 & echo"


@pytest.fixture
def _ignored_interrupt() -> Iterator[None]:
    """SIGINT as it is below `nohup scripts/test &`."""
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("_ignored_interrupt")
def test_program_can_be_interrupted_even_if_the_tests_cannot() -> None:
    with started([sys.executable, "-c", WAITING]) as process:
        assert process.stdout.readline() == "\n"
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=PATIENCE)
    assert process.returncode == -signal.SIGINT
    assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN


def test_nothing_a_program_started_outlives_the_test() -> None:
    with started(["bash", "-c", PARENT]) as process:
        assert process.stdout.readline() == "\n"
        pipe = os.dup(process.stdout.fileno())
    assert select([pipe], [], [], PATIENCE)[0]
    assert os.read(pipe, 1) == b""
    os.close(pipe)
