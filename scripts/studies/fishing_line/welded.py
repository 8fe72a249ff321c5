"""Runs of a line whose ends are welded: their states on the way up and down."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from scipy.optimize import brentq

from eulerplateau.exact.conformal import BUCKLING
from eulerplateau.runs import read_run
from scripts.studies.welded_loop.answers import disk_link

# <|kappa_n|> below which a film is flat.
_FLAT = 1e-4


def welded_table(folders: Sequence[Path]) -> Iterator[list[str]]:
    """Yield a head, then for each run its loads: states up and down, then that of down."""
    yield ["C/B", "Lk", "load", "up", "down", "energy", "force", "angle", "writhe"]
    for folder in folders:
        run = read_run(folder)
        loop = run.about["spec"]["loop"]
        top = max(run.rows, key=lambda row: row.sigma_hat).step
        down = {row.sigma_hat: row for row in run.rows if row.step >= top}
        for row in (row for row in run.rows[: top + 1] if row.sigma_hat in down):
            last = down[row.sigma_hat]
            yield [
                f"{loop['twist_ratio']:.3f}",
                f"{loop['link']:g}",
                f"{row.sigma_hat:g}",
                _state(row),
                _state(last),
                f"{last.energy:.3f}",
                f"{last.contact_force:.2f}" if last.contacts else "",
                f"{last.crossing_angle:.2f}" if last.contacts else "",
                f"{round(last.writhe, 4) + 0.0:.4f}",
            ]


def disk_yields(ratio: float, link: float) -> float:
    """Return the load at which the flat disk of a line of C/B and Lk gives way."""
    return float(brentq(lambda load: disk_link(load, ratio) - link, 1.0, BUCKLING))


def _state(row: Any) -> str:
    """Return in words what a row's film is."""
    if not row.converged:
        return str(row.status.value)
    if row.abs_kappa_n < _FLAT:
        shape = "disk" if row.sigma_hat < BUCKLING else "two lobes"
        return f"{shape}, touching" if row.contacts else shape
    return "in contact" if row.contacts else "twisted"
