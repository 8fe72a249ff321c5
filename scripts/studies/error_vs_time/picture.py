"""Plot of errors against run time."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from eulerplateau.pictures.figure import (
    BLACK,
    BLUE,
    GREEN,
    ORANGE,
    PAGE,
    PURPLE,
    SKY,
    SMALL,
    TEXT,
    VERMILION,
    frame,
    new_figure,
    save,
)
from eulerplateau.pictures.looks import legend_above
from scripts.studies.common import shrink
from scripts.studies.error_vs_time.records import HARMONICS, Measurement, Point, points
from scripts.studies.error_vs_time.report import by_scene, error_of, on_front

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

_BROWN = "#7A4A1E"
# Marker and colour by solver; told apart in grey by the marker.
MARKERS = {
    "newton": ("o", BLACK),
    "newton, coarse to fine": ("D", GREEN),
    "newton, corrected": ("h", VERMILION),
    "cg": ("s", BLUE),
    "conformal": ("*", PURPLE),
    "tangent angle": ("P", _BROWN),
    "evolver": ("^", ORANGE),
    "evolver, coarse to fine": ("v", VERMILION),
    "evolver, gradients": ("X", SKY),
}
# Meshes that know of the film's shape are filled and solid, the others open and dashed.
_KNOWING = {"graded", "fan"}
_MEANINGS = {
    True: "mesh graded, or a fan of triangles",
    False: "mesh uniform, a lattice, or none",
}
_FRONT: dict[str, Any] = {"color": "0.85", "linewidth": 5, "zorder": 0}
# The range of errors goes this far below the smallest one on a mesh.
_BELOW = 20.0


def draw(path: Path, found: list[Measurement]) -> None:
    """Draw error against CPU seconds, a panel for each scene, its Pareto front in grey."""
    scenes = by_scene(points(found))
    rows = math.ceil(len(scenes) / 3)
    figure = new_figure(PAGE, 1.95 * rows + 0.9)
    axes = figure.subplots(rows, 3, squeeze=False)
    for ax, (name, group) in zip(axes.flat, scenes.items(), strict=False):
        _draw_scene(ax, group)
        ax.set_title(_title(name), fontsize=SMALL)
    for ax in axes.flat[len(scenes) :]:
        ax.remove()
    figure.supxlabel("CPU seconds", fontsize=TEXT)
    figure.supylabel("relative error of the energy, or of the threshold", fontsize=TEXT)
    solvers = {p.first.solver for group in scenes.values() for p in group}
    legend_above(figure, _handles([name for name in MARKERS if name in solvers]))
    save(figure, path)
    shrink(path)


def _draw_scene(ax: Axes, group: list[Point]) -> None:
    best = sorted(
        (p.cpu, error_of(p))
        for p, front in zip(group, on_front(group), strict=True)
        if front
    )
    ax.loglog(*zip(*best, strict=True), **_FRONT)
    ladders: dict[tuple[str, str], list[Point]] = {}
    for p in group:
        ladders.setdefault((p.first.solver, p.first.mesh), []).append(p)
    for (solver, mesh), line in ladders.items():
        seconds, errors = [p.cpu for p in line], [error_of(p) for p in line]
        ax.loglog(seconds, errors, **_look(solver, mesh in _KNOWING))
    frame(ax)
    on_meshes = [error_of(p) for p in group if p.first.mesh != HARMONICS]
    others = [p for p in group if p.first.mesh == HARMONICS]
    if others and on_meshes:
        _cut(ax, min(on_meshes) / _BELOW, others)


def _title(scene: str) -> str:
    """Return the name of a scene, a load at its end called one."""
    what, _, load = scene.rpartition(", ")
    return rf"{what}, $\hat\sigma={load}$" if load.isdecimal() else scene


def _cut(ax: Axes, low: float, others: list[Point]) -> None:
    """Leave out the errors below `low`, and say how far down they go."""
    ax.set_ylim(bottom=low)
    least = min(error_of(p) for p in others)
    first = min(p.cpu for p in others if error_of(p) == least)
    ax.text(
        0.97,
        0.04,
        f"{others[0].first.solver}:\nto {least:.0e} in {first:.1g} s",
        ha="right",
        transform=ax.transAxes,
        fontsize=SMALL,
    )


def _look(solver: str, knowing: bool) -> dict[str, Any]:
    marker, colour = MARKERS[solver]
    return {
        "marker": marker,
        "color": colour,
        "markerfacecolor": colour if knowing else "white",
        "linestyle": "-" if knowing else "--",
        "linewidth": 0.9,
        "markersize": 3.6,
        "markeredgewidth": 0.8,
    }


def _handles(solvers: list[str]) -> list[Artist]:
    from matplotlib.lines import Line2D

    handles: list[Artist] = [
        Line2D([], [], **{**_look(name, True), "linestyle": "none"}, label=name)
        for name in solvers
    ]
    for knowing, meaning in _MEANINGS.items():
        look = {**_look("newton", knowing), "color": "0.3"}
        handles.append(Line2D([], [], **look, label=meaning))
    handles.append(Line2D([], [], **_FRONT, label="what nothing beats (Pareto)"))
    return handles
