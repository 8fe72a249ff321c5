"""A soap film follows its loop, and is repaired where its triangles get thin on the way."""

from __future__ import annotations

from eulerplateau.arrays import FloatArray
from eulerplateau.film.harmonic import follow_loop
from eulerplateau.film.repair import mend_triangles
from eulerplateau.film.tiling import LIMITS, Tiling


def carry_along(
    tiling: Tiling, x: FloatArray, x_loop: FloatArray, halvings: int = 8
) -> tuple[Tiling, FloatArray]:
    """Return the film and its shape (n_v, 3) after its loop has moved to x_loop (n_b, 3).

    In steps short enough that no triangle folds over, with a repair where they get thin.
    """
    before, after = tiling.sides(x), follow_loop(tiling, x, x_loop)
    moved = tiling.sides(after)
    turned = (before.normals * moved.normals).sum(axis=1)
    sound = bool((moved.areas > 0).all() and (turned > LIMITS.carried).all())
    if not sound and halvings:
        middle = 0.5 * (x[tiling.loop] + x_loop)
        tiling, x = carry_along(tiling, x, middle, halvings - 1)
        return carry_along(tiling, x, x_loop, halvings - 1)
    return (
        mend_triangles(tiling, after)
        if moved.smallest_angle < LIMITS.thin
        else (tiling, after)
    )
