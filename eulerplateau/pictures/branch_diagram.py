"""The diagram of all branches, branches.png: what is stable, and where branches meet."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import chain, cycle
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from eulerplateau.branches import BIFURCATION, CONTACT, FOLD
from eulerplateau.errors import OutputError
from eulerplateau.pictures.figure import (
    BLACK,
    SMALL,
    drawn,
    enlarged,
    figure_of_panels,
    load_matplotlib,
    save,
)
from eulerplateau.pictures.looks import (
    COLOURS,
    CROSS,
    DASHES,
    MARKERS,
    Look,
    label_of,
    legend_above,
    legend_height,
    tagged,
)
from eulerplateau.pictures.of_run import pictures_of
from eulerplateau.pictures.panels import Curve, Panel, draw_panels
from eulerplateau.runs import (
    Branch,
    Run,
    read_run,
)

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Black is the first branch; the branches of one origin share a colour, the others take
# them in turn. Each branch has a marker of its own that no special point has.
_COLOURS = tuple(colour for colour in COLOURS if colour != BLACK)
_TAGS = tuple(marker for marker in MARKERS if marker not in "oDd")
_STABLE: dict[str, Any] = {"linestyle": "-", "linewidth": 1.6, "zorder": 3}
_UNSTABLE: dict[str, Any] = {"linestyle": DASHES, "linewidth": 0.9, "zorder": 2}
# Above all curves, and below the crosses of what did not converge.
_POINT: dict[str, Any] = {"linestyle": "none", "color": BLACK, "zorder": 3.5}
_MARKERS: dict[str, dict[str, Any]] = {
    BIFURCATION: {**_POINT, "marker": "o", "markersize": 4.5, "markerfacecolor": "white"},
    FOLD: {**_POINT, "marker": "D", "markersize": 4.0},
    CONTACT: {**_POINT, "marker": "^", "markersize": 4.5, "markerfacecolor": "0.7"},
}
_NOT_CONVERGED: dict[str, Any] = {**CROSS, "color": BLACK, "zorder": 4}
_LEADER: dict[str, Any] = {
    "arrowstyle": "-", "linewidth": 0.5, "relpos": (0.5, 0.0), "shrinkA": 0, "shrinkB": 0
}  # fmt: skip
# Special points closer than this part of the loads shown share a label, and labels are
# kept this part of them apart.
_TOGETHER, _APART = 5e-3, 0.05


def draw_branches(folder: Path) -> bool:
    """Draw branches.png of a folder; return whether it was drawn, and log why not."""
    path = folder / "branches.png"
    return drawn(str(path), lambda: plot_branches(read_run(folder), path))


def plot_branches(run: Run, path: Path) -> None:
    """Draw the branches of a run to the PNG file `path`.

    Raises OutputError if the file cannot be written, or a special point is not in
    special_points.csv.
    """
    save(branches_figure(run), path)


def branches_figure(run: Run) -> Figure:
    """Return the figure of the branches of a run; solid where stable, else dashed.

    Over the load, of films: the loop's total normal curvature, the order parameter of the
    paper, in which mirror images coincide; the twist of the film's normal across the waist,
    in which they do not. Of cells: perimeter, and the least curvature half-way along their
    sides. Of both the energy above that of the first branch, which tells the state of least
    energy. Markers tell folds from bifurcations, and lines at the top give their
    loads. A second column enlarges the first stable branch that runs from one special
    point to another, if it is short. Raises OutputError if a special point is not in
    special_points.csv.
    """
    load_matplotlib()
    kinds = _kinds(run)
    colours = _colours(run.branches)
    panels = pictures_of(run.kind).branches(run.branches)
    window = _window(run.branches)
    loads = _loads(run)
    handles = _handles(run.branches, colours, sorted({kinds[number] for number in loads}))
    figure = figure_of_panels(1 if window is None else 2, len(panels))
    width, height = figure.get_size_inches()
    figure.set_size_inches(width, height + legend_height(label_of(handles), width))
    curves = [_curve(branch, colours[branch.origin]) for branch in run.branches]
    axes = draw_panels(figure, panels, curves, run.load.label, window=window)
    for what, line in zip(panels, axes, strict=True):
        for ax in line:
            _mark(ax, what, run.branches, kinds)
            ax.ticklabel_format(useOffset=False)
    for column in axes.T:
        _name_loads(column, loads.values())
    figure.align_ylabels(axes[:, 0])
    legend_above(figure, handles)
    return figure


def _curve(branch: Branch, colour: str) -> Curve:
    looks = _tag(branch, colour)
    return branch, Look({**looks, **_STABLE}, {**looks, **_UNSTABLE}, _NOT_CONVERGED)


def _tag(branch: Branch, colour: str) -> dict[str, Any]:
    """Return colour and marker of a branch; the first has no marker."""
    if branch.origin is None:
        return {"color": colour}
    filled = "white" if branch.number % 2 else colour
    looks = tagged(branch.number, _TAGS)
    return {**looks, "color": colour, "markerfacecolor": filled}


def _loads(run: Run) -> dict[int, float]:
    """Return the loads of the special points by number."""
    rows = [row for branch in run.branches for row in branch.rows]
    return {row.special: row.load for row in rows if row.special is not None}


def _kinds(run: Run) -> dict[int, str]:
    """Return the kinds, FOLD, BIFURCATION or CONTACT, of the special points by number."""
    try:
        return {number: run.special[number]["kind"] for number in _loads(run)}
    except KeyError:
        path = run.folder / "special_points.csv"
        raise OutputError(path, "does not name the kinds of all special points") from None


def _mark(
    ax: Axes, what: Panel, branches: Sequence[Branch], kinds: Mapping[int, str]
) -> None:
    """Mark the special points on the curves of a panel."""
    for branch in branches:
        for values in what.curves(branch):
            for row, value in zip(branch.rows, values, strict=True):
                if row.special is not None:
                    ax.plot(row.load, value, **_MARKERS[kinds[row.special]])


def _colours(branches: Sequence[Branch]) -> dict[int | None, str]:
    """Return a colour for each origin: black for the first branch, the others in turn."""
    origins = dict.fromkeys(branch.origin for branch in branches)
    return dict(zip(origins, chain([BLACK], cycle(_COLOURS)), strict=False))


def _window(branches: Sequence[Branch]) -> tuple[float, float] | None:
    """Return the loads to enlarge, or None if no short branch asks for it."""
    loads = np.concatenate([branch.loads for branch in branches])
    for branch in branches:
        window = enlarged(branch.loads.min(), branch.loads.max(), loads)
        if branch.bridges and window is not None:
            return window
    return None


def _name_loads(column: Sequence[Axes], special: Iterable[float]) -> None:
    """Write the loads of special points above a column, with lines down to them."""
    low, high = column[0].get_xlim()
    groups: list[list[float]] = []
    for load in sorted(load for load in special if low <= load <= high):
        if groups and load - groups[-1][-1] < _TOGETHER * (high - low):
            groups[-1].append(load)
        else:
            groups.append([load])
    middles = [0.5 * (group[0] + group[-1]) for group in groups]
    for ax in column:
        for middle in middles:
            ax.axvline(middle, color="0.8", linewidth=0.6, zorder=0)
    places = _spread(middles, low, high)
    for group, middle, place in zip(groups, middles, places, strict=True):
        column[0].annotate(
            _name(group),
            xy=(middle, 1.0),
            xycoords=column[0].get_xaxis_transform(),
            xytext=(place, 1.06),
            textcoords=column[0].get_xaxis_transform(),
            rotation=90,
            ha="center",
            va="bottom",
            fontsize=SMALL,
            arrowprops=_LEADER,
        )


def _name(group: Sequence[float]) -> str:
    first, last = f"{group[0]:.6g}", f"{group[-1]:.6g}"
    span = first if first == last else f"{first}\u2013{last}"
    return span if len(group) == 1 else f"{span} ({len(group)})"


def _spread(middles: Sequence[float], low: float, high: float) -> list[float]:
    """Return places for labels near ascending `middles`, apart and inside the axis."""
    apart = _APART * (high - low)
    places: list[float] = []
    for middle in middles:
        places.append(max(middle, places[-1] + apart if places else low))
    limit = high
    for i in reversed(range(len(places))):
        places[i] = min(places[i], limit)
        limit = places[i] - apart
    return places


def _handles(
    branches: Sequence[Branch], colours: Mapping[int | None, str], kinds: Sequence[str]
) -> list[Artist | tuple[Artist, ...]]:
    """Return what explains styles and markers, and says which branch is which."""
    from matplotlib.lines import Line2D

    lines: list[Artist | tuple[Artist, ...]] = [
        Line2D([], [], color=BLACK, label="stable", **_STABLE)
    ]
    lines.append(Line2D([], [], color=BLACK, label="unstable", **_UNSTABLE))
    lines += [Line2D([], [], label=kind, **_MARKERS[kind]) for kind in kinds]
    if any(not row.converged for branch in branches for row in branch.rows):
        lines.append(Line2D([], [], label="not converged", **_NOT_CONVERGED))
    alike: dict[int | None, list[Branch]] = {}
    for branch in branches:
        alike.setdefault(branch.origin, []).append(branch)
    for origin, members in alike.items():
        numbers = ", ".join(str(branch.number) for branch in members)
        name = f"branch {numbers}" if len(members) == 1 else f"branches {numbers}"
        if origin is not None:
            name += f", from {members[0].rows[0].load:.6g}"
        looks = [{**_tag(branch, colours[origin]), **_STABLE} for branch in members]
        lines.append(tuple(Line2D([], [], label=name, **look) for look in looks))
    return lines
