"""Draw in a child process: a crash in a graphics driver costs a picture, not the run."""

from __future__ import annotations

import logging
import math
import signal
import subprocess
import sys
import time
from contextlib import suppress
from subprocess import DEVNULL, PIPE

from eulerplateau.interruption import heed

_log = logging.getLogger(__name__)

# Seconds; a child that ends is noticed at once.
_BETWEEN_LOOKS = 0.2


def draw_in_child(module: str, *arguments: str, timeout: float) -> bool:
    """Run `python -m module arguments...`; return whether it ended well.

    A child that fails, crashes or takes longer than `timeout` seconds is logged as a
    warning with its last line, and never raises here.
    """
    failure = failure_of_child(module, *arguments, timeout=timeout)
    if failure:
        _log.warning("%s failed: %s", module, failure)
    return not failure


def failure_of_child(module: str, *arguments: str, timeout: float | None) -> str:
    """Run `python -m module arguments...`; return what failed, in a line, or "".

    Waits `timeout` seconds at most; for ever if it is None.
    """
    command = [sys.executable, "-m", module, *arguments]
    limit = math.inf if timeout is None else time.monotonic() + timeout
    try:
        child = subprocess.Popen(command, stdin=DEVNULL, stdout=DEVNULL, stderr=PIPE)
    except OSError as error:
        return f"cannot be started: {error.strerror}"
    with child:
        try:
            while True:
                heed()
                with suppress(subprocess.TimeoutExpired):
                    _, said = child.communicate(timeout=_BETWEEN_LOOKS)
                    return _reason(child.returncode, said) if child.returncode else ""
                if time.monotonic() > limit:
                    return f"no answer after {timeout:g} s"
        finally:
            child.kill()  # which does nothing to one that has ended


def _reason(code: int, stderr: bytes) -> str:
    if code < 0:
        try:
            return f"killed by {signal.Signals(-code).name}"
        except ValueError:
            return f"killed by signal {-code}"
    lines = stderr.decode("utf-8", "replace").strip().splitlines()
    return lines[-1] if lines else f"exit code {code}"
