"""The shipped runs reproduce the paper's sequence and, within limits, its loads.

Limits: what meshes alone can shift (docs/transitions.md). Giomi, Softly constrained films,
section "Numerical simulations of the soap film shapes".
"""

from __future__ import annotations

from functools import cache
from itertools import groupby, pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from eulerplateau.runs.rows import Row
from eulerplateau.runs.spec import load_run
from eulerplateau.runs.sweep import run_sweep
from tests.conftest import ROOT

PLANAR = 1e-3


def state(row: Row) -> str:
    if row.abs_kappa_n > PLANAR:
        return "in space"
    return "eight" if abs(abs(row.waist_twist) - 180) < 1 else "disk"


def states(rows: tuple[Row, ...]) -> list[tuple[str, float, float]]:
    """Return the states in order, each with its first and last load."""
    runs = [(name, list(part)) for name, part in groupby(rows, key=state)]
    return [(name, part[0].kL3_alpha, part[-1].kL3_alpha) for name, part in runs]


@cache
def sweep(name: str) -> tuple[Row, ...]:
    with TemporaryDirectory() as folder:
        result = run_sweep(load_run(ROOT / "runs" / name, {}), Path(folder) / "run")
    assert result.failures == []
    assert all(row.n_unstable == 0 for row in result.rows)
    return result.rows


def test_elongated_film_goes_from_disk_to_saddle_eight_and_bent_lobes():
    rows = sweep("elongated.toml")
    disk, saddle, eight, bent = states(rows)
    assert [s[0] for s in (disk, saddle, eight, bent)] == [
        *("disk", "in space", "eight", "in space")
    ]
    for (before, after), paper, limit in (
        ((disk[2], saddle[1]), 643, 0.05),
        ((saddle[2], eight[1]), 740, 0.05),
        ((eight[2], bent[1]), 2000, 0.12),
    ):
        assert before > (1 - limit) * paper
        assert after < (1 + limit) * paper


def test_disk_becomes_an_ellipse_gradually():
    rows = [row for row in sweep("elongated.toml") if row.kL3_alpha <= 650]
    aspects = [row.aspect for row in rows]
    assert aspects[0] == pytest.approx(1.0, abs=0.01)
    assert all(a > b for a, b in pairwise(aspects))
    assert aspects[-1] < 0.5


def test_hexagon_becomes_a_saddle_with_two_equal_axes():
    """Enneper's saddle: in space, no twist of two lobes, aspect near 1 at first."""
    rows = sweep("hexagon.toml")
    disk, saddle = states(rows)[:2]
    assert (disk[0], saddle[0]) == ("disk", "in space")
    assert disk[2] > 855 * 0.985
    assert saddle[1] < 855 * 1.015
    near = next(row for row in rows if row.abs_kappa_n > 1)
    assert near.aspect == pytest.approx(1.0, abs=0.05)
    assert near.total_gauss_curvature < 0
