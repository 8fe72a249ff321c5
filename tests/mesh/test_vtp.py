"""Surfaces in .vtp files: every bit comes back, and nothing comes of half a file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from eulerplateau.errors import MeshError, OutputError
from eulerplateau.mesh import read_vtp, write_vtp
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.whole_files import whole_file
from tests.helpers.shapes import disk_points, mesh_of


@pytest.fixture(scope="module")
def mesh() -> Disk:
    return mesh_of(*disk_points(4))


def test_surface_line_and_fields_come_back_bit_for_bit(tmp_path: Path, mesh: Disk) -> None:
    draw = np.random.default_rng(1)
    x = mesh.x + 1e-13 * draw.standard_normal(mesh.x.shape)
    points = {
        "scalar": np.where(draw.random(mesh.n_v) < 0.5, np.nan, 1e-300),
        "vector": draw.standard_normal(x.shape),
        "flag": np.arange(mesh.n_v, dtype=np.uint8),
    }
    about = {"load": np.array([0.1 + 0.2]), "step": np.array([7])}
    path = tmp_path / "film.vtp"
    write_vtp(
        path, x, mesh.triangles, loop=mesh.loop, point_fields=points, field_data=about
    )
    found = read_vtp(path)
    assert np.array_equal(found.points, x)
    assert np.array_equal(found.triangles, mesh.triangles)
    (line,) = found.lines
    assert line.tolist() == [*mesh.loop, mesh.loop[0]]
    for written, read in ((points, found.point_fields), (about, found.field_data)):
        assert written.keys() == read.keys()
        for name, values in written.items():
            assert np.array_equal(read[name], values, equal_nan=True)


def test_vtk_reads_every_bit_of_what_is_written(tmp_path: Path, mesh: Disk) -> None:
    """The loop as cell 0, as ParaView shows it; no array is left out."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    draw = np.random.default_rng(2)
    points = {
        "scalar": np.where(draw.random(mesh.n_v) < 0.5, np.nan, 1e-300),
        "vector": draw.standard_normal(mesh.x.shape),
        "flag": np.arange(mesh.n_v, dtype=np.uint8),
    }
    about = {"load": np.array([0.1 + 0.2]), "step": np.array([7]), "none": np.empty((0, 2))}
    path = tmp_path / "film.vtp"
    write_vtp(
        path, mesh.x, mesh.triangles, loop=mesh.loop, point_fields=points, field_data=about
    )
    reader: Any = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    assert reader.GetErrorCode() == 0
    found = reader.GetOutput()
    assert np.array_equal(vtk_to_numpy(found.GetPoints().GetData()), mesh.x)
    lines, polygons = found.GetLines(), found.GetPolys()
    closed = [*mesh.loop, mesh.loop[0]]
    assert vtk_to_numpy(lines.GetConnectivityArray()).tolist() == closed
    assert vtk_to_numpy(lines.GetOffsetsArray()).tolist() == [0, len(closed)]
    corners = vtk_to_numpy(polygons.GetConnectivityArray())
    assert np.array_equal(corners.reshape(-1, 3), mesh.triangles)
    assert (np.diff(vtk_to_numpy(polygons.GetOffsetsArray())) == 3).all()
    for written, read in (
        (points, found.GetPointData()),
        (about, found.GetFieldData()),
    ):
        assert read.GetNumberOfArrays() == len(written)
        for name, values in written.items():
            stored = vtk_to_numpy(read.GetArray(name))
            assert stored.dtype == values.dtype
            assert np.array_equal(stored, values, equal_nan=values.dtype.kind == "f")


def test_surface_alone_has_neither_line_nor_field(tmp_path: Path, mesh: Disk) -> None:
    write_vtp(tmp_path / "film.vtp", mesh.x, mesh.triangles)
    found = read_vtp(tmp_path / "film.vtp")
    assert (found.lines, found.point_fields, found.field_data) == ((), {}, {})


@pytest.mark.parametrize("mode", ["ascii", "raw", "base64"])
def test_other_programs_encodings_are_read(tmp_path: Path, mesh: Disk, mode: str) -> None:
    """ParaView appends raw bytes, which are no text."""
    import pyvista
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    writer: Any = vtkXMLPolyDataWriter()
    writer.SetInputData(pyvista.PolyData.from_regular_faces(mesh.x, mesh.triangles))
    writer.SetFileName(str(tmp_path / "film.vtp"))
    if mode == "ascii":
        writer.SetDataModeToAscii()
    else:
        writer.SetDataModeToAppended()
        writer.SetEncodeAppendedData(mode == "base64")
    writer.Write()
    found = read_vtp(tmp_path / "film.vtp")
    assert np.abs(found.points - mesh.x).max() < 1e-6
    assert np.array_equal(found.triangles, mesh.triangles)


@pytest.mark.parametrize("part", [0.0, 0.1, 0.5, 0.9, 0.99])
def test_part_of_a_file_is_refused_in_silence(
    tmp_path: Path, mesh: Disk, part: float, capfd: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "film.vtp"
    write_vtp(path, mesh.x, mesh.triangles)
    content = path.read_bytes()
    path.write_bytes(content[: int(part * len(content))])
    with pytest.raises(MeshError):
        read_vtp(path)
    assert capfd.readouterr() == ("", "")


def test_file_that_cannot_be_opened_is_named(tmp_path: Path) -> None:
    for path in (tmp_path, tmp_path / "none.vtp"):
        with pytest.raises(OutputError) as caught:
            read_vtp(path)
        assert caught.value.path == path


def test_file_that_fails_half_way_leaves_the_old_one(tmp_path: Path) -> None:
    path = tmp_path / "film.vtp"
    path.write_bytes(b"old")

    def fail() -> None:
        with whole_file(path) as temporary:
            temporary.write_bytes(b"half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fail()
    assert list(tmp_path.iterdir()) == [path]
    assert path.read_bytes() == b"old"
