"""The picture of a cell's phase diagram, phase-diagram.png."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.pictures.figure import (
    BLACK,
    BLUE,
    ORANGE,
    PAGE,
    SMALL,
    TEXT,
    VERMILION,
    drawn,
    frame,
    new_figure,
    save,
)
from eulerplateau.runs import REGIONS, PhaseDiagram

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from eulerplateau.cells import CellEquilibrium

PHASE_DIAGRAM = "phase-diagram.png"

_COLOURS = ("#E8F1F8", "#C9DFEF", "#FBE7CF", "#F3CDB9")
_NAMES = {
    "convex": "convex",
    "inflected": "inflected",
    "unlike sides": "the regular cell is unstable",
    "collapsed": "no smooth regular cell",
}
_DASHDOT = (0, (6, 1.5, 1, 1.5))
_LINES: dict[str, dict[str, Any]] = {
    "inflection": {
        "color": BLUE,
        "linestyle": (0, (5, 2)),
        "label": r"$\sigma_1^*$: sides straight in the middle",
    },
    "symmetry lost": {"color": ORANGE, "linestyle": _DASHDOT, "label": "symmetry is lost"},
    "symmetry regained": {"color": ORANGE, "linestyle": _DASHDOT},
    "fold": {"color": VERMILION, "label": "fold of the regular cell"},
}
_RESOLUTION = 400
# Half the side of a shape's box, as a part of the axes, and what a cell has room for in it.
_BOX, _ROOM = 0.075, 1.15
# The shape of a thin region is drawn beside it, at the end of a line.
_MOVES = np.array([[0, 0], [-0.26, 0], [0, -0.26], [0.24, -0.2], [0, 0.24], [0.26, 0]])
_APART, _THICK = 0.14, 0.05
_LEADER: dict[str, Any] = {"color": BLACK, "linewidth": 0.7, "zorder": 3}


def draw_phase_diagram(diagram: PhaseDiagram) -> bool:
    """Draw phase-diagram.png into its folder; return whether it was drawn, log why not."""
    path = diagram.folder / PHASE_DIAGRAM
    return drawn(str(path), lambda: save(phase_figure(diagram), path))


def phase_figure(diagram: PhaseDiagram) -> Any:
    """Return the figure: regions, lines, special points, a shape in each region."""
    figure = new_figure(PAGE, 5.6)
    ax = figure.subplots()
    _fill(ax, diagram)
    for name, line in diagram.lines.items():
        ax.plot(line.sigma_hat, line.ks_hat, linewidth=1.6, **_LINES[name])
    if diagram.sigma_p is not None:
        label = r"$\sigma_p$: stars from here on"
        ax.axvline(diagram.sigma_p, color="0.4", linestyle=":", linewidth=1.4, label=label)
    open_one: dict[str, Any] = {"color": BLACK, "markersize": 5, "markerfacecolor": "white"}
    label = "softest substrate: inflected, folded"
    if diagram.points:
        ax.plot(*zip(*diagram.points.values(), strict=True), "o", **open_one, label=label)
    ax.set(xscale="log", yscale="log", xlim=diagram.sigma_hat, ylim=diagram.ks_hat)
    ax.set_xlabel(r"$\hat\sigma=\sigma R_0^3/\alpha$")
    ax.set_ylabel(r"$\hat k_s=k_sR_0^3/\alpha$")
    frame(ax)
    ax.set(xlim=diagram.sigma_hat, ylim=diagram.ks_hat)
    names: list[str] = []
    taken: list[FloatArray] = []
    for region in sorted(diagram.shapes, key=lambda region: -diagram.room[region]):
        number, cell = REGIONS.index(region) + 1, diagram.shapes[region]
        taken.append(_centre(diagram, cell, diagram.room[region], taken))
        _draw_cell(ax, cell, number, taken[-1])
        ending = "" if cell.converged else f"; the polygon ends {cell.status.value}"
        names.append(f"{number}  {_NAMES[region]}{ending}")
    listed = "\n".join([*sorted(names), "dots: adhesions at rest"])
    ax.text(0.98, 0.03, listed, transform=ax.transAxes, ha="right", fontsize=SMALL)
    figure.legend(loc="outside upper center", ncols=2, frameon=False, fontsize=SMALL)
    return figure


def _fill(ax: Axes, diagram: PhaseDiagram) -> None:
    from matplotlib.colors import ListedColormap

    sigma = np.geomspace(*diagram.sigma_hat, _RESOLUTION)
    ks = np.geomspace(*diagram.ks_hat, _RESOLUTION)
    region = diagram.regions(*np.meshgrid(sigma, ks))
    ax.pcolormesh(
        sigma,
        ks,
        region,
        cmap=ListedColormap(_COLOURS),
        vmin=-0.5,
        vmax=len(REGIONS) - 0.5,
        shading="nearest",
        rasterized=True,
    )


def _centre(
    diagram: PhaseDiagram,
    cell: CellEquilibrium,
    room: float,
    taken: Sequence[FloatArray],
) -> FloatArray:
    """Return where in the axes (2,) a cell is drawn: at its place, if there is room."""
    place = _in_axes(diagram, np.array([cell.sigma_hat, cell.ks_hat]))
    for move in _MOVES[0 if room > _THICK else 1 :]:
        centre: FloatArray = np.clip(place + move, _BOX + 0.02, 1 - _BOX - 0.05)
        if all(np.hypot(*(centre - other)) > _APART for other in taken):
            return centre
    return np.clip(place, _BOX + 0.02, 1 - _BOX - 0.05)


def _in_axes(diagram: PhaseDiagram, point: FloatArray) -> FloatArray:
    """Return where in the axes, from 0 to 1, a point (2,) of the plane is."""
    low, high = np.log(np.array([diagram.sigma_hat, diagram.ks_hat])).T
    place: FloatArray = (np.log(point) - low) / (high - low)
    return place


def _draw_cell(ax: Axes, cell: CellEquilibrium, number: int, centre: FloatArray) -> None:
    """Draw a cell with its adhesions and a number, and a line to where it belongs."""
    place = ax.transAxes.inverted().transform(
        ax.transData.transform((cell.sigma_hat, cell.ks_hat))
    )
    if np.hypot(*(place - centre)) > _BOX:
        ax.plot(*zip(place, centre, strict=True), transform=ax.transAxes, **_LEADER)
    inset = ax.inset_axes((*(centre - _BOX), 2 * _BOX, 2 * _BOX))
    outline = np.vstack([cell.x, cell.x[:1]])
    inset.fill(*outline.T, color="white", alpha=0.9, linewidth=0)
    inset.plot(*outline.T, color=BLACK, linewidth=1.2)
    rests = cell.cell.sites.points
    inset.plot(*rests.T, "o", color=VERMILION, markersize=2.5)
    for pair in zip(cell.x[cell.cell.vertices], rests, strict=True):
        inset.plot(*np.stack(pair).T, color=VERMILION, linewidth=0.8)
    inset.set(xlim=(-_ROOM, _ROOM), ylim=(-_ROOM, _ROOM), aspect="equal")
    inset.set_axis_off()
    inset.set_title(str(number), fontsize=TEXT, fontweight="bold", pad=0)
