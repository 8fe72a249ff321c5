"""Render in a child process: a crash in a graphics driver costs a picture, not the run."""

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
        _log.warning("%s failed: no picture after %g s", module, timeout)
        return False
    except OSError as error:
        _log.warning("%s failed: cannot be started: %s", module, error.strerror)
        return False
    if done.returncode:
        _log.warning("%s failed: %s", module, _reason(done.returncode, done.stderr))
    return done.returncode == 0


def _reason(code: int, stderr: bytes) -> str:
    if code < 0:
        try:
            return f"killed by {signal.Signals(-code).name}"
        except ValueError:
            return f"killed by signal {-code}"
    lines = stderr.decode("utf-8", "replace").strip().splitlines()
    return lines[-1] if lines else f"exit code {code}"
