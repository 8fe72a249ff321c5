"""The picture of a cell's phase diagram, phase-diagram.png."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from eulerplateau.pictures.figure import (
    BLACK,
    BLUE,
    ORANGE,
    VERMILION,
    drawn,
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
    "unlike sides": "unlike sides, or none:\nthe regular cell is unstable",
    "collapsed": "no smooth regular cell",
}
_LINES: dict[str, dict[str, Any]] = {
    "inflection": {
        "color": BLUE,
        "linestyle": (0, (5, 2)),
        "label": r"$\sigma_1^*$: sides straight in the middle",
    },
    "symmetry": {"color": ORANGE, "label": "symmetry is lost"},
    "fold": {"color": VERMILION, "label": "fold of the regular cell"},
}
_RESOLUTION = 400
# Half the side of a shape's box, as a part of the axes, and what a cell has room for in it.
_BOX, _ROOM = 0.085, 1.15


def draw_phase_diagram(diagram: PhaseDiagram) -> bool:
    """Draw phase-diagram.png into its folder; return whether it was drawn, log why not."""
    path = diagram.folder / PHASE_DIAGRAM
    return drawn(str(path), lambda: save(phase_figure(diagram), path))


def phase_figure(diagram: PhaseDiagram) -> Any:
    """Return the figure: regions, lines, special points, a shape in each region."""
    figure = new_figure(7.4, 6.0)
    ax = figure.subplots()
    _fill(ax, diagram)
    for name, line in diagram.lines.items():
        ax.plot(line.sigma_hat, line.ks_hat, linewidth=1.6, **_LINES[name])
    if diagram.sigma_p is not None:
        label = r"$\sigma_p$: stars from here on"
        ax.axvline(diagram.sigma_p, color="0.4", linestyle=":", linewidth=1.4, label=label)
    for sigma, ks in diagram.points.values():
        ax.plot(sigma, ks, "o", color=BLACK, markersize=5, markerfacecolor="white")
    ax.set(xscale="log", yscale="log", xlim=diagram.sigma_hat, ylim=diagram.ks_hat)
    ax.set_xlabel(r"$\hat\sigma=\sigma R_0^3/\alpha$")
    ax.set_ylabel(r"$\hat k_s=k_sR_0^3/\alpha$")
    ax.tick_params(direction="in", which="both", top=True, right=True)
    for region, cell in diagram.shapes.items():
        _draw_cell(ax, cell, region)
    figure.legend(loc="outside upper center", ncols=2, frameon=False, fontsize=9)
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


def _draw_cell(ax: Axes, cell: CellEquilibrium, region: str) -> None:
    """Draw a cell where it was solved for, with its adhesions and its region's name."""
    place = ax.transData.transform((cell.sigma_hat, cell.ks_hat))
    x, y = ax.transAxes.inverted().transform(place)
    x, y = np.clip([x, y], _BOX + 0.01, 1 - _BOX - 0.01)
    inset = ax.inset_axes((x - _BOX, y - _BOX, 2 * _BOX, 2 * _BOX))
    outline = np.vstack([cell.x, cell.x[:1]])
    inset.fill(*outline.T, color="white", alpha=0.8, linewidth=0)
    inset.plot(*outline.T, color=BLACK, linewidth=1.2)
    inset.plot(*cell.cell.sites.points.T, "o", color=VERMILION, markersize=2.5)
    for vertex, rest in zip(
        cell.x[cell.cell.vertices], cell.cell.sites.points, strict=True
    ):
        inset.plot(*np.stack([vertex, rest]).T, color=VERMILION, linewidth=0.8)
    inset.set(xlim=(-_ROOM, _ROOM), ylim=(-_ROOM, _ROOM), aspect="equal")
    inset.set_axis_off()
    note = "" if cell.converged else f"\n({cell.status.value})"
    # The narrow region lies below the last one: what is said of it stands below its shape.
    below = region == "unlike sides"
    spot = (0.5, -0.02 if below else 1.02)
    inset.text(
        *spot,
        f"{_NAMES[region]}{note}",
        fontsize=8,
        ha="center",
        va="top" if below else "bottom",
        transform=inset.transAxes,
    )
