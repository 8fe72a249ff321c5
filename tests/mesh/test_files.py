"""Mesh files: what is written comes back, what is broken is refused."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from eulerplateau.errors import MeshError, OutputError, SpecError
from eulerplateau.mesh import read_disk, read_mesh, write_mesh
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.files import read_triangles
from tests.helpers.disk_files import let_gmsh_read_here
from tests.helpers.shapes import hexagon_points

MESHES = Path(__file__).parents[2] / "meshes"
EXACT = (".vtp", ".vtu", ".vtk", ".msh", ".off", ".obj", ".ply")
SINGLE = (".stl", ".glb")
ALL = EXACT + SINGLE


def saddle(unit=1.0):
    plane, triangles = hexagon_points(5)
    x, y = plane.T
    points = np.stack([x, y, 0.3 * x * y], axis=1) * unit
    return Disk.from_triangles(points, triangles)


def by_position(mesh):
    """Vertices in an order that does not depend on their numbers."""
    return mesh.x[np.lexsort(mesh.x.round(5).T)]


@pytest.fixture
def _here(monkeypatch):
    let_gmsh_read_here(monkeypatch)


@pytest.mark.parametrize("unit", [1.0, 1e-9, 1e9])
@pytest.mark.parametrize("extension", EXACT)
@pytest.mark.usefixtures("_here")
def test_a_round_trip_keeps_every_bit(tmp_path, extension, unit):
    mesh = saddle(unit)
    path = tmp_path / f"film{extension}"
    write_mesh(mesh, path)
    points, triangles = read_triangles(path)
    assert (points == mesh.x * mesh.length).all()
    assert (triangles == mesh.triangles).all()
    again = read_mesh(path)
    np.testing.assert_allclose(again.x, mesh.x, rtol=0, atol=1e-15)
    assert again.length == pytest.approx(mesh.length, rel=1e-14)
    assert (again.loop == mesh.loop).all()


@pytest.mark.parametrize("unit", [1.0, 1e-9, 1e9])
@pytest.mark.parametrize("extension", SINGLE)
def test_a_round_trip_keeps_single_precision(tmp_path, extension, unit):
    mesh = saddle(unit)
    path = tmp_path / f"film{extension}"
    write_mesh(mesh, path)
    again = read_mesh(path)
    assert (again.n_v, again.n_b) == (mesh.n_v, mesh.n_b)
    assert again.length == pytest.approx(mesh.length, rel=1e-6)
    np.testing.assert_allclose(by_position(again), by_position(mesh), atol=1e-6)


@pytest.mark.parametrize("extension", ALL)
def test_an_upper_case_extension_is_the_same_format(tmp_path, extension):
    lower, upper = tmp_path / f"film{extension}", tmp_path / f"FILM{extension.upper()}"
    write_mesh(saddle(), lower)
    upper.write_bytes(lower.read_bytes())
    assert read_mesh(upper).digest == read_mesh(lower).digest


# A .obj file does not say how many triangles it holds: without the last it is whole.
@pytest.mark.parametrize(
    ("extension", "share"),
    [
        (extension, share)
        for extension in ALL
        for share in (0.0, 0.02, 0.25, 0.5, 0.75, 0.95)
        if not (extension == ".obj" and share > 0.75)
    ],
)
def test_a_truncated_file_is_refused_in_silence(tmp_path, capfd, extension, share):
    path = tmp_path / f"film{extension}"
    write_mesh(saddle(), path)
    content = path.read_bytes()
    path.write_bytes(content[: int(share * len(content))])
    with pytest.raises(MeshError) as caught:
        read_mesh(path)
    assert caught.value.exit_code == 3
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("extension", ALL)
def test_a_file_of_something_else_is_refused(tmp_path, capfd, extension):
    path = tmp_path / f"film{extension}"
    for content in (b"no mesh\n" * 20, bytes(500), bytes(range(256)) * 4):
        path.write_bytes(content)
        with pytest.raises(MeshError):
            read_mesh(path)
    assert capfd.readouterr() == ("", "")


OFF = "OFF\n{} {} 0\n{}"
VTP_QUAD = """<VTKFile type="PolyData" version="0.1"><PolyData>
<Piece NumberOfPoints="4" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0"
 NumberOfPolys="1"><Points>
<DataArray type="Float64" NumberOfComponents="3" format="ascii">
0 0 0 1 0 0 1 1 0 0 1 0</DataArray></Points><Polys>
<DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">4</DataArray>
</Polys></Piece></PolyData></VTKFile>"""


FAN = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n.5 .5 0\n"


def test_a_vertex_number_out_of_range_names_its_triangle(tmp_path):
    path = tmp_path / "film.off"
    path.write_text(OFF.format(5, 4, FAN + "3 0 1 4\n3 1 2 4\n3 2 3 9\n3 3 0 4\n"))
    with pytest.raises(MeshError) as caught:
        read_mesh(path)
    assert (caught.value.kind, caught.value.index) == ("triangle", 2)


def test_a_vtp_index_out_of_range_is_refused(tmp_path):
    path = tmp_path / "film.vtp"
    triangle = VTP_QUAD.replace("0 1 2 3<", "0 1 9<").replace(">4<", ">3<")
    path.write_text(triangle)
    with pytest.raises(MeshError) as caught:
        read_mesh(path)
    assert (caught.value.kind, caught.value.index) == ("triangle", 0)


def test_stray_vertices_are_dropped_and_culprits_keep_the_files_numbers(tmp_path):
    path = tmp_path / "film.off"
    stray = "9 9 9\n" + FAN
    path.write_text(OFF.format(6, 4, stray + "3 1 2 5\n3 2 3 5\n3 3 4 5\n3 4 1 5\n"))
    mesh = read_mesh(path)
    assert (mesh.n_v, mesh.loop.tolist()) == (5, [0, 1, 2, 3])
    faces = "3 1 2 5\n3 2 3 5\n3 3 4 5\n3 4 1 5\n3 2 4 5\n"
    path.write_text(OFF.format(6, 5, stray + faces))
    with pytest.raises(MeshError) as caught:
        read_mesh(path)
    assert (caught.value.kind, caught.value.index) == ("edge", (2, 5))
    path.write_text(
        OFF.format(
            6, 4, stray.replace(".5", "nan") + "3 1 2 5\n3 2 3 5\n3 3 4 5\n3 4 1 5\n"
        )
    )
    with pytest.raises(MeshError) as caught:
        read_mesh(path)
    assert (caught.value.kind, caught.value.index) == ("vertex", 5)


@pytest.mark.parametrize("version", [2.2, 4.1])
@pytest.mark.parametrize("binary", [0, 1])
@pytest.mark.usefixtures("_here")
def test_gmshs_own_files_are_read(tmp_path, version, binary):
    import gmsh

    path = tmp_path / "disk.msh"
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.option.setNumber("Mesh.Binary", binary)
        shape = gmsh.model.geo
        centre, east, west = (shape.addPoint(x, 0, 0, 0.2) for x in (0, 1, -1))
        arcs = [
            shape.addCircleArc(*ends)
            for ends in ((east, centre, west), (west, centre, east))
        ]
        shape.addPlaneSurface([shape.addCurveLoop(arcs)])
        shape.synchronize()
        gmsh.model.mesh.generate(2)
        gmsh.write(str(path))
    finally:
        gmsh.finalize()
    points, _ = read_triangles(path)
    mesh = read_mesh(path)
    assert mesh.n_v == len(points) - 1  # the centre of the arcs is no vertex of the film
    radius = np.linalg.norm(mesh.x[mesh.loop], axis=1) * mesh.length
    np.testing.assert_allclose(radius, 1, rtol=1e-10)


def test_single_precision_files_are_read_as_double(tmp_path):
    import meshio

    mesh = saddle()
    path = tmp_path / "film.vtu"
    meshio.Mesh(mesh.x.astype(np.float32), [("triangle", mesh.triangles)]).write(path)
    again = read_mesh(path)
    assert again.x.dtype == np.float64
    np.testing.assert_allclose(again.x, mesh.x, atol=1e-7)


def test_a_missing_file_is_a_wrong_specification(tmp_path):
    for name in ("none.vtp", "none.stl", "none.toml", "none.xyz"):
        with pytest.raises(SpecError) as caught:
            read_disk(tmp_path / name)
        assert caught.value.key == str(tmp_path / name)


def test_an_unknown_extension_is_refused(tmp_path):
    path = tmp_path / "film.xyz"
    path.write_text("0 0 0")
    with pytest.raises(MeshError):
        read_mesh(path)
    with pytest.raises(MeshError):
        write_mesh(saddle(), path)


def test_a_folder_cannot_be_read(tmp_path):
    (tmp_path / "film.vtp").mkdir()
    with pytest.raises(OutputError) as caught:
        read_mesh(tmp_path / "film.vtp")
    assert caught.value.exit_code == 5


@pytest.mark.parametrize("extension", ALL)
def test_where_nothing_can_be_written_the_path_is_named(tmp_path, capfd, extension):
    path = tmp_path / "none" / f"film{extension}"
    with pytest.raises(OutputError) as caught:
        write_mesh(saddle(), path)
    assert caught.value.path == path
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("extension", ALL)
def test_a_failed_write_leaves_the_old_file_and_no_other(tmp_path, monkeypatch, extension):
    path = tmp_path / f"film{extension}"
    path.write_bytes(b"old")

    def refuse(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", refuse)
    with pytest.raises(OutputError):
        write_mesh(saddle(), path)
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_reading_a_stored_mesh_loads_no_mesher_and_no_graphics():
    code = (
        "import sys; from eulerplateau.mesh import read_disk;"
        f"read_disk({str(MESHES / 'elongated.vtp')!r});"
        "sys.exit(bool({'gmsh', 'meshio', 'trimesh', 'pyvista', 'matplotlib'}"
        " & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


@pytest.mark.parametrize("name", ["hexagon", "elongated"])
def test_the_stored_meshes_are_what_their_specs_give(name):
    mesh = read_disk(MESHES / f"{name}.toml")
    points, triangles = read_triangles(MESHES / f"{name}.vtp")
    assert (triangles == mesh.triangles).all()
    assert (points == mesh.x * mesh.length).all()
