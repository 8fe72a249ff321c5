"""What a referee sees: nothing but the numbers, each curve named, readable at its size."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from shutil import copytree
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.text import Text

from eulerplateau.branches.special import BIFURCATION
from eulerplateau.mesh.disk import Disk
from eulerplateau.pictures.branch_diagram import branches_figure
from eulerplateau.pictures.comparison import runs_figure
from eulerplateau.pictures.figure import PAGE
from eulerplateau.pictures.looks import style
from eulerplateau.pictures.portraits import at_most
from eulerplateau.pictures.sweep_diagram import diagram_figure
from eulerplateau.runs.noise import bend_error
from eulerplateau.runs.record import Run, read_runs
from tests.helpers.marks import quick_with
from tests.helpers.plotted_runs import record, row_at, swept
from tests.helpers.shapes import disk_points, mesh_of
from tests.pictures.test_branch_diagram import KINDS, diagram, point

# Points; journals ask for no less.
LEAST = 6.0
# A page of a journal is this high (inches).
PAGE_HEIGHT = 24.7 / 2.54


@pytest.fixture(scope="module")
def mesh() -> Disk:
    return mesh_of(*disk_points(5))


@pytest.fixture(scope="module")
def sweep(tmp_path_factory: pytest.TempPathFactory, mesh: Disk) -> Path:
    return record(tmp_path_factory.mktemp("runs") / "sweep", mesh, swept())


@pytest.fixture(scope="module")
def many(mesh: Disk, tmp_path_factory: pytest.TempPathFactory) -> list[Run]:
    """Twenty runs of a few loads."""
    folder = tmp_path_factory.mktemp("many")
    rows = [row_at(step, load) for step, load in enumerate((1.0, 300.0, 690.0, 720.0))]
    sweep = record(folder / "first", mesh, rows)
    return read_runs([Path(copytree(sweep, folder / f"seed={n}")) for n in range(20)])


def branched(count: int) -> Run:
    """A planar branch with so many bifurcations, and two branches from each."""
    at = np.linspace(100.0, 900.0, count)
    rows = [point(0, 1.0, 0)]
    rows += [point(0, load, n + 1, special=n) for n, load in enumerate(at)]
    rows.append(point(0, 1000.0, count))
    for branch in range(1, 2 * count + 1):
        origin = (branch - 1) // 2
        start, sign = at[origin], (-1) ** branch
        rows += [
            point(branch, start + 40 * s**2, 0, origin=origin, arclength=s,
                  abs_kappa_n=s * (1 + origin), waist_twist=90.0 * sign * s)
            for s in (0.3, 0.6, 1.0)
        ]  # fmt: skip
    special = {n: {"kind": BIFURCATION} for n in range(count)}
    rows = [replace(row, step=step) for step, row in enumerate(rows)]
    return Run(Path("run"), tuple(rows), explored=True, special=special)


def branches(run: Run) -> Figure:
    special = {number: {"kind": kind} for number, kind in KINDS.items()}
    rows = tuple(diagram())
    return branches_figure(replace(run, rows=rows, explored=True, special=special))


SMALL_FIGURES: dict[str, Callable[[Run], Figure]] = {
    "diagram": diagram_figure,
    "plot": lambda run: runs_figure([run], "diagram"),
    "energy": lambda run: runs_figure([run], "energy"),
    "onset": lambda run: runs_figure([run], "onset"),
    "branches": branches,
}


def written(figure: Figure) -> list[Text]:
    """Return the texts that are seen."""
    figure.draw_without_rendering()
    hidden = {text for ax in figure.findobj(Axes) for text in unseen(ax)}
    texts = [text for text in figure.findobj(Text) if isinstance(text, Text)]
    return [
        text
        for text in texts
        if text.get_visible() and text.get_text().strip() and text not in hidden
    ]


def unseen(ax: Any) -> set[Text]:
    """Return the labels of ticks beyond the ends of an axis, or of axes that are off."""
    found: set[Text] = set()
    for axis in (ax.xaxis, ax.yaxis):
        low, high = sorted(axis.get_view_interval())
        off = not (ax.axison and axis.get_visible())
        found |= {axis.label} if off else set()
        for tick in (*axis.get_major_ticks(), *axis.get_minor_ticks()):
            if off or not low <= tick.get_loc() <= high:
                found |= {tick.label1, tick.label2}
    return found


def panels(figure: Figure) -> list[Axes]:
    return [ax for ax in figure.findobj(Axes) if isinstance(ax, Axes) and ax.axison]


def named(figure: Figure) -> list[Line2D]:
    """Return the lines of the legends."""
    legends = [*figure.legends, *(box for part in figure.subfigs for box in part.legends)]
    return [line for legend in legends for line in legend.findobj(Line2D)]


def tag(line: Line2D) -> tuple[Any, ...]:
    """What tells a curve from others: colour, marker, whether that is filled."""
    face = line.get_markerfacecolor()
    return to_rgba(line.get_color()), line.get_marker(), to_rgba(face)


def curves(ax: Axes) -> list[Line2D]:
    """Return the lines of more than two points: the curves."""
    return [line for line in ax.lines if np.size(line.get_xdata()) > 2]


def curves_of(figure: Figure) -> list[Line2D]:
    return [line for ax in panels(figure) for line in curves(ax)]


def noise(count: int) -> list[float]:
    found = 1e-14 * np.random.default_rng(0).normal(size=count)
    return [float(value) for value in found]


def test_a_flat_film_s_curves_are_zero_and_no_transition(
    tmp_path: Path, mesh: Disk
) -> None:
    there = [float(load) for load in range(100, 500, 25)]
    rows = [
        replace(
            row_at(step, load),
            abs_kappa_n=abs(value),
            total_gauss_curvature=value,
            waist_twist=value,
            bending_energy=40.0,
            residual=1e-12,
        )
        for step, (load, value) in enumerate(zip(there, noise(len(there)), strict=True))
    ]
    assert all(row.abs_kappa_n < bend_error(row) for row in rows)
    (run,) = read_runs([record(tmp_path / "flat", mesh, rows)])
    bent, curved, twisted, *others = panels(diagram_figure(run))
    for ax in (bent, curved, twisted, *panels(runs_figure([run], "curvature"))):
        (line,) = curves(ax)
        assert np.array_equal(np.asarray(line.get_ydata()), np.zeros(len(rows)))
    assert len(others) == 2


@pytest.mark.slow
def test_a_bent_film_s_curve_is_left_as_it_is(sweep: Path) -> None:
    (run,) = read_runs([sweep])
    bent = panels(diagram_figure(run))[0]
    values = np.asarray(curves(bent)[0].get_ydata())
    assert np.array_equal(values, [row.abs_kappa_n for row in run.rows])


def test_every_diagram_shows_the_energy(sweep: Path) -> None:
    (run,) = read_runs([sweep])
    labels = [ax.get_ylabel() for ax in panels(diagram_figure(run))]
    assert any(label.startswith("$E") for label in labels)


def test_curves_are_told_apart_in_colour_and_in_grey() -> None:
    """Grey leaves the marker and whether it is filled."""
    looks = [style(number) for number in range(91)]
    assert len({(look["color"], look["marker"]) for look in looks}) == 91
    grey = {(look["marker"], look["markerfacecolor"] == "white") for look in looks[:26]}
    assert len(grey) == 26


@pytest.mark.parametrize("count", quick_with([1, 4], [1, 4, 9]))
def test_every_branch_has_a_look_of_its_own_that_the_legend_names(count: int) -> None:
    figure = branches_figure(branched(count))
    drawn = {tag(line) for line in curves_of(figure)}
    assert len(drawn) == 1 + 2 * count
    assert drawn <= {tag(line) for line in named(figure)}
    if count < 9:
        in_grey = {(marker, face == (1.0, 1.0, 1.0, 1.0)) for _, marker, face in drawn}
        assert len(in_grey) == len(drawn)


def test_every_row_of_a_sweep_has_its_marker(sweep: Path) -> None:
    (run,) = read_runs([sweep])
    for figure in (diagram_figure(run), runs_figure([run], "energy")):
        for line in curves_of(figure):
            assert line.get_marker() not in ("", "None", None)
            assert line.get_markevery() is None


def overlapping(texts: Sequence[Text]) -> list[tuple[str, str]]:
    boxes = [(text.get_text(), text.get_window_extent()) for text in texts]
    found = []
    for (one, a), (other, b) in combinations(boxes, 2):
        wide = min(a.x1, b.x1) - max(a.x0, b.x0)
        high = min(a.y1, b.y1) - max(a.y0, b.y0)
        # Boxes have room around letters: so many pixels of it are no overlap.
        if wide > 1.0 and high > 1.0:
            found.append((one, other))
    return found


@pytest.mark.parametrize("name", quick_with(["energy"], SMALL_FIGURES))
def test_figures_of_small_runs_can_be_read(sweep: Path, name: str) -> None:
    """Not one text lies on another, all are as large as journals ask, none is too wide."""
    (run,) = read_runs([sweep])
    figure = SMALL_FIGURES[name](run)
    texts = written(figure)
    assert len(texts) > 10
    assert overlapping(texts) == []
    assert min(text.get_fontsize() for text in texts) >= LEAST
    assert figure.get_figwidth() <= PAGE + 1e-9
    assert figure.get_figheight() <= PAGE_HEIGHT


@pytest.mark.slow
def test_twenty_runs_fit_on_a_page_and_their_diagram_is_no_strip(many: list[Run]) -> None:
    figure = runs_figure(many, "diagram")
    figure.draw_without_rendering()
    assert figure.get_figwidth() <= PAGE + 1e-9
    assert figure.get_figheight() <= PAGE_HEIGHT
    heights = [ax.get_window_extent().height / figure.dpi for ax in panels(figure)]
    assert min(heights) > 0.2 * figure.get_figheight()
    shapes = [ax for ax in figure.findobj(Axes) if not ax.axison and ax.collections]
    total = sum(len(run.states()) for run in many)
    assert len(shapes) == 12 < total
    notes = [part.get_supxlabel() for part in figure.subfigs]
    assert any(f"12 of the {total} states" in note for note in notes)


@pytest.mark.parametrize(("sizes", "most"), [((3, 0, 2), 12), ((60,), 12), ((1,) * 20, 12)])
def test_so_many_shapes_are_chosen_evenly(sizes: Sequence[int], most: int) -> None:
    shown = [[(run, n) for n in range(size)] for run, size in enumerate(sizes)]
    every = [row for rows in shown for row in rows]
    found, note = at_most(shown, most)
    chosen = [row for rows in found for row in rows]
    assert len(found) == len(shown)
    assert len(chosen) == min(most, len(every))
    assert (chosen[0], chosen[-1]) == (every[0], every[-1])
    assert bool(note) == (len(every) > most)
    gaps = np.diff([every.index(row) for row in chosen])
    assert np.ptp(gaps) <= 1
