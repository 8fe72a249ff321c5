"""Quantities over the load, of any number of runs, legs or branches, panel above panel.

Every diagram of a run is a list of panels and a list of curves handed to `draw_panels`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.pictures.coincidence import dash_once
from eulerplateau.pictures.figure import frame
from eulerplateau.pictures.looks import Look
from eulerplateau.runs import Quantity, Series, without_noise

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import FigureBase
    from matplotlib.lines import Line2D
    from numpy.typing import NDArray

Band = tuple[float, float]

# Part of a panel's whole range below which the solid curves' own is rounding.
_FLAT = 1e-3


@dataclass(frozen=True)
class Panel:
    """What is drawn over the load.

    Attributes
    ----------
    label : str, of the axis
    values : of a series of n rows the curves (n,), one, or one for each side of a film
    error : of a row, below which it is zero; a curve that is throughout is drawn so
    jump : float; a branch has a gap where its curve changes by more from point to point
    solid_only : bool, whether the range is that of the solid curves and the others may
        leave it
    logarithmic : bool, on both sides of zero if there are unstable shapes
    zero : bool, whether a line marks zero
    ticks, limits : of the axis; chosen from what is drawn if not given
    """

    label: str
    values: Callable[[Series], Sequence[FloatArray]]
    error: Callable[[Any], float] | None = None
    jump: float = np.inf
    solid_only: bool = False
    logarithmic: bool = False
    zero: bool = False
    ticks: Sequence[float] | None = None
    limits: Band | None = None

    def curves(self, series: Series) -> Sequence[FloatArray]:
        """Return the curves (n,) of a series as they are drawn, without noise."""
        values = self.values(series)
        if self.error is None:
            return values
        return [without_noise(series.rows, one, self.error) for one in values]


def panel(label: str, quantity: Quantity, **options: Any) -> Panel:
    """Return the panel of a quantity that a row has one value of."""
    return Panel(label, lambda series: [series.values(quantity)], **options)


Curve = tuple[Series, Look]


def draw_panels(
    figure: FigureBase,
    panels: Sequence[Panel],
    curves: Sequence[Curve],
    load_label: str,
    *,
    window: Band | None = None,
    bands: Sequence[Band] = (),
    band: str = "",
    margin: float = 0.08,
    one_height: bool = False,
) -> NDArray[Any]:
    """Draw the panels above each other; return their axes (n_panels, n_columns).

    Parameters
    ----------
    figure : to be filled
    panels, curves : what is drawn; every curve in every panel
    load_label : str, of the axis they share
    window : the loads that a second column enlarges
    bands, band : the loads that are shaded, and what that means
    margin : float, the room above and below the curves, as a part of their range
    one_height : bool, whether the second column keeps the ranges of the first
    """
    columns = 1 if window is None else 2
    shared: Any = {"sharex": "col", "sharey": "row" if one_height else False}
    axes: NDArray[Any] = figure.subplots(len(panels), columns, squeeze=False, **shared)
    for what, line in zip(panels, axes, strict=True):
        line[0].set_ylabel(what.label)
        for ax in line:
            _shade(ax, bands, band)
            if what.zero:
                ax.axhline(0, color="0.45", linewidth=0.8, zorder=1)
            _draw(ax, what, curves)
            frame(ax)
            ax.margins(y=margin)
            if what.logarithmic:
                _scale(ax, curves)
    for column in axes.T:
        column[-1].set_xlabel(load_label)
    if window is not None:
        axes[0, 1].set_xlim(*window)
    for what, line in zip(panels, axes, strict=True):
        fitted = line[:0] if one_height else line[1:]
        for ax in line if what.solid_only else fitted:
            _fit_height(ax, margin, what.solid_only)
        if what.ticks is not None:
            _hold(line[0], what.ticks, margin)
        if what.limits is not None:
            line[0].set_ylim(*what.limits)
    # An axis without numbers needs no room.
    for ax in axes[:-1].flat:
        ax.xaxis.set_in_layout(False)
    for ax in axes[:, 1:].flat if one_height else ():
        ax.yaxis.set_in_layout(False)
    for ax in axes.flat:
        dash_once(ax)
    return axes


def _hold(ax: Axes, ticks: Sequence[float], margin: float) -> None:
    """Put ticks where they are said to be, and leave room beyond them."""
    low, high = min(ticks), max(ticks)
    room = margin * (high - low)
    below, above = ax.get_ylim()
    ax.set_yticks(ticks)
    ax.set_ylim(min(below, low - room), max(above, high + room))


def _shade(ax: Axes, bands: Sequence[Band], meaning: str) -> None:
    for number, (low, high) in enumerate(bands):
        label = meaning if number == 0 else None
        ax.axvspan(low, high, color="0.9", linewidth=0, zorder=0, label=label)


def _draw(ax: Axes, what: Panel, curves: Sequence[Curve]) -> None:
    """Draw all curves, and then what did not converge of them."""
    named: set[str | None] = set()

    def new(label: str | None) -> str | None:
        known = label in named
        named.add(label)
        return None if known else label

    drawn = [(s, values, look) for s, look in curves for values in what.curves(s)]
    for series, values, look in drawn:
        for piece in series.pieces(values, what.jump):
            style = look.solid if piece.solid else look.dashed
            ax.plot(piece.loads, piece.values, **style, label=new(look.label))
    for series, values, look in drawn:
        bad = np.array([not row.converged for row in series.rows], dtype=bool)
        if bad.any():
            style = dict(look.bad)
            label = new(style.pop("label", None))
            ax.plot(series.loads[bad], values[bad], **style, label=label)


def _scale(ax: Axes, curves: Sequence[Curve]) -> None:
    """Make the scale logarithmic, on both sides of zero if there are unstable shapes."""
    if any(row.n_unstable for series, _ in curves for row in series.rows):
        ax.set_yscale("symlog", linthresh=1.0)
        ax.axhline(0, color="0.6", linewidth=0.6, zorder=0)
    else:
        ax.set_yscale("log")


def _fit_height(ax: Axes, margin: float, solid_only: bool) -> None:
    """Choose the range from all curves, or from the solid ones, at the loads shown.

    Solid ones that all lie at zero say nothing about a range.
    """
    solid = [line for line in ax.lines if line.get_linestyle() == "-"]
    shown, own = _heights(ax, ax.lines), _heights(ax, solid)
    if solid_only and len(own) and np.ptp(own) > _FLAT * np.ptp(shown):
        shown = own
    if len(shown) and (np.ptp(shown) > 0 or ax.get_yscale() == "linear"):
        room = margin * np.ptp(shown) or 1.0
        limits = np.array([shown.min() - room, shown.max() + room])
        ax.set_ylim(*ax.yaxis.get_transform().inverted().transform(limits))


def _heights(ax: Axes, lines: Sequence[Line2D]) -> FloatArray:
    """Return the finite values of lines at the loads shown, as far up as they appear."""
    low, high = ax.get_xlim()
    found = [np.empty(0)]
    for line in lines:
        x, y = np.asarray(line.get_data(), dtype=float)
        found.append(y[(low <= x) & (x <= high) & np.isfinite(y)])
    heights: FloatArray = ax.yaxis.get_transform().transform(np.concatenate(found))
    return heights
