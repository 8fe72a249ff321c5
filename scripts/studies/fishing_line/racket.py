"""Where the strands of a run touch that wind round each other between two heads."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.runs import read_run

# Places of contact that are farther from each other, in edges, are of two contacts; those
# of one that is no longer than this are what a mesh makes of a point.
_APART, _POINT = 2.5, 1.5
# An edge of the loop of runs/thick-line.toml.
_EDGE = 1 / 229


def racket_table(folder: Path) -> Iterator[list[str]]:
    """Yield a head, then by load the rows of falling load that touch at several places."""
    yield ["load", "energy", "force", "angle", "wound", "contacts"]
    run = read_run(folder)
    top = int(max(run.rows, key=lambda row: row.sigma_hat).step)
    for row in reversed(run.rows[top:]):
        if not row.contacts or row.contacts < 2:
            continue
        ends = _stretches(folder / "shapes" / f"shape_{row.step:04d}.vtp")
        yield [
            f"{row.sigma_hat:g}",
            f"{row.energy:.2f}",
            f"{row.contact_force:.0f}",
            f"{row.crossing_angle:.1f}",
            f"{ends[-1][1] - ends[0][0]:.3f}",
            ", ".join(_said(last - first) for first, last in ends),
        ]


def _stretches(path: Path) -> list[tuple[float, float]]:
    """Return where contacts begin and end, along the line that is nearest to them, in L."""
    import pyvista

    shape = pyvista.read(path)
    points = np.asarray(shape.field_data["contact_points"], dtype=np.float64)
    middles: FloatArray = 0.5 * (points[::2] + points[1::2])
    middles = middles - middles.mean(axis=0)
    along = np.sort(middles @ np.linalg.svd(middles)[2][0])
    cuts = [0, *np.flatnonzero(np.diff(along) > _APART * _EDGE) + 1, len(along)]
    return [(float(along[i]), float(along[j - 1])) for i, j in pairwise(cuts)]


def _said(length: float) -> str:
    return "point" if length < _POINT * _EDGE else f"line of {length:.3f}"
