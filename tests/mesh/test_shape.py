"""Shapes are written to the last bit, and shown where that can be done."""

from __future__ import annotations

import io
import logging
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from eulerplateau.errors import (
    EulerPlateauError,
    MeshError,
    MissingLibraryError,
    OutputError,
    SpecError,
)
from eulerplateau.mesh import Shape, read_vtp
from eulerplateau.mesh.drawing import Picture, picture
from eulerplateau.mesh.files import read_triangles
from tests.helpers.drawing import let_one_child_draw
from tests.helpers.shapes import crumpled, disk_points, mesh_of

PNG = b"\x89PNG\r\n\x1a\n"


@pytest.fixture(scope="module")
def shape() -> Shape:
    disk = mesh_of(*disk_points(4, jitter=0.2))
    return disk.shape.moved(crumpled(disk, 0.02 / 4))


@pytest.mark.parametrize("as_text", [False, True])
def test_vtp_comes_back_bit_for_bit_with_its_loop(
    tmp_path: Path, shape: Shape, as_text: bool
) -> None:
    path = tmp_path / "film.vtp"
    shape.write(str(path) if as_text else path)
    found = read_vtp(path)
    assert np.array_equal(found.points, shape.x)
    assert np.array_equal(found.triangles, shape.triangles)
    (line,) = found.lines
    assert line.tolist() == [*shape.loop, shape.loop[0]]


@pytest.mark.parametrize("suffix", [".vtu", ".vtk", ".msh", ".off", ".obj"])
def test_other_formats_come_back_bit_for_bit(
    tmp_path: Path, shape: Shape, suffix: str
) -> None:
    path = tmp_path / f"film{suffix}"
    shape.write(path)
    points, triangles = read_triangles(path)
    order = np.lexsort(points.T)
    assert np.array_equal(points[order], shape.x[np.lexsort(shape.x.T)])
    assert len(triangles) == len(shape.triangles)


@pytest.mark.parametrize(
    ("name", "kind"), [("film.xyz", MeshError), ("no/film.vtp", OutputError)]
)
def test_a_file_that_cannot_be_written_is_the_projects_own_error(
    tmp_path: Path, shape: Shape, name: str, kind: type[EulerPlateauError]
) -> None:
    with pytest.raises(kind, match="film"):
        shape.write(tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def pixels(png: bytes) -> NDArray[np.float64]:
    """Return the colours (height, width, 3), 0 to 1."""
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB")) / 255.0


def bluish(png: bytes) -> float:
    """Return the part of a picture that shows the front of a film."""
    image = pixels(png)
    return float((image[..., 2] > image[..., 0] + 0.15).mean())


@pytest.mark.slow
def test_notebook_shows_the_front_of_a_film_and_its_loop(shape: Shape) -> None:
    png = shape._repr_png_()
    assert png is not None
    assert png.startswith(PNG)
    assert bluish(png) > 0.1
    dark = pixels(png).max(axis=2) < 0.25
    assert 0.002 < dark.mean() < 0.1


@pytest.fixture
def _one_child(monkeypatch: pytest.MonkeyPatch) -> None:
    """The test before has a child of its own, as users have."""
    let_one_child_draw(monkeypatch)


@pytest.mark.usefixtures("_one_child")
def test_plot_without_a_window_returns_a_picture_with_the_options(
    tmp_path: Path, shape: Shape
) -> None:
    red = shape.plot(window=False, color="red", show_edges=True)
    assert isinstance(red, Picture)
    assert bluish(red.png) == 0.0
    red.write(tmp_path / "film.png")
    assert (tmp_path / "film.png").read_bytes() == red.png == red._repr_png_()


@pytest.mark.usefixtures("_one_child")
def test_options_that_pyvista_does_not_know_are_named(shape: Shape) -> None:
    with pytest.raises(SpecError, match="colourr"):
        shape.plot(window=False, colourr="red")


@pytest.mark.usefixtures("_one_child")
def test_a_film_that_cannot_be_drawn_costs_a_notebook_one_line(
    shape: Shape, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.WARNING):
        assert shape.moved(np.nan * shape.x)._repr_png_() is None
    (record,) = caplog.records
    assert "\n" not in record.getMessage()


@pytest.fixture
def no_driver(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Let the child crash as VTK does without OpenGL; return where it notes its starts."""
    journal = tmp_path / "journal"
    code = f"import ctypes; open({str(journal)!r}, 'a').write('x'); ctypes.string_at(0)"
    (tmp_path / "crashing.py").write_text(code)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.setattr(picture, "_CHILD", "crashing")
    picture._failure_of_drawing.cache_clear()
    yield journal
    picture._failure_of_drawing.cache_clear()


def test_where_drawing_crashes_one_is_told_what_to_install(
    shape: Shape, no_driver: Path, caplog: pytest.LogCaptureFixture
) -> None:
    with pytest.raises(MissingLibraryError, match=r"SIGSEGV.* apt-get install .*libegl1"):
        shape.plot()
    with caplog.at_level(logging.WARNING):
        assert shape._repr_png_() is None
    (record,) = caplog.records
    assert "apt-get install" in record.getMessage()
    assert no_driver.read_text() == "xx"  # the film's child, and one that finds out why


@pytest.mark.parametrize(
    ("display", "notebook", "opens"),
    [(":0", False, True), (":0", True, False), ("", False, False), (None, False, False)],
)
def test_a_window_opens_where_there_is_a_display_and_no_notebook(
    monkeypatch: pytest.MonkeyPatch,
    display: str | None,
    notebook: bool,
    opens: bool,
) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.delitem(sys.modules, "ipykernel", raising=False)
    if notebook:
        monkeypatch.setitem(sys.modules, "ipykernel", picture)
    if display is None:
        monkeypatch.delenv("DISPLAY", raising=False)
    else:
        monkeypatch.setenv("DISPLAY", display)
    assert picture.windows_open() is opens
