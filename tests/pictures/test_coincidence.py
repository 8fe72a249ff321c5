"""Dashed curves that coincide look dashed: one of them has the dashes."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from eulerplateau.pictures.coincidence import dash_once
from eulerplateau.pictures.looks import DASHES

PLACES = np.linspace(0.5, 9.5, 181)


@pytest.fixture
def ax() -> Axes:
    axes = Figure().subplots()
    axes.set(xlim=(0, 10), ylim=(-1, 3))
    return axes


def drawn_at(ax: Axes, x: float, style: str = "--") -> list[float]:
    """The heights at which lines of a style are drawn over x."""
    found = []
    for line in ax.lines:
        if line.get_linestyle() == style:
            places, values = np.asarray(line.get_data(), dtype=float)
            order = np.argsort(places)
            found.append(float(np.interp(x, places[order], values[order])))
    return [value for value in found if np.isfinite(value)]


def test_curves_that_coincide_are_dashed_once_whichever_way_they_run(ax: Axes) -> None:
    ax.plot(np.linspace(0, 10, 41), np.zeros(41), linestyle=DASHES)
    ax.plot(np.linspace(9, 1, 23), np.full(23, 1e-4), linestyle=DASHES)
    ax.plot(np.linspace(1, 10, 37), np.zeros(37), linestyle=DASHES)
    dash_once(ax)
    assert [len(drawn_at(ax, x)) for x in PLACES] == [1] * len(PLACES)


def test_the_second_has_dashes_where_it_goes_its_own_way(ax: Axes) -> None:
    x = np.linspace(0, 10, 401)
    ax.plot(x, np.zeros(401), linestyle=DASHES)
    ax.plot(x, np.maximum(0.0, x - 5), linestyle=DASHES)
    dash_once(ax)
    assert [len(drawn_at(ax, x)) for x in (1.0, 4.0, 6.0, 7.5)] == [1, 1, 2, 2]


def test_a_curve_that_turns_hides_what_lies_on_either_part_of_it(ax: Axes) -> None:
    s = np.linspace(-2, 2, 401)
    ax.plot(s**2, 1 + 0.5 * s, linestyle=DASHES)
    for side in (-1, 1):
        x = np.linspace(0.5, 3.5, 57)
        ax.plot(x, 1 + side * 0.5 * np.sqrt(x), linestyle=DASHES)
    dash_once(ax)
    assert all(np.isnan(line.get_ydata()).all() for line in ax.lines[1:3])


def test_markers_still_tell_which_curves_are_there(ax: Axes) -> None:
    x = np.linspace(0, 10, 21)
    for marker in "os":
        ax.plot(x, np.zeros(21), linestyle=DASHES, marker=marker, markevery=3)
    dash_once(ax)
    marked = {
        line.get_marker(): line for line in ax.lines if np.isfinite(line.get_ydata()).all()
    }
    assert set(marked) == {"o", "s"}
    assert marked["s"].get_markevery() == 3


def test_solid_curves_keep_their_line(ax: Axes) -> None:
    for _ in range(2):
        ax.plot([0, 10], [1, 1])
    dash_once(ax)
    assert len(ax.lines) == 2
    assert all(len(drawn_at(ax, x, "-")) == 2 for x in PLACES)
