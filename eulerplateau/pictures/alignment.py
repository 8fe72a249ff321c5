"""The shapes of whole runs, turned to follow each other without a jump."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.mesh.drawing import settled
from eulerplateau.runs import Series


def settled_runs(
    runs: Sequence[tuple[Sequence[Series], FloatArray]], loop: IntArray
) -> list[FloatArray]:
    """Return the shapes of runs on one mesh, settled so that curves have no jump.

    A run is its curves and its shapes (n_rows, n_v, 3). A curve follows on from the row it
    branches off from, a run from the first run.
    """
    before: list[int | None] = []
    for curves, _ in runs:
        start = len(before)
        for curve in curves:
            origin = None if curve.start is None else start + curve.start
            first = origin if origin is not None or not before else 0
            before += [first, *range(start + curve.first, start + curve.last)]
    x = settled(np.concatenate([shapes for _, shapes in runs]), before, loop)
    return np.split(x, np.cumsum([len(shapes) for _, shapes in runs])[:-1])
