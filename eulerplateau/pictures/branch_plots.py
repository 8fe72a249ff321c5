"""The diagram of all branches; `python -m eulerplateau.branch_plots DIR` draws it."""

from __future__ import annotations

import csv
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, cycle, groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.branches import BIFURCATION, FOLD
from eulerplateau.errors import OutputError
from eulerplateau.pictures.child import draw_in_child
from eulerplateau.pictures.figure import (
    ABS_KAPPA_N,
    BLACK,
    BLUE,
    GREEN,
    ORANGE,
    PURPLE,
    SKY,
    VERMILION,
    enlarged,
    frame,
    new_figure,
    save,
)
from eulerplateau.runs import (
    Branch,
    BranchRow,
    energy_above,
    read_branches,
    read_table,
    signed_twists,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

_SECONDS = 120.0
# After black for the first branch, in turn; one colour for the branches of one origin.
_COLOURS = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY)
_STABLE: dict[str, Any] = {"linestyle": "-", "linewidth": 1.6, "zorder": 3}
_UNSTABLE: dict[str, Any] = {"linestyle": (0, (4, 2)), "linewidth": 0.9, "zorder": 2}
_POINT: dict[str, Any] = {"linestyle": "none", "color": BLACK, "zorder": 4}
_MARKERS: dict[str, dict[str, Any]] = {
    BIFURCATION: {**_POINT, "marker": "o", "markersize": 4.5, "markerfacecolor": "white"},
    FOLD: {**_POINT, "marker": "D", "markersize": 4.0},
}
_NOT_CONVERGED: dict[str, Any] = {**_POINT, "marker": "x", "markersize": 5.0}
_LEADER: dict[str, Any] = {
    "arrowstyle": "-", "linewidth": 0.5, "relpos": (0.5, 0.0), "shrinkA": 0, "shrinkB": 0
}  # fmt: skip
# Special points closer than this part of the loads shown share a label, and labels are
# kept this part of them apart.
_TOGETHER, _APART = 5e-3, 0.05
# Part of a panel's whole range below which the stable branches' own is rounding.
_FLAT = 1e-3
# A planar film's twist jumps by half turns where its rim passes through itself.
_JUMP = 90.0


@dataclass(frozen=True)
class _Panel:
    """What is drawn over the load: one curve for each side of a branch.

    A panel that is not `whole` shows the range of what is stable; the rest may leave it.
    Where a curve changes by more than `jump` from one point to the next it has a gap.
    """

    label: str
    curves: Callable[[Branch], list[FloatArray]]
    whole: bool = False
    jump: float = np.inf


def draw_branches(folder: Path) -> bool:
    """Draw branches.png of a folder in a child process; return whether it was drawn."""
    return draw_in_child(
        "eulerplateau.pictures.branch_plots", str(folder), timeout=_SECONDS
    )


def plot_branches(rows: Sequence[BranchRow], kinds: Mapping[int, str], path: Path) -> None:
    """Draw the branches of `rows` to the PNG file `path`; solid where stable, else dashed.

    Over the load: the loop's total normal curvature, the order parameter of the paper, in
    which mirror images coincide; the twist of the film's normal across the waist, in which
    they do not; and the energy above that of the first branch, which tells the state of
    least energy. `kinds` maps the numbers of special points to FOLD or BIFURCATION; lines
    at the top give their loads. A second column enlarges the first stable branch that runs
    from one special point to another, if it is short. Raises OutputError if the file
    cannot be written.
    """
    branches = read_branches(rows)
    window = _window(branches)
    panels = _panels(branches)
    columns = 1 if window is None else 2
    figure = new_figure(columns)
    axes = figure.subplots(len(panels), columns, sharex="col", squeeze=False)
    for panel, line in zip(panels, axes, strict=True):
        line[0].set_ylabel(panel.label)
        for ax in line:
            _draw(ax, panel, branches, kinds)
    for column, loads in zip(axes.T, (None, window), strict=False):
        column[-1].set_xlabel(rows[0].load_name.label)
        if loads is not None:
            column[0].set_xlim(*loads)
        for panel, ax in zip(panels, column, strict=True):
            _fit(ax, panel.whole)
        _name_loads(column, rows)
    figure.align_ylabels()
    _legend(figure, branches, sorted({kinds[number] for number in _loads(rows)}))
    save(figure, path)


def _panels(branches: Sequence[Branch]) -> tuple[_Panel, ...]:
    excess = energy_above(branches[0])
    return (
        _Panel(ABS_KAPPA_N, lambda branch: [branch.abs_kappa_n], whole=True),
        _Panel("waist twist (deg)", signed_twists, jump=_JUMP),
        _Panel(r"$(E-E_0)\,L/\alpha$", lambda branch: [excess(branch)]),
    )


def _loads(rows: Iterable[BranchRow]) -> dict[int, float]:
    """Return the loads of the special points by number."""
    return {row.special: row.load for row in rows if row.special is not None}


def _draw(
    ax: Axes, panel: _Panel, branches: Sequence[Branch], kinds: Mapping[int, str]
) -> None:
    colours = _colours(branches)
    for branch in branches:
        for curve in panel.curves(branch):
            gaps = ~(np.abs(np.diff(curve)) <= panel.jump)
            for part, style in _stretches(branch, gaps):
                ax.plot(
                    branch.smooth(branch.loads, part),
                    branch.smooth(curve, part),
                    color=colours[branch.origin],
                    **style,
                )
            for row, value in zip(branch.rows, curve, strict=True):
                if row.special is not None:
                    ax.plot(row.load, value, **_MARKERS[kinds[row.special]])
            bad = np.array([not row.converged for row in branch.rows])
            if bad.any():
                ax.plot(branch.loads[bad], curve[bad], **_NOT_CONVERGED)
    frame(ax)
    ax.ticklabel_format(useOffset=False)


def _colours(branches: Sequence[Branch]) -> dict[int | None, str]:
    """Return a colour for each origin: black for the first branch, the others in turn."""
    origins = dict.fromkeys(branch.origin for branch in branches)
    return dict(zip(origins, chain([BLACK], cycle(_COLOURS)), strict=False))


def _stretches(
    branch: Branch, gaps: NDArray[np.bool_]
) -> Iterator[tuple[slice, dict[str, Any]]]:
    """Yield the stretches of like stability between gaps, and how they are drawn."""
    kinds = enumerate(zip(branch.stable, gaps, strict=True))
    for (stable, gap), alike in groupby(kinds, key=lambda numbered: numbered[1]):
        places = [place for place, _ in alike]
        if not gap:
            yield slice(places[0], places[-1] + 2), _STABLE if stable else _UNSTABLE


def _window(branches: Sequence[Branch]) -> tuple[float, float] | None:
    """Return the loads to enlarge, or None if no short branch asks for it."""
    loads = np.concatenate([branch.loads for branch in branches])
    for branch in branches:
        window = enlarged(branch.loads.min(), branch.loads.max(), loads)
        if branch.bridges and window is not None:
            return window
    return None


def _fit(ax: Axes, whole: bool) -> None:
    """Choose the range from all curves, or from the solid ones, at the loads shown.

    Solid ones that all lie at zero say nothing about a range.
    """
    low, high = ax.get_xlim()
    solid = [line for line in ax.lines if line.get_linestyle() == _STABLE["linestyle"]]

    def values(lines: Iterable[Any]) -> NDArray[np.float64]:
        found = [np.empty(0)]
        for line in lines:
            x, y = np.asarray(line.get_data())
            found.append(y[(low <= x) & (x <= high) & np.isfinite(y)])
        return np.concatenate(found)

    shown, stable = values(ax.lines), values(solid)
    if not whole and len(stable) and np.ptp(stable) > _FLAT * np.ptp(shown):
        shown = stable
    if len(shown):
        margin = 0.08 * np.ptp(shown) or 1.0
        ax.set_ylim(shown.min() - margin, shown.max() + margin)


def _name_loads(column: Sequence[Axes], rows: Sequence[BranchRow]) -> None:
    """Write the loads of the special points above a column, with lines down to them."""
    low, high = column[0].get_xlim()
    groups: list[list[float]] = []
    for load in sorted(load for load in _loads(rows).values() if low <= load <= high):
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
            fontsize=7,
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


def _legend(figure: Figure, branches: Sequence[Branch], kinds: Sequence[str]) -> None:
    """Explain styles and markers, and say which branch is which colour."""
    from matplotlib.lines import Line2D

    lines = [Line2D([], [], color=BLACK, label="stable", **_STABLE)]
    lines.append(Line2D([], [], color=BLACK, label="unstable", **_UNSTABLE))
    lines += [Line2D([], [], label=kind, **_MARKERS[kind]) for kind in kinds]
    if any(not row.converged for branch in branches for row in branch.rows):
        lines.append(Line2D([], [], label="not converged", **_NOT_CONVERGED))
    colours = _colours(branches)
    alike: dict[int | None, list[Branch]] = {}
    for branch in branches:
        alike.setdefault(branch.origin, []).append(branch)
    for origin, members in alike.items():
        numbers = ", ".join(str(branch.number) for branch in members)
        name = f"branch {numbers}" if len(members) == 1 else f"branches {numbers}"
        if origin is not None:
            name += f", from {members[0].rows[0].load:.6g}"
        lines.append(Line2D([], [], color=colours[origin], linewidth=1.6, label=name))
    wide = 3 if len(figure.axes) > 3 else 2
    figure.legend(
        handles=lines, loc="outside upper center", ncols=wide, frameon=False, fontsize=8
    )


def _read_kinds(path: Path) -> dict[int, str]:
    """Return the kinds of the special points in special_points.csv by number."""
    try:
        with path.open(newline="") as file:
            return {int(line["number"]): line["kind"] for line in csv.DictReader(file)}
    except OSError as error:
        raise OutputError(path, f"cannot be read: {error.strerror}") from None


if __name__ == "__main__":
    _folder = Path(sys.argv[1])
    plot_branches(
        [row for row in read_table(_folder) if isinstance(row, BranchRow)],
        _read_kinds(_folder / "special_points.csv"),
        _folder / "branches.png",
    )
