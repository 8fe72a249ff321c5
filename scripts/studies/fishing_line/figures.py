"""The diagram of docs/fishing-line.md."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from eulerplateau.exact.conformal import BUCKLING, lobes_twist, quick_opening_load
from eulerplateau.pictures.figure import BLACK, BLUE, GREEN, VERMILION, frame, save
from scripts.studies.fishing_line.cycle import Cycle
from scripts.studies.fishing_line.loads import flat_waist, free_waists

_LINES = ((0.05, VERMILION), (0.01, BLUE), (0.001, GREEN))
_LOADS = 400.0, 2700.0


def draw_loop(path: Path, cycles: Sequence[Cycle]) -> None:
    """Draw the waist over the load: the way up, the way down, and what runs found."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.2, 4.6), layout="constrained")
    ax = figure.subplots()
    jumps = lobes_twist()
    flat = np.linspace(BUCKLING, jumps, 120)
    waists = [flat_waist(load) for load in flat]
    ax.plot([_LOADS[0], BUCKLING, *flat[1:]], [1 / np.pi, 1 / np.pi, *waists[1:]], BLACK)
    loads, free = free_waists()
    ax.plot([jumps, *loads], [waists[-1], *free], "--", color=BLACK, lw=1)
    ax.text(1080, 0.017, "twisted, unstable", fontsize=9)
    ax.text(600, 0.35, "disk", fontsize=9)
    ax.text(1790, 0.17, "two lobes", fontsize=9)
    for diameter, colour in _LINES:
        opens = quick_opening_load(diameter)
        ax.plot([opens, _LOADS[1]], [diameter] * 2, color=colour)
        ax.text(1950, 1.1 * diameter, f"eight in contact, $d={diameter:g}$", fontsize=9)
        _arrow(ax, opens, diameter, 1 / np.pi, colour)
    _arrow(ax, jumps, waists[-1], _LINES[-1][0], BLACK)
    for cycle in cycles:
        _mark_rows(ax, cycle.up, cycle.diameter, "^", "rising")
        _mark_rows(ax, cycle.down, cycle.diameter, "v", "falling")
    if cycles:
        marks = dict(zip(*reversed(ax.get_legend_handles_labels()), strict=True))
        ax.legend(marks.values(), marks, loc="upper right", fontsize=9, frameon=False)
    ax.set(yscale="log", xlabel=r"$\hat\sigma=\sigma L^3/\alpha$")
    ax.set_ylabel("least distance of the strands, in $L$")
    frame(ax)
    ax.set_xlim(_LOADS)
    save(figure, path)


def _mark_rows(
    ax: Any, rows: Mapping[float, Any], diameter: float, marker: str, way: str
) -> None:
    """Mark a run's rows in contact."""
    eights = [load for load, row in rows.items() if row.contacts]
    label = f"on a mesh, load {way}"
    ax.plot(eights, [diameter] * len(eights), marker, color=BLACK, ms=3, lw=0, label=label)


def _arrow(ax: Any, load: float, start: float, end: float, colour: str) -> None:
    """Draw a jump."""
    style = {"arrowstyle": "->", "color": colour, "lw": 1, "ls": ":"}
    ax.annotate("", (load, end), (load, start), arrowprops=style)
