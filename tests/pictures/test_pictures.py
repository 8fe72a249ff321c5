"""Pictures: something is seen, nothing is cut off, and a crash costs no run."""

from __future__ import annotations

import logging
import math
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.drawing import aligned, draw_in_child
from eulerplateau.mesh.shape import Shape
from eulerplateau.pictures.figure import drawn
from eulerplateau.pictures.render import draw_shapes
from eulerplateau.pictures.sweep_diagram import draw_diagram, plot_diagram
from eulerplateau.runs.own_columns import OfContact, with_own
from eulerplateau.runs.record import Run
from eulerplateau.runs.rows import Row
from eulerplateau.runs.states import distinct_steps
from eulerplateau.runs.table import RowWriter
from eulerplateau.solvers.equilibrium import Status
from tests.helpers.drawing import let_one_child_draw
from tests.helpers.shapes import disk_points, eight, mesh_of, rotation
from tests.runs.test_folder import start
from tests.runs.test_output import ROW

STALLED = Status.STALLED
Image = NDArray[np.float64]

# Disk, ellipse, twisted saddle, flat eight, bent lobes: (load, |kappa_n|, twist, aspect).
SEQUENCE = [
    (1.0, 1e-9, 0.0, 0.99),
    (10.0, 1e-9, 0.0, 0.98),
    (300.0, 1e-9, 0.0, 0.8),
    (640.0, 1e-9, 0.0, 0.5),
    (660.0, 1.5, 40.0, 0.5),
    (700.0, 3.0, 90.0, 0.5),
    (735.0, 0.6, 170.0, 0.5),
    (740.0, 1e-6, 180.0, 0.4),
    (1500.0, 1e-6, 180.0, 0.3),
    (2100.0, 1.0, 180.0, 0.3),
    (2500.0, 2.0, 180.0, 0.3),
]


@pytest.fixture(scope="module")
def mesh() -> Disk:
    return mesh_of(*disk_points(8))


@pytest.fixture
def rows() -> list[Row]:
    return [
        replace(ROW, step=i, kL3_alpha=load, abs_kappa_n=k, waist_twist=twist, aspect=a)
        for i, (load, k, twist, a) in enumerate(SEQUENCE)
    ]


def twisted(mesh: Disk, t: float) -> FloatArray:
    """The film of eq. eight on `mesh`, with a loop of unit length."""
    x = eight(mesh.x[:, :2] / np.hypot(*mesh.x.T[:2]).max(), t)
    loop = x[mesh.loop]
    return x / np.linalg.norm(np.roll(loop, -1, axis=0) - loop, axis=1).sum()


def read_png(path: Path) -> Image:
    from matplotlib.image import imread

    image: Image = imread(path)[..., :3].astype(float)
    return image


def record(path: Path, mesh: Disk, films: Sequence[FloatArray]) -> None:
    with start(path) as folder:
        for step, x in enumerate(films):
            folder.record(replace(ROW, step=step, kL3_alpha=100.0 * step), mesh, x)


def test_one_picture_per_state_of_the_sequence(rows: list[Row]) -> None:
    """Disk, ellipse and eight by their last row; the others where they bend the most."""
    assert distinct_steps(rows) == [1, 3, 5, 8, 10]


def test_rows_that_did_not_converge_are_no_states(rows: list[Row]) -> None:
    rows[3] = replace(rows[3], status=STALLED)
    rows[5] = replace(rows[5], status=STALLED)
    shown = distinct_steps(rows)
    assert len(shown) == 5
    assert not {3, 5} & set(shown)
    assert distinct_steps([replace(row, status=STALLED) for row in rows]) == []


def test_a_saddle_that_cuts_through_itself_is_a_state_of_its_own(rows: list[Row]) -> None:
    """The saddle before it overhangs, up or down; then where most triangles cross."""
    kappa = [0.0, 1.0, 2.5, 3.0, 2.9, 2.8]
    crossings = [0, 0, 0, 0, 3, 60]
    saddles = [
        replace(row, abs_kappa_n=k, self_intersections=n, waist_twist=0.0)
        for row, k, n in zip(rows, kappa, crossings, strict=False)
    ]
    assert distinct_steps(saddles) == [0, 2, 5]
    assert distinct_steps(saddles[::-1]) == [5, 2, 0]


def test_film_without_a_waist_path_still_has_states(rows: list[Row]) -> None:
    assert distinct_steps([replace(row, waist_twist=math.nan) for row in rows])


@pytest.mark.parametrize("diameter", [0.05, 0.01, 0.001, 1e-5])
def test_a_thick_loop_has_the_same_states_however_thin_it_is(diameter: float) -> None:
    """Disk, lobes, lobes that touch, the eight: it flattens as the line is thinner.

    Its strands cross all the same, at an angle that does not vanish with the diameter, so
    that it is no state of the lobes.
    """
    thick = with_own(OfContact, Row)
    cells = asdict(ROW)
    sequence = [
        (1e-9, 0.99, None),
        (1e-9, 0.5, None),
        (1e-9, 0.3, 1e-12),
        (25.0 * diameter, 0.2, 60.0),
        (25.0 * diameter, 0.2, 30.0),
        (1e-9, 0.99, None),
    ]
    rows = [
        thick(
            **cells
            | {"step": step, "abs_kappa_n": bent, "waist_twist": 0.0, "aspect": aspect}
            | {"contacts": int(angle is not None), "contact_force": 0.0}
            | {"smallest_gap": None, "crossing_angle": angle, "film_vertices": 100}
        )
        for step, (bent, aspect, angle) in enumerate(sequence)
    ]
    assert distinct_steps(rows) == [0, 2, 3, 5]


def test_alignment_undoes_every_rigid_motion(mesh: Disk) -> None:
    """For films without symmetry: a symmetric one may lie in either of two like ways."""

    def shapes(moved: bool) -> list[Shape]:
        bump = 0.05 * np.cos(20.0 * mesh.x[:, [1, 0, 0]] + [1.0, 2.0, 3.0])
        x = [twisted(mesh, t) + t * bump for t in (0.3, 0.4, 0.9)]
        if moved:
            turn = rotation()
            x = [x[0] @ turn, x[1] @ turn.T + 3.0, x[2] @ turn @ turn - 1.0]
        return [Shape(film, mesh.triangles, mesh.loop) for film in x]

    still, moved = aligned(shapes(moved=False)), aligned(shapes(moved=True))
    # Only the long axis's direction is left to chance: half a turn about z.
    half_turn = np.diag([-1.0, -1.0, 1.0])
    error = min(
        max(np.abs(a.x - b.x @ turn).max() for a, b in zip(still, moved, strict=True))
        for turn in (np.eye(3), half_turn)
    )
    assert error < 1e-12


def test_alignment_never_mirrors(mesh: Disk) -> None:
    """A film and its mirror image stay as unlike as they are."""
    x = twisted(mesh, 0.5)
    left = Shape(x, mesh.triangles, mesh.loop)
    right = replace(left, x=x * [1.0, 1.0, -1.0])
    a, b = aligned([left, right])
    for shape in (a, b):
        assert np.allclose(distances(shape.x), distances(x), atol=1e-12)
    assert np.sign(volume(a)) == np.sign(volume(left))
    assert np.sign(volume(b)) == np.sign(volume(right)) == -np.sign(volume(a))


def distances(x: FloatArray) -> FloatArray:
    gap: FloatArray = np.linalg.norm(x[:, None] - x[None], axis=2)
    return gap


def volume(shape: Shape) -> float:
    """Triple product of three loop chords: changes sign in the mirror."""
    p = shape.x[shape.loop[[0, 5, 17, 29]]]
    return float(np.linalg.det(p[1:] - p[0]))


def test_diagram_is_drawn(tmp_path: Path, rows: list[Row]) -> None:
    rows[4] = replace(rows[4], status=STALLED)
    with RowWriter(tmp_path / "sweep.csv") as table:
        for row in rows:
            table.append(row)
    assert draw_diagram(tmp_path)
    assert read_png(tmp_path / "diagram.png").std() > 0.05


@pytest.mark.slow
def test_diagram_that_fails_is_one_line_in_the_log(
    tmp_path: Path, rows: list[Row], caplog: pytest.LogCaptureFixture
) -> None:
    """Whatever it fails of: a folder that is no run, or an error nobody foresaw."""
    for what in (tmp_path, tmp_path / "none"):
        assert not draw_diagram(what)
    with RowWriter(tmp_path / "sweep.csv") as table:
        table.append(rows[0])
    (tmp_path / "diagram.png").mkdir()
    assert not draw_diagram(tmp_path)

    def fail() -> None:
        raise ZeroDivisionError("first line\nsecond line")

    assert not drawn("picture.png", fail)
    messages = [record.getMessage() for record in caplog.records]
    assert len(messages) == 4
    assert not any("\n" in message for message in messages)
    assert "picture.png" in messages[-1]
    assert "ZeroDivisionError" in messages[-1]


def test_drawing_is_not_kept_from_being_interrupted() -> None:
    def interrupted() -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        drawn("picture.png", interrupted)


@pytest.mark.parametrize("case", ["none", "one", "stalled", "planar", "up and down", "nan"])
def test_every_sweep_has_a_diagram(tmp_path: Path, rows: list[Row], case: str) -> None:
    chosen = {
        "none": [],
        "one": rows[:1],
        "stalled": [replace(row, status=STALLED) for row in rows],
        "planar": rows[:4],
        "up and down": [*rows, *rows[-2::-1]],
        "nan": [replace(row, waist_twist=math.nan, energy=math.inf) for row in rows],
    }[case]
    plot_diagram(Run(tmp_path, tuple(chosen)), tmp_path / "diagram.png")
    assert read_png(tmp_path / "diagram.png").std() > 0.01


@pytest.fixture
def _one_child(monkeypatch: pytest.MonkeyPatch) -> None:
    let_one_child_draw(monkeypatch)


@pytest.mark.usefixtures("_one_child")
def test_render_shows_all_of_each_film_and_both_its_sides(
    tmp_path: Path, mesh: Disk
) -> None:
    """White frame: nothing is cut off. A flat disk shows one side, the eight shows both."""
    turn = rotation()
    films = [twisted(mesh, 0.0), twisted(mesh, 0.4) @ turn, twisted(mesh, 0.99) @ turn.T]
    record(tmp_path, mesh, films)
    assert draw_shapes(tmp_path, [0, 2])
    assert not (tmp_path / "pictures" / "shape_0001.png").exists()
    disk, folded = (
        read_png(tmp_path / "pictures" / f"shape_{step:04d}.png") for step in (0, 2)
    )
    for image in (disk, folded):
        frame = np.concatenate([image[0], image[-1], image[:, 0], image[:, -1]])
        assert (frame == 1.0).all()
        assert part_of(blue(image)) > 0.05
    assert part_of(~blue(disk) & orange(disk)) < 0.001
    assert part_of(orange(folded)) > 0.05


def blue(image: Image) -> NDArray[np.bool_]:
    return image[..., 2] > image[..., 0] + 0.15


def orange(image: Image) -> NDArray[np.bool_]:
    return image[..., 0] > image[..., 2] + 0.15


def part_of(mask: NDArray[np.bool_]) -> float:
    return float(mask.mean())


@pytest.mark.usefixtures("_one_child")
def test_missing_shape_is_reported_not_raised(tmp_path: Path, mesh: Disk) -> None:
    record(tmp_path, mesh, [mesh.x])
    assert not draw_shapes(tmp_path, [7])


@pytest.mark.parametrize(
    ("code", "timeout"),
    [
        ("import ctypes; ctypes.string_at(0)", 60.0),
        ("import os; os.abort()", 60.0),
        ("raise SystemExit(3)", 60.0),
        ("import time; time.sleep(60)", 0.5),
        ("import no_such_module", 60.0),
    ],
)
def test_child_that_dies_costs_only_its_picture(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
    code: str,
    timeout: float,
) -> None:
    (tmp_path / "dying.py").write_text(code)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    with caplog.at_level(logging.WARNING):
        assert not draw_in_child("dying", timeout=timeout)
    assert caplog.records


def test_rendering_no_steps_is_no_failure(tmp_path: Path, mesh: Disk) -> None:
    record(tmp_path, mesh, [mesh.x])
    assert draw_shapes(tmp_path, [])
