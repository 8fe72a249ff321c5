"""The table, the shapes and the series: exact, and honest when the disk is not."""

from __future__ import annotations

import math
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import OutputError
from eulerplateau.film.load import SPRING_LOAD
from eulerplateau.mesh import read_vtp
from eulerplateau.mesh.curvature import angle_defects, loop_frame
from eulerplateau.mesh.disk import Disk
from eulerplateau.runs.folder import RunFolder
from eulerplateau.runs.rows import COLUMNS, Row
from eulerplateau.runs.series_file import Listed, write_shapes
from eulerplateau.runs.shape_files import read_shape, write_shape
from eulerplateau.runs.table import RowWriter, read_rows
from eulerplateau.solvers.equilibrium import Status
from tests.helpers.shapes import disk_points, eight, mesh_of

ROW = Row(
    step=0,
    kL3_alpha=0.1 + 0.2,
    sigma_hat=2.0 * math.sqrt(3.0) * 0.3,
    energy=1e22,
    film_energy=5e-324,
    bending_energy=-0.0,
    abs_kappa_n=1.0 / 3.0,
    total_gauss_curvature=-math.pi,
    area=0.07,
    n_unstable=None,
    lowest_eigenvalue=None,
    residual=1e-7,
    length_error=2e-9,
    iterations=12345678901,
    seconds=0.25,
    status=Status.CONVERGED,
    max_turning=7.5,
    waist_twist=90.0,
    self_intersections=0,
    aspect=0.56,
    min_angle=21.5,
    film_residual=3e-15,
)


@pytest.fixture(scope="module")
def mesh() -> Disk:
    return mesh_of(*disk_points(6))


def twisted(mesh: Disk, t: float) -> FloatArray:
    """The film of eq. eight on `mesh`, its size left alone."""
    return eight(mesh.x[:, :2] / np.hypot(*mesh.x.T[:2]).max(), t)


def test_columns_are_those_users_were_promised() -> None:
    promised = (
        "step kL3_alpha sigma_hat energy film_energy bending_energy abs_kappa_n "
        "total_gauss_curvature area n_unstable lowest_eigenvalue residual length_error "
        "iterations seconds status max_turning waist_twist self_intersections aspect "
        "min_angle film_residual"
    )
    assert list(COLUMNS) == promised.split()


@pytest.mark.parametrize("status", Status)
def test_rows_read_back_bit_for_bit(tmp_path: Path, status: Status) -> None:
    rows = [
        replace(ROW, status=status),
        replace(ROW, n_unstable=2, lowest_eigenvalue=-1e-3, energy=math.inf),
        replace(ROW, self_intersections=None, energy=np.float64(0.1)),
    ]
    with RowWriter(tmp_path / "sweep.csv") as table:
        for row in rows:
            table.append(row)
    read = read_rows(tmp_path / "sweep.csv")
    assert read == rows
    assert math.copysign(1.0, read[0].bending_energy) == -1.0


def test_nan_and_not_computed_stay_apart(tmp_path: Path) -> None:
    with RowWriter(tmp_path / "sweep.csv") as table:
        table.append(replace(ROW, waist_twist=math.nan, lowest_eigenvalue=math.nan))
    (row,) = read_rows(tmp_path / "sweep.csv")
    assert math.isnan(row.waist_twist)
    assert row.lowest_eigenvalue is not None
    assert math.isnan(row.lowest_eigenvalue)
    assert row.n_unstable is None


def test_rows_are_on_disk_as_soon_as_appended(tmp_path: Path) -> None:
    with RowWriter(tmp_path / "sweep.csv") as table:
        for step in range(3):
            assert len(read_rows(tmp_path / "sweep.csv")) == step
            table.append(replace(ROW, step=step))
            assert read_rows(tmp_path / "sweep.csv")[-1].step == step


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"a,b\n1,2\n",
        (",".join(COLUMNS) + "\n1,2\n").encode(),
        (",".join(COLUMNS) + "\n" + ",".join("x" * len(COLUMNS)) + "\n").encode(),
        b"\xff\xfe",
    ],
)
def test_a_table_that_is_not_ours_is_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "sweep.csv"
    path.write_bytes(content)
    with pytest.raises(OutputError) as caught:
        read_rows(path)
    assert caught.value.path == path


def test_shape_reads_back_bit_for_bit(tmp_path: Path, mesh: Disk) -> None:
    x = twisted(mesh, 0.4) + 1e-13
    path = tmp_path / "shape.vtp"
    write_shape(path, mesh, x, replace(ROW, step=3, energy=1.0 / 3.0))
    shape = read_shape(path)
    assert np.array_equal(shape.x, x)
    assert np.array_equal(shape.triangles, mesh.triangles)
    assert np.array_equal(shape.loop, mesh.loop)
    about = read_vtp(path).field_data
    told = [about[name][0] for name in ("step", "kL3_alpha", "energy")]
    assert told == [3, 0.1 + 0.2, 1.0 / 3.0]


def test_pyvista_finds_every_field_where_it_belongs(tmp_path: Path, mesh: Disk) -> None:
    import pyvista

    x = twisted(mesh, 0.4)
    mode = np.random.default_rng(1).standard_normal(x.shape)
    path = tmp_path / "shape.vtp"
    row = replace(ROW, step=3, kL3_alpha=700.0, sigma_hat=2424.0, energy=50.0)
    write_shape(path, mesh, x, row, modes={"mode_0": mode})
    film = pyvista.read(path)
    frame = loop_frame(mesh, x)
    for name in ("kappa", "kappa_n", "kappa_g", "contact_angle", "tangent", "normal"):
        values = film.point_data[name]
        assert np.array_equal(values[mesh.loop], getattr(frame, name))
        assert np.isnan(values[mesh.interior]).all()
    defects = film.point_data["angle_defect"]
    assert np.array_equal(defects[mesh.interior], angle_defects(mesh, x)[mesh.interior])
    assert np.isnan(defects[mesh.loop]).all()
    assert set(np.flatnonzero(film.point_data["on_loop"])) == set(mesh.loop)
    assert np.array_equal(film.point_data["mode_0"], mode)
    assert film.field_data["kL3_alpha"][0] == 700.0
    assert film.field_data["sigma_hat"][0] == 2424.0
    assert film.field_data["energy"][0] == 50.0
    assert film.field_data["step"][0] == 3
    assert np.array_equal(film.lines, [mesh.n_b + 1, *mesh.loop, mesh.loop[0]])
    assert np.array_equal(film.regular_faces, mesh.triangles)


@pytest.mark.parametrize("part", [0.0, 0.3, 0.6, 0.95])
def test_part_of_a_shape_is_refused(tmp_path: Path, mesh: Disk, part: float) -> None:
    path = tmp_path / "shape.vtp"
    write_shape(path, mesh, mesh.x, ROW)
    content = path.read_bytes()
    path.write_bytes(content[: int(part * len(content))])
    with pytest.raises(OutputError):
        read_shape(path)


@pytest.mark.parametrize(
    ("loads", "times"),
    [
        ([1.0, 10.0, 100.0], [1.0, 10.0, 100.0]),
        ([100.0, 10.0, 1.0], [1.0, 10.0, 100.0]),
        ([1.0, 10.0, 1.0], [0, 1, 2]),
        ([1.0, 10.0, 10.0], [0, 1, 2]),
        ([5.0], [5.0]),
    ],
)
def test_series_has_rising_distinct_times(
    tmp_path: Path, loads: list[float], times: list[float]
) -> None:
    entries = [Listed.of(tmp_path, i, load) for i, load in enumerate(loads)]
    write_shapes(tmp_path / "sweep.pvd", entries, SPRING_LOAD.text)
    found = ElementTree.parse(tmp_path / "sweep.pvd").getroot().findall(".//DataSet")
    assert [float(entry.attrib["timestep"]) for entry in found] == times
    load_of = {entry.files[0]: entry.load for entry in entries}
    shown = [load_of[entry.attrib["file"]] for entry in found]
    assert shown == (times if isinstance(times[0], float) else loads)


def test_row_that_does_not_fit_is_taken_back(tmp_path: Path) -> None:
    script = """
import resource, sys
from pathlib import Path
sys.path.insert(0, {tests!r})
from tests.runs.test_output import ROW, RowWriter
from eulerplateau.errors import OutputError

path = Path({path!r})
with RowWriter(path) as table:
    table.append(ROW)
    room = path.stat().st_size + 20
    resource.setrlimit(resource.RLIMIT_FSIZE, (room, room))
    try:
        table.append(ROW)
    except OutputError as error:
        sys.exit(error.exit_code)
"""
    path = tmp_path / "sweep.csv"
    script = script.format(tests=str(Path(__file__).parents[2]), path=str(path))
    done = subprocess.run([sys.executable, "-c", script], check=False)
    assert done.returncode == 5
    assert read_rows(path) == [ROW]


def test_full_device_is_an_output_error() -> None:
    with pytest.raises(OutputError) as caught:
        RowWriter(Path("/dev/full"))
    assert caught.value.exit_code == 5


def test_path_below_a_file_is_an_output_error(tmp_path: Path, mesh: Disk) -> None:
    (tmp_path / "file").write_text("not a folder")
    below = tmp_path / "file" / "run"
    for path in (below, tmp_path / "file"):
        with pytest.raises(OutputError):
            RunFolder.create(path, {})
    with pytest.raises(OutputError):
        RowWriter(below)
    with pytest.raises(OutputError):
        write_shape(below, mesh, mesh.x, ROW)
    with pytest.raises(OutputError):
        read_shape(below)
    with pytest.raises(OutputError):
        read_rows(below)


def test_records_need_no_picture_library() -> None:
    names = "runs.folder", "pictures.sweep_diagram", "pictures.render.drawing"
    modules = ", ".join(f"eulerplateau.{name}" for name in names)
    script = (
        f"import sys, {modules}; "
        "heavy = {'pyvista', 'matplotlib', 'gmsh', 'trimesh', 'meshio', 'vtkmodules'}; "
        "sys.exit(len(heavy & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", script], check=False)
    assert done.returncode == 0
