"""A large film of true area: how its time and memory grow."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from scripts.studies.common import ROOT


def _measured(vertices: int) -> dict[str, Any]:
    module = [sys.executable, "-m", "scripts.studies.overheads.large", str(vertices)]
    told = subprocess.run(module, cwd=ROOT, stdout=subprocess.PIPE, check=True).stdout
    return dict(json.loads(told))


# Vertices of the meshes by which the growth is told, as asked for.
_SIZES = 500, 2_000, 8_000, 30_000


def _power(of: list[float], growing: list[float]) -> float:
    """Return the power with which one quantity grows with another, by least squares."""
    return float(np.polyfit(np.log(growing), np.log(of), 1)[0])


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="asks Linux's kernel")
def test_50_000_vertices_of_true_area_take_seconds_and_less_than_two_gigabytes() -> None:
    """A warm step, stability included, in seconds of processor time: the median of five."""
    large = _measured(50_000)
    assert large["warm"][0] < 10.0
    assert large["memory"] < 2048.0


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="asks Linux's kernel")
def test_a_step_of_true_area_grows_hardly_faster_than_its_mesh() -> None:
    """No faster than n_v^1.2, in seconds of processor time, as memory does."""
    measured = [_measured(size) for size in _SIZES]
    vertices = [each["vertices"] for each in measured]
    assert _power([each["warm"][0] for each in measured], vertices) < 1.2
    assert _power([each["memory"] for each in measured], vertices) < 1.2
