"""Plots of runs: what is drawn is what the tables hold, for one run and for several."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import product
from pathlib import Path
from shutil import copytree
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.image import imread
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.text import Annotation
from matplotlib.transforms import Bbox

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.scaling import PowerLaw, fit_power
from eulerplateau.errors import OutputError
from eulerplateau.mesh.disk import Disk
from eulerplateau.pictures import onset
from eulerplateau.pictures.comparison import WHAT, plot_runs, runs_figure
from eulerplateau.pictures.figure import save
from eulerplateau.pictures.onset import fit_onset
from eulerplateau.runs.record import read_runs
from eulerplateau.solvers.equilibrium import Status
from tests.helpers.marks import quick_with
from tests.helpers.plotted_runs import ONSET, pitchfork, record, row_at, swept
from tests.helpers.shapes import disk_points, mesh_of

# Of contact tests/runs/test_contact_runs.py has a run.
OF_ANY_FILM = [what for what in WHAT if what != "contact"]
LABEL = {
    "diagram": r"\kappa_n",
    "energy": r"L/\alpha",
    "curvature": "K",
    "eigenvalue": r"\lambda_1",
    "onset": r"\kappa_n",
}


@pytest.fixture(scope="module", autouse=True)
def _each_law_fitted_once() -> Iterator[None]:
    """Most runs here have the same rows."""

    @functools.cache
    def fitted(x: tuple[float, ...], y: tuple[float, ...]) -> PowerLaw:
        return fit_power(x, y)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(onset, "fit_power", lambda x, y: fitted(tuple(x), tuple(y)))
        yield


@pytest.fixture(scope="module")
def mesh() -> Disk:
    return mesh_of(*disk_points(5))


@pytest.fixture(scope="module")
def sweep(tmp_path_factory: pytest.TempPathFactory, mesh: Disk) -> Path:
    return record(tmp_path_factory.mktemp("runs") / "long", mesh, swept())


@pytest.fixture(scope="module")
def other(tmp_path_factory: pytest.TempPathFactory, mesh: Disk) -> Path:
    folder = tmp_path_factory.mktemp("runs") / "round"
    return record(folder, mesh, swept(850.0), vertices=2000, solver="cg")


def panels(figure: Figure) -> list[Axes]:
    return [ax for ax in figure.findobj(Axes) if isinstance(ax, Axes) and ax.axison]


def places(line: Line2D) -> FloatArray:
    return np.asarray(line.get_xdata(), dtype=float)


def legend_texts(figure: Figure) -> list[str]:
    inside = [ax.get_legend() for ax in panels(figure)]
    boxes = [*figure.legends, *(box for part in figure.subfigs for box in part.legends)]
    return [
        text.get_text()
        for box in (*boxes, *inside)
        if box is not None
        for text in box.get_texts()
    ]


@pytest.fixture(scope="module")
def figure_of(long_names: list[Path]) -> Callable[[str], Figure]:
    """What makes the figure of one run, once, with its parts where they belong."""

    @functools.cache
    def laid_out(what: str) -> Figure:
        figure = runs_figure(read_runs(long_names[:1]), what)
        figure.draw_without_rendering()
        figure.set_layout_engine("none")
        return figure

    return laid_out


def test_a_plot_is_its_figure(tmp_path: Path, sweep: Path) -> None:
    plot_runs(read_runs([sweep]), "curvature", tmp_path / "plot.png")
    save(runs_figure(read_runs([sweep]), "curvature"), tmp_path / "figure.png")
    assert (tmp_path / "plot.png").read_bytes() == (tmp_path / "figure.png").read_bytes()


# Every plot, and every format.
QUICK = [*((what, "png") for what in OF_ANY_FILM), ("diagram", "pdf"), ("diagram", "svg")]


@pytest.mark.parametrize(
    ("what", "ending"), quick_with(QUICK, product(OF_ANY_FILM, ["png", "pdf", "svg"]))
)
def test_every_plot_is_drawn_in_every_format(
    tmp_path: Path, figure_of: Callable[[str], Figure], what: str, ending: str
) -> None:
    path = tmp_path / f"plot.{ending}"
    save(figure_of(what), path)
    if ending == "png":
        assert imread(path)[..., :3].std() > 0.05
    elif ending == "svg":
        root = ElementTree.parse(path).getroot()
        assert sum(mark.tag.endswith(("}path", "}use")) for mark in root.iter()) > 50
    else:
        content = path.read_bytes()
        assert content.startswith(b"%PDF")
        assert content.rstrip().endswith(b"%%EOF")
        assert len(content) > 5000


def test_same_runs_make_the_same_file(tmp_path: Path, sweep: Path) -> None:
    for ending in ("pdf", "svg"):
        files = [tmp_path / f"{name}.{ending}" for name in "ab"]
        for path in files:
            plot_runs(read_runs([sweep]), "curvature", path)
        assert files[0].read_bytes() == files[1].read_bytes()


@pytest.mark.parametrize("what", OF_ANY_FILM)
def test_curves_hold_the_rows_and_the_axes_say_what(
    sweep: Path, figure_of: Callable[[str], Figure], what: str
) -> None:
    (run,) = read_runs([sweep])
    axes = panels(figure_of(what))
    assert LABEL[what] in axes[0].get_ylabel()
    assert all(ax.get_ylabel() for ax in axes)
    if what != "onset":
        column = {
            "diagram": "abs_kappa_n",
            "energy": "energy",
            "curvature": "total_gauss_curvature",
            "eigenvalue": "lowest_eigenvalue",
        }[what]
        x, y = axes[0].lines[0].get_data()
        assert np.array_equal(x, [row.kL3_alpha for row in run.rows])
        assert np.array_equal(np.abs(y), [abs(getattr(row, column)) for row in run.rows])
        assert "L^3" in axes[-1].get_xlabel()


@pytest.mark.parametrize("what", OF_ANY_FILM)
def test_runs_have_labels_colours_markers_and_fills_of_their_own(
    sweep: Path, other: Path, what: str
) -> None:
    """The marker tells runs apart where the colour does not."""
    runs = read_runs([sweep, other])
    figure = runs_figure(runs, what)
    texts = legend_texts(figure)
    for run in runs:
        assert any(run.label in text for text in texts)
    drawn = [
        line
        for line in panels(figure)[0].lines
        if any(run.label in str(line.get_label()) for run in runs)
    ]
    assert len(drawn) == 2
    for look in ("get_color", "get_marker", "get_markerfacecolor"):
        assert len({getattr(line, look)() for line in drawn}) == 2


@pytest.fixture(scope="module")
def long_names(sweep: Path, tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """Four runs like the first."""
    folder = tmp_path_factory.mktemp("runs")
    names = [f"a-rather-long-name-of-a-run-{number}" for number in range(4)]
    return [Path(copytree(sweep, folder / name)) for name in names]


@pytest.mark.parametrize(
    ("count", "what"),
    quick_with(
        [*((1, what) for what in OF_ANY_FILM), (4, "diagram"), (4, "onset")],
        product([1, 4], OF_ANY_FILM),
    ),
)
def test_nothing_leaves_the_figure(
    long_names: list[Path], figure_of: Callable[[str], Figure], what: str, count: int
) -> None:
    if count == 1:
        figure = figure_of(what)
    else:
        figure = runs_figure(read_runs(long_names[:count]), what)
        figure.draw_without_rendering()
    inside = figure.bbox.padded(1.0)
    boxes = [ax.get_tightbbox() for ax in figure.findobj(Axes) if isinstance(ax, Axes)]
    boxes += [legend.get_window_extent() for legend in figure.findobj(Legend)]
    for box in boxes:
        assert (
            box is None
            or box.width == 0
            or np.allclose(Bbox.union([box, inside]).extents, inside.extents)
        )


def test_labels_tell_folders_meshes_and_solvers_apart(
    tmp_path: Path, mesh: Disk, sweep: Path, other: Path
) -> None:
    first, second = (run.label for run in read_runs([sweep, other]))
    assert first.startswith("long")
    assert second.startswith("round")
    for word in ("474", "newton"):
        assert (word in first, word in second) == (True, False)
    for word in ("2000", "cg"):
        assert (word in first, word in second) == (False, True)
    alike = [record(tmp_path / name / "run", mesh, [row_at(0, 1.0)]) for name in ("a", "b")]
    assert [run.label for run in read_runs(alike)] == ["a/run", "b/run"]
    assert [run.label for run in read_runs([sweep, sweep])] == ["long"]


def test_onset_shows_the_exponents_of_the_fit(sweep: Path) -> None:
    (run,) = read_runs([sweep])
    near = [row for row in run.rows if ONSET < row.kL3_alpha < 1.011 * ONSET]
    x = [row.kL3_alpha for row in near]
    laws = [
        fit_power(x, [row.abs_kappa_n for row in near]),
        fit_power(x, [-row.total_gauss_curvature for row in near]),
    ]
    assert [found.law for found in fit_onset(run)] == laws
    texts = [text for text in legend_texts(runs_figure([run], "onset")) if "±" in text]
    shown = [[float(word) for word in text.split()[1::2]] for text in texts[1:]]
    assert len(shown) == 2
    for (exponent, error), law in zip(shown, laws, strict=True):
        assert exponent == pytest.approx(law.exponent, abs=law.exponent_error + 1e-12)
        assert error == pytest.approx(law.exponent_error, rel=0.06)
    assert laws[0].exponent == pytest.approx(0.5, abs=1e-6)
    assert laws[1].exponent == pytest.approx(1.0, abs=1e-6)


def test_onset_draws_the_fitted_law_through_its_points(sweep: Path) -> None:
    figure = runs_figure(read_runs([sweep]), "onset")
    logarithmic = [ax for ax in panels(figure) if ax.get_yscale() == "log"]
    assert len(logarithmic) == 2
    for ax in logarithmic:
        points, curve = (np.asarray(line.get_data(), dtype=float) for line in ax.lines)
        at_points = np.exp(np.interp(np.log(points[0]), np.log(curve[0]), np.log(curve[1])))
        assert np.allclose(at_points, points[1], rtol=1e-3)


def test_too_few_rows_near_an_onset_are_an_error(tmp_path: Path, mesh: Disk) -> None:
    sparse = [row_at(step, load) for step, load in enumerate((1.0, 600.0, 700.0, 800.0))]
    for name, rows in (("sparse", sparse), ("planar", sparse[:2]), ("bent", sparse[2:])):
        folder = record(tmp_path / name, mesh, rows)
        with pytest.raises(OutputError) as raised:
            runs_figure(read_runs([folder]), "onset")
        assert raised.value.path == folder


def test_diagram_has_one_film_per_state_at_one_scale(sweep: Path, other: Path) -> None:
    runs = read_runs([sweep, other])
    figure = runs_figure(runs, "diagram")
    films = [ax for ax in figure.findobj(Axes) if ax.findobj(PolyCollection)]
    assert len(films) == sum(len(run.states()) for run in runs)
    assert len({(*ax.get_xlim(), *ax.get_ylim()) for ax in films}) == 1
    for ax in films:
        assert ax.get_aspect() == 1.0
        (painted,) = ax.findobj(PolyCollection)
        seen = np.concatenate([path.vertices for path in painted.get_paths()])
        assert (np.abs(seen) < [ax.get_xlim()[1], ax.get_ylim()[1]]).all()


def test_chosen_steps_are_numbered_where_they_are(sweep: Path) -> None:
    (run,) = read_runs([sweep])
    steps = [0, 4, 24]
    figure = runs_figure([run], "diagram", steps)
    numbers = [
        text for ax in panels(figure) for text in ax.texts if isinstance(text, Annotation)
    ]
    assert [text.get_text() for text in numbers] == ["1", "2", "3"]
    for text, step in zip(numbers, steps, strict=True):
        row = run.rows[step]
        assert text.xy == (row.kL3_alpha, row.abs_kappa_n)


def test_sweep_up_and_down_and_rows_not_converged_are_told_apart(
    tmp_path: Path, mesh: Disk
) -> None:
    there = [1.0, 300.0, 600.0, 700.0, 800.0]
    rows = [row_at(step, load) for step, load in enumerate(there + there[-2::-1])]
    rows[1] = replace(rows[1], status=Status.STALLED, energy=math.nan)
    figure = runs_figure(read_runs([record(tmp_path / "run", mesh, rows)]), "energy")
    up, down, bad = panels(figure)[0].lines
    assert (up.get_linestyle(), down.get_linestyle()) == ("-", "--")
    assert rows[1].kL3_alpha not in places(up)
    assert list(places(bad)) == [rows[1].kL3_alpha]
    assert len(legend_texts(figure)) == 3


def test_what_falls_and_what_is_unstable_are_told_apart(tmp_path: Path, mesh: Disk) -> None:
    there = [1.0, 300.0, 600.0]
    rows = [row_at(step, load) for step, load in enumerate(there + there[-2::-1])]
    folders = [
        record(tmp_path / "run", mesh, rows),
        record(tmp_path / "of", mesh, pitchfork()),
    ]
    figure = runs_figure(read_runs(folders), "energy")
    dashes = {
        str(line.get_label()): vars(line)["_unscaled_dash_pattern"]
        for part in figure.subfigs
        for box in part.legends
        for line in box.get_lines()
    }
    assert dashes["unstable"] != dashes["load falling"]


@pytest.mark.parametrize(
    "what",
    quick_with(["diagram", "eigenvalue"], ["diagram", "energy", "curvature", "eigenvalue"]),
)
@pytest.mark.parametrize("case", ["no eigenvalues", "one row", "stalled", "infinite"])
def test_every_run_has_a_plot(tmp_path: Path, mesh: Disk, what: str, case: str) -> None:
    rows = [row_at(step, load) for step, load in enumerate((1.0, 660.0, 700.0))]
    changes: dict[str, dict[str, Any]] = {
        "no eigenvalues": {"lowest_eigenvalue": None, "n_unstable": None},
        "one row": {},
        "stalled": {"status": Status.STALLED},
        "infinite": {"energy": math.inf, "lowest_eigenvalue": math.inf},
    }
    rows = [replace(row, **changes[case]) for row in rows[: 1 if case == "one row" else 3]]
    folder = record(tmp_path / "run", mesh, rows)
    plot_runs(read_runs([folder]), what, tmp_path / "plot.png")
    assert imread(tmp_path / "plot.png")[..., :3].std() > 0.01


@pytest.mark.parametrize("what", ["diagram", "eigenvalue"])
def test_branches_are_solid_where_stable(tmp_path: Path, mesh: Disk, what: str) -> None:
    """A planar branch that loses stability at a pitchfork, and the branch it gives."""
    folder = record(tmp_path / "run", mesh, pitchfork())
    (run,) = read_runs([folder])
    curves = panels(runs_figure([run], what))[0].lines[:3]
    solid = [line.get_linestyle() == "-" for line in curves]
    ends = [(round(min(x)), round(max(x))) for x in map(places, curves)]
    assert list(zip(solid, ends, strict=True)) == [
        (True, (100, 500)),
        (False, (500, 900)),
        (True, (500, 900)),
    ]
