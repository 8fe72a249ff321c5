"""One child that draws for many tests: VTK and what it loads take seconds to start."""

from __future__ import annotations

import atexit
import json
import os
import subprocess
import sys
from functools import cache

import pytest

from eulerplateau.mesh.drawing import child, picture

# Each line it is sent names a folder to be in, a module and its arguments; it answers with
# what failed.
_SERVE = """
import json, os, runpy, sys, traceback
answers = os.fdopen(os.dup(1), "w")
for line in sys.stdin:
    folder, module, *sys.argv[1:] = json.loads(line)
    os.chdir(folder)
    failure = ""
    try:
        runpy.run_module(module, run_name="__main__")
    except Exception as error:
        failure = traceback.format_exception_only(error)[-1].strip().splitlines()[-1]
    print(json.dumps(failure), file=answers, flush=True)
"""


def let_one_child_draw(patch: pytest.MonkeyPatch) -> None:
    """Draw in a child that lives on, and ends with this process, from now on."""
    patch.setattr(child, "failure_of_child", _failure)
    patch.setattr(picture, "failure_of_child", _failure)


def _failure(module: str, *arguments: str, timeout: float | None) -> str:
    drawing = _started()
    assert drawing.stdin is not None
    assert drawing.stdout is not None
    print(json.dumps([os.getcwd(), module, *arguments]), file=drawing.stdin, flush=True)
    answer = drawing.stdout.readline()
    return str(json.loads(answer)) if answer else f"exit code {drawing.wait()}"


@cache
def _started() -> subprocess.Popen[str]:
    pipe = subprocess.PIPE
    drawing = subprocess.Popen(
        [sys.executable, "-c", _SERVE], stdin=pipe, stdout=pipe, text=True
    )
    atexit.register(drawing.communicate)
    return drawing
