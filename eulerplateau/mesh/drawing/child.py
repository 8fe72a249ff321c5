"""Draw in a child process: a crash in a graphics driver costs a picture, not the run."""

from __future__ import annotations

import logging
import signal
import subprocess
import sys

_log = logging.getLogger(__name__)


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
    try:
        done = subprocess.run(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            timeout=timeout,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return f"no answer after {timeout:g} s"
    except OSError as error:
        return f"cannot be started: {error.strerror}"
    return _reason(done.returncode, done.stderr) if done.returncode else ""


def _reason(code: int, stderr: bytes) -> str:
    if code < 0:
        try:
            return f"killed by {signal.Signals(-code).name}"
        except ValueError:
            return f"killed by signal {-code}"
    lines = stderr.decode("utf-8", "replace").strip().splitlines()
    return lines[-1] if lines else f"exit code {code}"
