"""A large film of true area: how its time and memory grow."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from scripts.studies.common import ROOT


def _measured(vertices: int) -> dict[str, Any]:
    module = [sys.executable, "-m", "scripts.studies.overheads.large", str(vertices)]
    told = subprocess.run(module, cwd=ROOT, stdout=subprocess.PIPE, check=True).stdout
    return dict(json.loads(told))


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="asks Linux's kernel")
def test_50_000_vertices_of_true_area_take_seconds_and_less_than_two_gigabytes() -> None:
    """A warm step, stability included; its time grows no faster than n_v^1.2.

    The quickest of five steps, in seconds of processor time.
    """
    small, large = (_measured(size) for size in (12_000, 50_000))
    assert large["warm"][0] < 10.0
    assert large["memory"] < 2048.0
    growth = large["vertices"] / small["vertices"]
    assert math.log(large["warm"][1] / small["warm"][1]) / math.log(growth) < 1.2
    assert math.log(large["memory"] / small["memory"]) / math.log(growth) < 1.2
