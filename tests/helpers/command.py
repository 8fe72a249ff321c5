"""The command line in this process: what a shell would see, without Python's start."""

from __future__ import annotations

import contextlib
import io
import logging
import subprocess
import sys
from pathlib import Path
from unittest import mock

from eulerplateau.cli import main

Shell = subprocess.CompletedProcess[str]


def command_line(*words: object) -> list[str]:
    """The command as a program of its own."""
    return [sys.executable, "-m", "eulerplateau", *map(str, words)]


def run_in_shell(*words: object, cwd: Path | None = None) -> Shell:
    """Run the command as a program of its own."""
    return subprocess.run(
        command_line(*words), cwd=cwd, capture_output=True, text=True, check=False
    )


def run_here(*words: object, cwd: Path | None = None) -> Shell:
    """Run the command in this process, with its exit code and what it would print.

    An error that the program does not turn into an exit code is raised.
    """
    arguments = ["eulerplateau", *map(str, words)]
    out, err = io.StringIO(), io.StringIO()
    root = logging.getLogger()
    handlers, level = root.handlers[:], root.level
    root.handlers[:] = []  # so that the program brings its own, on `err`
    try:
        with (
            mock.patch.object(sys, "argv", arguments),
            contextlib.chdir(cwd or Path.cwd()),
            contextlib.redirect_stdout(out),
            contextlib.redirect_stderr(err),
        ):
            main()
    except SystemExit as end:
        code = int(end.code or 0)
    finally:
        root.handlers[:] = handlers
        root.setLevel(level)
    return Shell(arguments, code, out.getvalue(), err.getvalue())
