"""Mesh files as other programs write them: the same disk comes back, or a line says why."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.errors import MeshError
from eulerplateau.mesh import read_mesh
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.triangles import area_vectors
from tests.helpers import disk_files
from tests.helpers.disk_files import HAND_MADE, POINTS, TRIANGLES
from tests.helpers.marks import quick_with

KNOWN = Disk.from_triangles(POINTS, TRIANGLES)


def first_vertex_first(triangles: np.ndarray) -> set[tuple[int, ...]]:
    turned = (np.roll(t, -int(np.argmin(t))) for t in np.asarray(triangles))
    return {tuple(t.tolist()) for t in turned}


def assert_same(found: Disk, known: Disk = KNOWN, digits: float = 1e-15) -> None:
    """The same places, triangles as sets and loop, whatever their numbers."""
    assert found.n_v == known.n_v
    gap = np.linalg.norm(found.x[:, None] - known.x[None], axis=2)
    number = gap.argmin(axis=1)
    assert sorted(number) == list(range(known.n_v))
    assert gap.min(axis=1).max() <= digits
    assert first_vertex_first(number[found.triangles]) == first_vertex_first(
        known.triangles
    )
    start = int(np.flatnonzero(number[found.loop] == known.loop[0])[0])
    assert (np.roll(number[found.loop], -start) == known.loop).all()
    assert found.length == pytest.approx(known.length, rel=max(digits, 1e-14))


@pytest.mark.parametrize("name", HAND_MADE)
def test_text_of_any_variant_is_the_same_disk(tmp_path, name, caplog):
    (tmp_path / name).write_bytes(HAND_MADE[name])
    assert_same(read_mesh(tmp_path / name))
    assert caplog.messages == []


@pytest.mark.parametrize("grid", [False, True])
@pytest.mark.parametrize("text", [False, True])
@pytest.mark.parametrize("version", [42, 51])
def test_legacy_files_of_vtk_are_the_same_disk(tmp_path, caplog, version, text, grid):
    disk_files.write_vtk(tmp_path / "film.vtk", version, text, grid)
    assert_same(read_mesh(tmp_path / "film.vtk"), digits=1e-6 if text else 1e-15)
    assert caplog.messages == []


@pytest.mark.parametrize("compressor", ["None", "ZLib", "LZ4", "LZMA"])
@pytest.mark.parametrize("mode", ["text", "binary", "base64", "raw"])
@pytest.mark.parametrize("extension", [".vtp", ".vtu"])
def test_xml_files_of_vtk_are_the_same_disk(tmp_path, caplog, extension, mode, compressor):
    path = tmp_path / f"film{extension}"
    disk_files.write_xml(path, mode, compressor, big_endian=compressor == "None")
    assert_same(read_mesh(path), digits=1e-6 if mode == "text" else 1e-15)
    assert caplog.messages == []


@pytest.mark.parametrize("extension", [".ply", ".off", ".vtk", ".vtu", ".obj", ".stl"])
def test_files_of_meshio_are_the_same_disk(tmp_path, extension):
    import meshio

    path = tmp_path / f"film{extension}"
    meshio.Mesh(POINTS, [("triangle", TRIANGLES)]).write(path)
    assert_same(read_mesh(path), digits=1e-6)


@pytest.mark.parametrize("extension", [".ply", ".off", ".obj", ".stl", ".glb"])
def test_files_of_trimesh_are_the_same_disk(tmp_path, extension):
    import trimesh

    path = tmp_path / f"film{extension}"
    trimesh.Trimesh(POINTS, TRIANGLES, process=False).export(path)
    assert_same(read_mesh(path), digits=1e-6)


@pytest.mark.parametrize("extension", [".ply", ".stl", ".obj", ".vtk"])
@pytest.mark.parametrize("binary", [False, True])
def test_files_of_pyvista_are_the_same_disk(tmp_path, extension, binary):
    path = tmp_path / f"film{extension}"
    disk_files.vtk_surface().save(path, binary=binary)
    assert_same(read_mesh(path), digits=1e-6)


@pytest.fixture(scope="module")
def known(tmp_path_factory: pytest.TempPathFactory) -> Disk:
    """What Gmsh makes, in the form that is read anyway, by a child as always."""
    path = tmp_path_factory.mktemp("circle") / "plain.msh"
    disk_files.write_msh(path, 4.1, False)
    return read_mesh(path)


@pytest.fixture
def _here(known: Disk, monkeypatch: pytest.MonkeyPatch) -> None:
    disk_files.let_gmsh_read_here(monkeypatch)


# Gmsh writes version 4.0 as text only.
@pytest.mark.parametrize(
    ("version", "binary"),
    [(2.2, False), (2.2, True), (4.0, False), (4.1, False), (4.1, True)],
)
@pytest.mark.parametrize(
    "variant", quick_with(["", "groups"], ["", "parametric", "partitioned", "groups"])
)
@pytest.mark.usefixtures("_here")
def test_gmshs_files_of_any_version_are_the_same_disk(
    tmp_path, known, variant, version, binary
):
    disk_files.write_msh(tmp_path / "film.msh", version, binary, variant=variant)
    assert_same(read_mesh(tmp_path / "film.msh"), known, 1e-15)
    radius = np.linalg.norm(known.x[known.loop], axis=1) * known.length
    np.testing.assert_allclose(radius, 1, rtol=1e-10)


@pytest.mark.parametrize("order", [2, 3])
@pytest.mark.parametrize("version", [2.2, 4.1])
@pytest.mark.usefixtures("_here")
def test_triangles_of_higher_order_are_taken_by_their_corners(
    tmp_path, caplog, known, version, order
):
    disk_files.write_msh(tmp_path / "film.msh", version, True, order)
    assert_same(read_mesh(tmp_path / "film.msh"), known)
    (said,) = caplog.messages
    assert "second-order" in said


def test_second_order_triangles_of_vtk_are_taken_by_their_corners(tmp_path, caplog):
    import meshio

    middle = POINTS[TRIANGLES] + np.roll(POINTS[TRIANGLES], -1, axis=1)
    points = np.concatenate([POINTS, middle.reshape(-1, 3) / 2])
    sides = len(POINTS) + np.arange(3 * len(TRIANGLES)).reshape(-1, 3)
    cells = [("triangle6", np.hstack([TRIANGLES, sides]))]
    for extension in (".vtk", ".vtu"):
        meshio.Mesh(points, cells).write(tmp_path / f"film{extension}")
        assert_same(read_mesh(tmp_path / f"film{extension}"))
    assert len(caplog.messages) == 2
    assert all("second-order" in said for said in caplog.messages)


def test_quadrangles_of_gmsh_are_split_with_a_line(tmp_path, caplog):
    disk_files.write_msh(tmp_path / "film.msh", 4.1, False, variant="quads")
    found = read_mesh(tmp_path / "film.msh")
    areas = np.linalg.norm(area_vectors(found.triangles, found.x), axis=1)
    disk = Disk.from_triangles(*_fan(found.x[found.loop]))
    flat = np.linalg.norm(area_vectors(disk.triangles, disk.x), axis=1)
    assert areas.sum() == pytest.approx(flat.sum(), rel=1e-12)
    (said,) = caplog.messages
    assert "split along the shorter diagonal" in said


def _fan(loop: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A flat polygon as triangles from its middle."""
    n = len(loop)
    around = np.arange(n)
    triangles = np.stack([np.full(n, n), around, (around + 1) % n], axis=1)
    return np.vstack([loop, loop.mean(axis=0)]), triangles


SQUARE = "0 0 0\n2 0 0\n2 1 0\n0 1 0\n"
GRIDS = {
    "quad.off": f"OFF\n4 1 0\n{SQUARE}4 0 1 2 3\n",
    "quad.obj": "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 3 4\n",
    "quad.ply": "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
    "property float y\nproperty float z\nelement face 1\n"
    f"property list uchar int vertex_index\nend_header\n{SQUARE}4 0 1 2 3\n",
    "quad.vtk": "# vtk DataFile Version 3.0\nq\nASCII\nDATASET POLYDATA\n"
    f"POINTS 4 float\n{SQUARE}POLYGONS 1 5\n4 0 1 2 3\n",
    "pixel.vtk": "# vtk DataFile Version 3.0\nq\nASCII\nDATASET UNSTRUCTURED_GRID\n"
    f"POINTS 4 float\n{SQUARE}CELLS 1 5\n4 0 1 3 2\nCELL_TYPES 1\n8\n",
}


@pytest.mark.parametrize("name", GRIDS)
def test_quadrangles_of_any_format_are_split_with_a_line(tmp_path, caplog, name):
    (tmp_path / name).write_text(GRIDS[name])
    found = read_mesh(tmp_path / name)
    assert (found.n_v, len(found.triangles), found.length) == (4, 2, 6.0)
    (said,) = caplog.messages
    assert "1 polygon" in said


def test_strips_are_triangles(tmp_path, caplog):
    before = "POLYGONS 1 5\n4 0 1 2 3"
    text = GRIDS["quad.vtk"].replace(before, "TRIANGLE_STRIPS 1 5\n4 0 1 3 2")
    (tmp_path / "strip.vtk").write_text(text)
    found = read_mesh(tmp_path / "strip.vtk")
    assert first_vertex_first(found.triangles) == {(0, 1, 3), (1, 2, 3)}
    assert caplog.messages == []


OTHERS = {
    "solid.vtk": ("# vtk DataFile Version 3.0\nq\nASCII\nDATASET UNSTRUCTURED_GRID\n"
    f"POINTS 4 float\n{SQUARE}CELLS 1 5\n4 0 1 3 2\nCELL_TYPES 1\n10\n", "tetrahedra"),
    "image.vtk": ("# vtk DataFile Version 3.0\nq\nASCII\nDATASET STRUCTURED_POINTS\n"
    "DIMENSIONS 2 2 1\n", "holds a STRUCTURED_POINTS"),
    "image.vtp": ('<VTKFile type="ImageData"><ImageData/></VTKFile>', "holds a ImageData"),
    "points.off": (f"OFF\n4 0 0\n{SQUARE}", "holds no triangles, but 4 points"),
    "four.off": ("4OFF\n1 0 0\n0 0 0 1\n", "not of three dimensions"),
    "stl.ply": ("solid a\nendsolid\n", "is no .ply file"),
    "ply.stl": ("ply\nformat ascii 1.0\n" + "comment\n" * 10, "is no .stl file"),
    "script.msh": ("Point(1) = {0, 0, 0};\n", "is no .msh file"),
    "volume.obj": ("# nothing\n", "is no .obj file"),
}  # fmt: skip


@pytest.mark.parametrize("name", OTHERS)
def test_files_of_something_else_are_told_what_they_hold(tmp_path, name):
    text, expected = OTHERS[name]
    (tmp_path / name).write_text(text)
    with pytest.raises(MeshError) as caught:
        read_mesh(tmp_path / name)
    assert expected in str(caught.value)
    assert "not a whole" not in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_script_called_msh_is_not_carried_out(tmp_path):
    target = tmp_path / "made"
    for name in ("film.msh", "film.msh.opt"):
        (tmp_path / name).write_text(f'SystemCall "touch {target}";\n')
    with pytest.raises(MeshError):
        read_mesh(tmp_path / "film.msh")
    disk_files.write_msh(tmp_path / "film.msh", 4.1, False)
    read_mesh(tmp_path / "film.msh")
    assert not target.exists()


def test_gmsh_s_solid_elements_are_named(tmp_path):
    import meshio

    points = np.vstack([np.zeros(3), np.eye(3)])
    mesh = meshio.Mesh(points, [("tetra", [[0, 1, 2, 3]])])
    mesh.write(tmp_path / "film.msh", file_format="gmsh")
    with pytest.raises(MeshError, match="holds tetrahedron"):
        read_mesh(tmp_path / "film.msh")
