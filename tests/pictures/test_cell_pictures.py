"""Pictures of cells: what is drawn is what the tables hold; films load nothing of them."""

from __future__ import annotations

import logging
import re
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from matplotlib.quiver import Quiver
from matplotlib.text import Text

from eulerplateau.cli.plot import plot
from eulerplateau.errors import OutputError, SpecError
from eulerplateau.pictures.branch_diagram import draw_branches
from eulerplateau.pictures.comparison import check_plot, runs_figure
from eulerplateau.pictures.gallery import collect, page
from eulerplateau.pictures.outlines import outlines, read_outline
from eulerplateau.pictures.render import RunPictures
from eulerplateau.pictures.sweep_diagram import draw_diagram, plot_diagram
from eulerplateau.runs.cell_kind import CELL, CONVEX, INFLECTED, TOUCHING, cell_state
from eulerplateau.runs.cell_runs import run_cell_branches, run_cell_sweep
from eulerplateau.runs.cell_spec import CellRunSpec, CellSettings, CellSweepSettings
from eulerplateau.runs.record import Run, read_run
from eulerplateau.runs.series import Branch, energy_above
from eulerplateau.runs.states import distinct_steps
from eulerplateau.solvers.equilibrium import Status
from tests.pictures.test_gallery import Page, unpacked
from tests.pictures.test_pictures import read_png

LABELS = {
    "diagram": ("P/R_0", r"R_0^2/\alpha"),
    "energy": (r"R_0/\alpha",),
    "curvature": (r"\kappa R_0",),
    "eigenvalue": (r"R_0^4/\alpha",),
}


def spec_of(values: list[float], edges: int = 24) -> CellRunSpec:
    """A coarse cell on three adhesions: convex below about 25, gone beyond about 65."""
    return CellRunSpec(
        cell=CellSettings(adhesions=3, edges_per_side=edges, sigma_hat=40.0, ks_hat=100.0),
        sweep=CellSweepSettings(values=values),
    )


@pytest.fixture(scope="module")
def sweep(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Convex, inflected, and at last touching itself."""
    folder = tmp_path_factory.mktemp("cells") / "sweep"
    run_cell_sweep(spec_of([5.0, 15.0, 30.0, 45.0, 60.0, 80.0]), folder)
    return folder


@pytest.fixture(scope="module")
def branches(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The first branch, both ways from 40."""
    folder = tmp_path_factory.mktemp("cells") / "branches"
    spec = spec_of([20.0, 66.0], edges=16)
    few = spec.branches.model_copy(update={"special_points": 1, "unstable_modes": 1})
    run_cell_branches(spec.model_copy(update={"branches": few}), folder)
    return folder


@pytest.fixture(autouse=True)
def _no_warnings(caplog: pytest.LogCaptureFixture) -> Iterator[None]:
    """Nothing that is drawn here is complained of."""
    with caplog.at_level(logging.WARNING):
        yield
    assert [record.getMessage() for record in caplog.records] == []


def texts(figure: Figure) -> str:
    return "\n".join(text.get_text() for text in figure.findobj(Text))


def test_sweep_has_its_states(sweep: Path) -> None:
    run = read_run(sweep)
    assert run.kind is CELL
    states = [cell_state(row) for row in run.rows]
    assert states == [CONVEX] * 2 + [INFLECTED] * 3 + [TOUCHING]
    # The roundest; half as inflected as the most, that, and where the run ends.
    assert run.distinct_steps() == [0, 3, 4, 5]
    assert [row.step for row in run.states()] == [0, 3, 4, 5]
    assert run.between is None


def test_rows_that_stopped_half_way_are_no_states(sweep: Path) -> None:
    rows = [replace(row, status=Status.STALLED) for row in read_run(sweep).rows]
    assert distinct_steps(rows, CELL.states) == []


@pytest.mark.slow
def test_diagrams_are_drawn_and_nothing_cut_off(sweep: Path, branches: Path) -> None:
    assert draw_diagram(sweep)
    assert draw_branches(branches)
    for path in (sweep / "diagram.png", branches / "branches.png"):
        image = read_png(path)
        assert image.std() > 0.05
        frame = np.concatenate([image[0], image[-1], image[:, 0], image[:, -1]])
        assert (frame == 1.0).all()


def test_first_branch_is_one_both_ways(branches: Path) -> None:
    """Its energy is compared with itself above and below where it was started."""
    first = [branch for branch in read_run(branches).branches if branch.origin is None]
    assert len(first) == 2
    above = energy_above(*first)
    for branch in first:
        turned = np.flatnonzero(np.diff(np.sign(np.diff(branch.loads))))
        reached = branch.rows[: turned[0] + 1] if len(turned) else branch.rows
        assert np.abs(above(Branch(reached))).max() < 1e-9


def test_slope_of_the_energy_is_the_part_proportional_to_the_load(sweep: Path) -> None:
    for parameter in ("sigma_hat", "ks_hat"):
        row = replace(read_run(sweep).rows[2], quantity=parameter)
        part = row.film_energy if parameter == "sigma_hat" else row.adhesion_energy
        assert row.load_energy == part


@pytest.mark.parametrize("what", LABELS)
def test_plots_show_the_rows_with_their_units(sweep: Path, what: str) -> None:
    run = read_run(sweep)
    figure = runs_figure([run], what)
    words = texts(figure)
    assert all(label in words for label in (*LABELS[what], r"\sigma R_0^3/\alpha"))
    assert "not converged" in words
    drawn = np.concatenate(
        [np.asarray(line.get_xdata(), dtype=float) for line in figure.findobj(match_line)]
    )
    assert {row.load for row in run.rows} <= set(drawn.tolist())


def match_line(artist: Any) -> bool:
    return hasattr(artist, "get_xdata") and len(artist.get_xdata()) > 0


def test_outlines_stand_above_the_diagram(sweep: Path) -> None:
    """Each with its state, its edge, where it is held, and how it pulls."""
    run = read_run(sweep)
    figure = runs_figure([run], "diagram")
    words = texts(figure)
    assert all(state in words for state in (CONVEX, INFLECTED, TOUCHING))
    assert "traction on the substrate" in words
    edges = figure.findobj(lambda a: isinstance(a, Polygon) and len(a.get_xy()) > 30)
    for row, edge in zip(run.states(), edges, strict=True):
        outline = read_outline(run.shape_path(row))
        assert np.array_equal(edge.get_xy()[:-1], outline.edge)
        assert np.hypot(*outline.forces.T).mean() == pytest.approx(row.traction, rel=1e-9)
        assert np.hypot(*outline.rest.T) == pytest.approx(1.0, rel=1e-12)
    arrows = figure.findobj(Quiver)
    assert [arrow.N for arrow in arrows] == [3] * 4


def test_tractions_point_inwards(sweep: Path) -> None:
    """A contractile cell pulls its substrate in."""
    outline = read_outline(read_run(sweep).shape_path(read_run(sweep).rows[2]))
    assert ((outline.forces * outline.rest).sum(axis=1) < 0).all()
    assert ((outline.held * outline.rest).sum(axis=1) < 1).all()


def test_a_film_s_shape_is_no_outline(tmp_path: Path) -> None:
    path = tmp_path / "shape.vtp"
    path.write_text("<VTKFile")
    with pytest.raises(OutputError):
        outlines([[path]])


def test_onset_is_a_question_about_films(sweep: Path, tmp_path: Path) -> None:
    with pytest.raises(SpecError, match="a cell has no onset"):
        check_plot([read_run(sweep)], "onset")
    out = str(tmp_path / "plot.png")
    result = CliRunner().invoke(plot, [str(sweep), "--what", "onset", "-o", out])
    assert isinstance(result.exception, SpecError)
    done = CliRunner().invoke(plot, [str(sweep), "--what", "curvature", "-o", out])
    assert done.exit_code == 0
    assert read_png(Path(out)).std() > 0.02


def test_gallery_has_the_columns_of_cells_and_their_positions(sweep: Path) -> None:
    gallery = collect([sweep])
    run = gallery.exhibits[0].run
    data = Page(page(gallery)).data
    assert data["kind"] == "cell"
    assert data["columns"] == [*CELL.columns, "special"]
    assert data["load"] == "sigma_hat"
    (shown,) = data["runs"]
    stored = run.shapes().x
    x = data["unit"] * unpacked(shown["shapes"], "<i2").reshape(stored.shape)
    # Moved alike, not turned; rounded to 16 bits.
    moved = x - stored
    assert np.ptp(moved.reshape(-1, 3), axis=0).max() < 1e-4
    assert np.abs(0.5 * (x.min(axis=(0, 1)) + x.max(axis=(0, 1)))).max() < 1e-4
    for row, cells in zip(run.rows, shown["rows"], strict=True):
        by_name = dict(zip(data["columns"], cells, strict=True))
        for name in ("perimeter", "traction", "kappa_mid", "extension", "area"):
            assert by_name[name] == pytest.approx(getattr(row, name), rel=1e-9)


def test_renders_are_coloured_by_curvature_from_above(sweep: Path) -> None:
    pictures = RunPictures.read(sweep, [0, 4])
    assert pictures.colour == "kappa"
    assert pictures.scale is not None
    assert pictures.scale.low == -pictures.scale.high
    assert "R_0" in pictures.scale.label
    view = pictures.stage.view(pictures.shapes)
    assert view.eye[2] > 0.999
    perimeter = read_run(sweep).rows[0].perimeter / (2 * np.pi)
    edge = pictures.shapes[0].x_loop
    lengths = np.linalg.norm(np.roll(edge, -1, axis=0) - edge, axis=1)
    assert lengths.sum() == pytest.approx(perimeter, rel=1e-9)


@pytest.mark.parametrize("case", ["stalled", "up and down"])
def test_every_sweep_has_a_diagram(sweep: Path, tmp_path: Path, case: str) -> None:
    rows = list(read_run(sweep).rows)
    chosen: list[Any] = {
        "stalled": [replace(row, status=Status.STALLED) for row in rows],
        "up and down": [*rows[:5], *rows[3::-1]],
    }[case]
    run = Run(sweep, tuple(chosen), about={"kind": "cell"})
    plot_diagram(run, tmp_path / "diagram.png")
    assert read_png(tmp_path / "diagram.png").std() > 0.01


LOADED = """
import sys
from pathlib import Path
from eulerplateau.pictures import draw_diagram, pictures_of
from eulerplateau.runs import read_run
pictures_of(read_run(Path(sys.argv[1])).kind)
assert draw_diagram(Path(sys.argv[1]))
print(*(name for name in sys.modules if name.startswith("eulerplateau")))
"""


@pytest.mark.slow
def test_a_film_loads_nothing_of_cells(tmp_path: Path) -> None:
    from eulerplateau.runs.table import RowWriter
    from tests.runs.test_output import ROW

    with RowWriter(tmp_path / "sweep.csv") as table:
        table.append(ROW)
    command = [sys.executable, "-c", LOADED, str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stderr == ""
    loaded = done.stdout.split()
    assert "eulerplateau.pictures.film_pictures" in loaded
    unwanted = re.compile(r"\.(cells?|cell_\w+|outlines)(\.|$)")
    assert [name for name in loaded if unwanted.search(name)] == []
