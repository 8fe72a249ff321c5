"""A figure of cell areas over the substrate's stiffness, with the curve fitted to them."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from pathlib import Path

import numpy as np

from eulerplateau.exact.cell import AreaFit
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

_STIFFNESS = r"substrate stiffness $k_s$ (as given)"
_AREA = r"projected area $\pi R^2$ (as given)"
# The curve goes on beyond the data, by this factor.
_BEYOND = 2.0


def draw_area_fit(
    stiffness: Sequence[float],
    area: Sequence[float],
    error: Sequence[float] | None,
    fit: AreaFit,
    path: Path,
) -> bool:
    """Draw the figure to a PNG, PDF or SVG file; return whether it was, and log why not."""
    return drawn(str(path), lambda: plot_area_fit(stiffness, area, error, fit, path))


def plot_area_fit(
    stiffness: Sequence[float],
    area: Sequence[float],
    error: Sequence[float] | None,
    fit: AreaFit,
    path: Path,
) -> None:
    """Draw areas (n,) and their errors over stiffnesses (n,), and what was fitted to them.

    Where no errors are given the bars are the estimated noise. The band is the curve's, at
    the level of the fit's intervals. Raises OutputError if `path` cannot be written.
    """
    measured = np.asarray(area)
    bars = None if error is None else np.asarray(error)
    if fit.noise is not None:
        bars = fit.noise * (measured if fit.relative else np.ones_like(measured))
    k = np.geomspace(min(stiffness) / _BEYOND, max(stiffness) * _BEYOND, 300)
    curve, standard_error = fit.areas(k)
    half = fit.quantile() * standard_error

    figure = new_figure(COLUMN, 2.7)
    ax = figure.subplots()
    band = f"{100 * fit.level:g} % band"
    low = np.maximum(curve - half, 0.0)
    ax.fill_between(k, low, curve + half, color=BLUE, alpha=0.2, lw=0, label=band)
    ax.plot(k, curve, color=BLUE, label="fit")
    ax.errorbar(
        stiffness, area, bars, fmt="o", color=BLACK, markersize=4, capsize=2, label="data"
    )
    values = (*measured, *curve)
    lowest, highest = min(values), max(values)
    margin = 0.35 * (highest - lowest)
    for radius, name in ((fit.xi, r"$\pi\xi^2$"), (fit.rest_radius.value, r"$\pi R_0^2$")):
        level = pi * radius**2
        if lowest - margin < level < highest + margin:
            ax.axhline(level, color="0.5", lw=0.8, ls=(0, (4, 3)), zorder=0)
            ax.annotate(
                name,
                (1, level),
                xycoords=("axes fraction", "data"),
                xytext=(4, 0),
                textcoords="offset points",
                va="center",
                fontsize=SMALL,
                color="0.3",
            )
    ax.set(xscale="log", xlim=(k[0], k[-1]), xlabel=_STIFFNESS, ylabel=_AREA)
    frame(ax)
    ax.set_xlim(k[0], k[-1])
    ax.legend(frameon=False, fontsize=SMALL)
    save(figure, path)
