"""Run folders with a pitchfork whose exponents are exactly 1/2 and 1, to be plotted."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh.disk import Disk
from eulerplateau.runs.folder import RunFolder
from eulerplateau.runs.rows import BranchRow, Row
from tests.helpers.shapes import eight
from tests.runs.test_output import ROW

ONSET = 670.0


def film(mesh: Disk, t: float) -> FloatArray:
    """The film of eq. eight with a loop of unit length."""
    x = eight(mesh.x[:, :2] / np.hypot(*mesh.x.T[:2]).max(), t)
    loop = x[mesh.loop]
    scaled: FloatArray = x / np.linalg.norm(np.roll(loop, -1, axis=0) - loop, axis=1).sum()
    return scaled


def row_at(step: int, load: float, onset: float = ONSET) -> Row:
    """A pitchfork at the onset: the square root and the line, to be fitted exactly."""
    distance = max(load / onset - 1, 0.0)
    return replace(
        ROW,
        step=step,
        kL3_alpha=load,
        sigma_hat=2 * math.sqrt(3) * load,
        energy=40.0 + 0.25 * load,
        abs_kappa_n=3.0 * distance**0.5 * (1 - 2.0 * distance),
        total_gauss_curvature=-11.0 * distance,
        lowest_eigenvalue=abs(onset - load),
        n_unstable=0,
    )


def loads(onset: float = ONSET) -> list[float]:
    """As runs/onset.toml has them, and a few farther off."""
    above = onset * (1 + np.geomspace(1e-4, 1e-2, 21))
    return [1.0, 300.0, 0.99 * onset, 0.999 * onset, *above, 1.2 * onset]


def swept(onset: float = ONSET) -> list[Row]:
    """The rows of a sweep over those loads."""
    return [row_at(step, load, onset) for step, load in enumerate(loads(onset))]


def record(
    path: Path,
    mesh: Disk,
    rows: Sequence[Row],
    *,
    vertices: int = 474,
    solver: str = "newton",
    model: str = "springs",
) -> Path:
    summary = {
        "mesh": {"vertices": vertices},
        "spec": {"film": {"model": model}, "solver": {"name": solver}},
    }
    is_branches = isinstance(rows[0], BranchRow) if rows else False
    name, kind = ("branches", BranchRow) if is_branches else ("sweep", Row)
    with RunFolder.create(path, summary, name, kind) as folder:
        for row in rows:
            folder.record(row, mesh, film(mesh, min(0.9, 0.3 * row.abs_kappa_n)))
    return path


def pitchfork() -> list[BranchRow]:
    """A planar branch that turns unstable at 500, and the stable one it gives."""

    def row(
        step: int, load: float, branch: int, unstable: int, special: int | None = None
    ) -> BranchRow:
        common = vars(row_at(step, load, 500.0 if branch else 1e9))
        columns = {**common, "lowest_eigenvalue": 1.0 - 2.0 * unstable}
        return BranchRow(
            **{**columns, "n_unstable": unstable},
            branch=branch,
            origin=0 if branch else None,
            special=special,
            arclength=1e-3 * (load - 500.0 if branch else load),
        )

    first = [(100.0, 0), (300.0, 0), (400.0, 0), (500.0, 0), (700.0, 1), (900.0, 1)]
    rows = [
        row(step, load, 0, unstable, 0 if load == 500.0 else None)
        for step, (load, unstable) in enumerate(first)
    ]
    bent = [row(6 + i, load, 1, 0) for i, load in enumerate((550.0, 600.0, 700.0, 900.0))]
    return rows + bent
