"""A figure of an outline, the film fitted to it, and how far its points lie from that."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from eulerplateau.exact import OutlineFit
from eulerplateau.pictures.figure import (
    BLACK,
    BLUE,
    COLUMN,
    SMALL,
    drawn,
    frame,
    new_figure,
    save,
)


def draw_outline_fit(
    points: Sequence[tuple[float, float]], fit: OutlineFit, unit: str, path: Path
) -> bool:
    """Draw the figure to a PNG, PDF or SVG file; return whether it was, and log why not.

    `unit` is that of the points, empty where it is not known.
    """
    return drawn(str(path), lambda: plot_outline_fit(points, fit, unit, path))


def plot_outline_fit(
    points: Sequence[tuple[float, float]], fit: OutlineFit, unit: str, path: Path
) -> None:
    """Draw points (n, 2) and curve to one scale, and the distances along the curve.

    Raises OutputError if `path` cannot be written.
    """
    within = f" ({unit})" if unit else " (as given)"
    figure = new_figure(COLUMN, 4.2)
    shape, errors = figure.subplots(2, 1, height_ratios=(2.2, 1.0))
    x, y = np.asarray(points).T
    shape.plot(x, y, "o", color=BLACK, markersize=2.5, label="outline")
    shape.plot(*fit.curve.T, color=BLUE, linewidth=1.2, label="fit")
    shape.set(aspect="equal", xlabel=f"x{within}", ylabel=f"y{within}")
    shape.legend(frameon=False, fontsize=SMALL)
    frame(shape)
    errors.axhline(0, color=BLUE, linewidth=1.2)
    errors.plot(fit.arc, fit.distances, "o", color=BLACK, markersize=2.5)
    errors.set(xlabel=f"along the curve{within}", ylabel=f"outwards of it{within}")
    frame(errors)
    save(figure, path)
