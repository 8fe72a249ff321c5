"""Where a film leaves its plane: the scaling laws of its curvatures, fitted and drawn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.branches import PowerLaw, fit_power
from eulerplateau.errors import OutputError
from eulerplateau.pictures.figure import (
    ABS_KAPPA_N,
    MINUS_K,
    PAGE,
    SMALL,
    frame,
    load_matplotlib,
    new_figure,
)
from eulerplateau.pictures.looks import legend_above, style
from eulerplateau.runs import Quantity, Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Integral of |kappa_n| ds up to which a film is planar: so close to its onset it bends less
# than the films of a diagram, whose planar states are told apart more coarsely.
_PLANAR = 1e-3
# The law holds near the onset: rows this much above the last planar one are fitted.
_NEAR = 0.02
# Planar rows are shown over this part of the range above the onset.
_BELOW = 0.4
# An error below this is written with an exponent.
_TINY = 1e-6
_PANELS: tuple[tuple[str, Quantity], ...] = (
    (ABS_KAPPA_N, lambda row: row.abs_kappa_n),
    (MINUS_K, lambda row: -row.total_gauss_curvature),
)


@dataclass(frozen=True)
class Onset:
    """Ascending loads and values (n,) of a quantity above an onset, and their law."""

    loads: FloatArray
    values: FloatArray
    law: PowerLaw

    @property
    def distance(self) -> FloatArray:
        """The relative distance (n,) from the fitted onset."""
        return self.loads / self.law.onset - 1


def fit_onset(run: Run) -> tuple[Onset, Onset]:
    """Return the integral of |kappa_n| ds and minus that of K dA at a run's first onset.

    The rows fitted follow the last planar one of the first leg (or branch), up to 2 % above
    its load. Raises OutputError if there are too few of them for the fit.
    """
    rows = sorted(run.first_leg, key=lambda row: row.load)
    bent = next((i for i, row in enumerate(rows) if row.abs_kappa_n > _PLANAR), len(rows))
    near = rows[bent - 1].load * (1 + _NEAR) if bent else 0.0
    chosen = [row for row in rows[bent:] if row.load <= near]
    loads = np.array([row.load for row in chosen])
    found = []
    for _, quantity in _PANELS:
        values = np.array([quantity(row) for row in chosen], dtype=float)
        try:
            found.append(Onset(loads, values, fit_power(loads, values)))
        except ValueError as error:
            problem = f"{len(chosen)} rows within 2 % above an onset: {error}"
            raise OutputError(run.folder, problem) from None
    return found[0], found[1]


def onset_figure(runs: Sequence[Run]) -> Figure:
    """Return the figure: each quantity over the load's distance, linear and log-log."""
    fits = [fit_onset(run) for run in runs]
    load_matplotlib()
    from matplotlib.lines import Line2D

    figure = new_figure(PAGE, 5.6 + 0.2 * len(runs))
    axes = figure.subplots(2, 2)
    for (label, quantity), column, onsets in zip(
        _PANELS, axes.T, zip(*fits, strict=True), strict=True
    ):
        for number, (run, onset) in enumerate(zip(runs, onsets, strict=True)):
            _draw_linear(column[0], run, quantity, onset, number)
            _draw_logarithmic(column[1], onset, number)
        for ax in column:
            ax.set_ylabel(label)
            frame(ax)
        column[0].set_xlabel(r"$\varepsilon$ (%)")
        column[1].set_xlabel(r"$\varepsilon=\,$load$\,/\,$onset$\,-\,1$")
        column[1].legend(loc="upper left", frameon=False, fontsize=SMALL)
    # In the colour of the only run; of several each has its own.
    colour = style(0)["color"] if len(runs) == 1 else "0.3"
    law = Line2D([], [], color=colour, linewidth=0.9, label="fitted law")
    legend_above(figure, [*axes[0, 0].get_legend_handles_labels()[0], law])
    return figure


def _draw_linear(ax: Axes, run: Run, quantity: Quantity, onset: Onset, number: int) -> None:
    law = onset.law
    distance = onset.distance
    rows = [(row.load / law.onset - 1, quantity(row)) for row in run.first_leg]
    planar = [pair for pair in rows if -_BELOW * distance[-1] < pair[0] < 0]
    points = np.array([*planar, *zip(distance, onset.values, strict=True)], dtype=float)
    place = _measured(law.onset, law.onset_error)
    name = run.load.tex
    label = rf"{run.label}, fitted onset: ${name}=${place}"
    looks = style(number)
    ax.plot(100 * points[:, 0], points[:, 1], **looks, linestyle="none", label=label)
    fine = np.linspace(0, distance[-1], 200)
    ax.plot(100 * fine, _value(law, fine), color=looks["color"], linewidth=0.9)


def _draw_logarithmic(ax: Axes, onset: Onset, number: int) -> None:
    law = onset.law
    distance = onset.distance
    looks = style(number)
    exponent = _measured(law.exponent, law.exponent_error)
    ax.plot(distance, onset.values, **looks, linestyle="none", label=f"exponent {exponent}")
    fine = np.geomspace(distance[0], distance[-1], 200)
    ax.plot(fine, _value(law, fine), color=looks["color"], linewidth=0.9)
    ax.set(xscale="log", yscale="log")


def _value(law: PowerLaw, distance: FloatArray) -> FloatArray:
    value: FloatArray = (
        law.amplitude * distance**law.exponent * (1 + law.correction * distance)
    )
    return value


def _measured(value: float, error: float) -> str:
    """Return the value and its error, both to the error's second digit."""
    if error < _TINY or not np.isfinite(error):
        return f"{value:.6f} ± {error:.1e}"
    digits = max(0, 1 - int(np.floor(np.log10(error))))
    return f"{value:.{digits}f} ± {error:.{digits}f}"
