"""Files that are not whole, or promise what they do not hold: a line, and no memory."""

from __future__ import annotations

import re
import resource
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings, strategies as st

from eulerplateau.errors import MeshError
from eulerplateau.mesh import read_mesh
from eulerplateau.mesh.disk import Disk
from tests.helpers import disk_files
from tests.helpers.disk_files import HAND_MADE, POINTS
from tests.helpers.marks import quick_with

TWELVE = "1000000000000"
# A number that counts something, in each format.
COUNTS = {
    "plain.off": (b"OFF\n37 ", b"OFF\n%s "),
    "indices.ply": (b"element vertex 37", b"element vertex %s"),
    "little.ply": (b"element vertex 37", b"element vertex %s"),
    "edges.ply": (b"element edge 2", b"element edge %s"),
    "polygons.vtk": (b"POINTS 37", b"POINTS %s"),
    "grid.vtk": (b"CELL_TYPES 54", b"CELL_TYPES %s"),
    "field.vtk": (b"POLYGONS 54 216", b"POLYGONS 54 %s"),
}
FAST = settings(
    deadline=None,
    max_examples=20,
    derandomize=True,
    database=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)


@pytest.fixture(autouse=True)
def little_memory():
    """Files of a few kB: what they promise may not be asked for."""
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    yield
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss < before + 500_000


def refusal(path: Path) -> str:
    with pytest.raises(MeshError) as caught:
        read_mesh(path)
    said = str(caught.value)
    assert "\n" not in said
    return said


@pytest.mark.parametrize("name", COUNTS)
def test_more_than_a_file_holds_is_refused_before_memory_is_taken(tmp_path, name):
    whole, more = COUNTS[name]
    assert whole in HAND_MADE[name]
    (tmp_path / name).write_bytes(HAND_MADE[name].replace(whole, more % TWELVE.encode()))
    assert f"is not a whole {(tmp_path / name).suffix} file" in refusal(tmp_path / name)


@pytest.mark.parametrize("name", ["text", "binary", "base64", "raw"])
@pytest.mark.parametrize("what", ["Points", "Polys"])
def test_a_vtp_that_promises_a_million_millions_is_refused(tmp_path, name, what):
    path = tmp_path / "film.vtp"
    disk_files.write_xml(path, name, "ZLib")
    promised = re.sub(rb'(NumberOf%s)="\d+"' % what.encode(), rb'\1="%s"' % TWELVE.encode(),
        path.read_bytes())  # fmt: skip
    path.write_bytes(promised)
    assert f"promises {TWELVE}" in refusal(path)


@pytest.mark.parametrize("version", [2.2, 4.1])
@pytest.mark.parametrize("section", ["Nodes", "Elements"])
def test_a_msh_that_promises_a_million_millions_is_refused(tmp_path, version, section):
    path = tmp_path / "film.msh"
    disk_files.write_msh(path, version, False)
    before = r"\d+ " if version > 4 else ""
    pattern = rf"(\${section}\n{before})\d+"
    path.write_text(re.sub(pattern, rf"\g<1>{TWELVE}", path.read_text()))
    assert f"promises {TWELVE} {section.lower()}" in refusal(path)


def test_fewer_types_than_cells_are_not_a_smaller_disk(tmp_path):
    text = HAND_MADE["grid.vtk"].replace(b"5\nPOINT_DATA", b"POINT_DATA")
    (tmp_path / "film.vtk").write_bytes(text)
    refusal(tmp_path / "film.vtk")
    (tmp_path / "film.vtk").write_bytes(text.replace(b"TYPES 54", b"TYPES 53"))
    assert "promises 54 cells and has the types of 53" in refusal(tmp_path / "film.vtk")


@pytest.mark.parametrize("name", ["plain.off", "indices.ply", "little.ply"])
def test_more_than_its_counts_is_not_a_smaller_disk(tmp_path, name):
    fewer = HAND_MADE[name].replace(b"37 54 0", b"37 53 0").replace(b"face 54", b"face 53")
    (tmp_path / name).write_bytes(fewer)
    refusal(tmp_path / name)


# Of each kind of file one for the quick tests.
FEW = ["plain.off", "indices.ply", "little.ply", "plain.obj", "text.stl", "grid.vtk"]
CUT = [name for name in HAND_MADE if not name.endswith(".obj")]


@pytest.mark.parametrize("name", quick_with(FEW, CUT))
@FAST
@given(share=st.floats(0, 1, exclude_max=True))
def test_a_cut_file_is_refused_or_the_whole_disk(tmp_path, name, share):
    path = tmp_path / name
    content = HAND_MADE[name]
    path.write_bytes(content[: int(share * len(content))])
    assert_refused_or_whole(path)


@pytest.mark.parametrize("name", [name for name in HAND_MADE if name.endswith(".obj")])
@FAST
@given(share=st.floats(0, 1, exclude_max=True))
def test_a_cut_obj_says_which_vertices_it_does_not_use(tmp_path, caplog, name, share):
    path = tmp_path / name
    content = HAND_MADE[name]
    path.write_bytes(content[: int(share * len(content))])
    caplog.clear()
    found = disk_or_line(path)
    # Not whole, and nothing in it says so: but what it leaves unused is said.
    whole = isinstance(found, str) or found.n_v == len(POINTS)
    assert whole or "no triangle uses" in caplog.text


@pytest.mark.parametrize("name", quick_with(FEW, HAND_MADE))
@FAST
@given(data=st.data())
def test_a_damaged_file_raises_nothing_else(tmp_path, name, data):
    content = bytearray(HAND_MADE[name])
    for _ in range(data.draw(st.integers(1, 4))):
        place = data.draw(st.integers(0, len(content) - 1))
        content[place] = data.draw(st.integers(0, 255))
    (tmp_path / name).write_bytes(content)
    assert "\n" not in str(disk_or_line(tmp_path / name))


@pytest.mark.parametrize("extension", [".vtp", ".vtu"])
@pytest.mark.parametrize("mode", ["text", "binary", "raw"])
@FAST
@given(data=st.data())
def test_a_damaged_xml_file_raises_nothing_else(tmp_path, mode, extension, data):
    path = tmp_path / f"film{extension}"
    if not path.exists():
        disk_files.write_xml(path, mode, "ZLib")
    content = bytearray(path.read_bytes())
    for _ in range(data.draw(st.integers(1, 4))):
        place = data.draw(st.integers(0, len(content) - 1))
        content[place] = data.draw(st.integers(0, 255))
    damaged = path.with_name(f"damaged{extension}")
    damaged.write_bytes(content[: data.draw(st.integers(0, len(content)))])
    assert "\n" not in str(disk_or_line(damaged))


@pytest.mark.parametrize("share", [0.01, 0.3, 0.5, 0.7, 0.9, 0.97, 0.999])
@pytest.mark.parametrize("binary", [False, True])
def test_a_cut_msh_is_refused(tmp_path, binary, share):
    path = tmp_path / "film.msh"
    disk_files.write_msh(path, 4.1, binary)
    content = path.read_bytes()
    path.write_bytes(content[: int(share * (len(content) - 14))])
    assert "is not a whole .msh file" in refusal(path) or share < 0.1


@pytest.mark.parametrize("version", quick_with([2.2, 4.1], [2.2, 4.0, 4.1]))
@pytest.mark.parametrize("seed", quick_with([1], range(3)))
def test_a_damaged_msh_costs_no_more_than_a_line(tmp_path, version, seed):
    import random

    path = tmp_path / "film.msh"
    disk_files.write_msh(path, version, seed > 0 and version != 4.0)
    draw = random.Random(seed)
    content = bytearray(path.read_bytes())
    for _ in range(8):
        content[draw.randrange(60, len(content))] = draw.randrange(256)
    path.write_bytes(content)
    assert "\n" not in str(disk_or_line(path))


def assert_refused_or_whole(path: Path) -> None:
    found = disk_or_line(path)
    if isinstance(found, str):
        assert "\n" not in found
    else:
        assert (found.n_v, len(found.triangles)) == (len(POINTS), 54)


def disk_or_line(path: Path) -> Disk | str:
    try:
        return read_mesh(path)
    except MeshError as error:
        return str(error)


def test_a_name_without_end_ends_in_the_message(tmp_path):
    path = tmp_path / "disk.ply"
    header = (
        f"ply\nformat ascii 1.0\nelement {'x' * 5000} 3\nproperty float x\nend_header\n"
    )
    path.write_text(header + "0\n")
    with pytest.raises(MeshError, match="not a whole") as caught:
        read_mesh(path)
    assert len(str(caught.value)) < 300 + len(str(path))
