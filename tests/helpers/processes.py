"""Programs that tests start and do not merely run: none of them outlives its test."""

from __future__ import annotations

import os
import pty
import signal
import subprocess
import termios
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

# Seconds. Only what hangs takes so long, however busy the machine.
PATIENCE = 600.0
_SIGNALS = signal.SIGINT, signal.SIGTERM, signal.SIGHUP

Process = subprocess.Popen[str]


@contextmanager
def started(
    command: list[str],
    *,
    cwd: Path | None = None,
    env: dict[str, str] | None = None,
) -> Iterator[Process]:
    """Start a program that can be interrupted; in the end kill all that is left of it.

    It has a process group of its own, so "all" includes what it started itself.
    """
    # A signal that is ignored stays so in every child, as SIGINT and SIGHUP do below
    # `nohup ... &`; one that is handled, by whatever function, has its default effect
    # there.
    before = {
        number: signal.signal(number, signal.default_int_handler) for number in _SIGNALS
    }
    try:
        process = subprocess.Popen(
            command,
            cwd=cwd,
            env=env,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
    with process:  # which waits, and closes the pipes
        try:
            yield process
        finally:
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)


def shown_at_a_terminal(command: Sequence[str]) -> bytes:
    """Carry out a command whose error stream is a terminal; return what it shows there."""
    ours, theirs = pty.openpty()
    termios.tcsetwinsize(theirs, (24, 120))
    with subprocess.Popen(command, stderr=theirs, stdout=subprocess.DEVNULL) as process:
        os.close(theirs)
        shown = b""
        while True:
            try:
                shown += os.read(ours, 65536)
            except OSError:  # the terminal's other end is closed
                break
    os.close(ours)
    assert process.returncode == 0
    return shown
