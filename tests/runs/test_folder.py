"""The run folder: valid at every moment, whatever ends the run."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest

from eulerplateau.errors import OutputError
from eulerplateau.mesh import read_vtp
from eulerplateau.mesh.disk import Disk
from eulerplateau.runs.folder import RunFolder
from eulerplateau.runs.series_file import loop_name, shape_name
from eulerplateau.runs.shape_files import read_shape
from eulerplateau.runs.table import read_rows
from tests.helpers.shapes import disk_points, mesh_of
from tests.runs.test_output import ROW, twisted


@pytest.fixture(scope="module")
def mesh() -> Disk:
    return mesh_of(*disk_points(6))


def start(path: Path) -> RunFolder:
    return RunFolder.create(path, {"status": "running"})


def test_everything_is_valid_after_every_step(tmp_path: Path, mesh: Disk) -> None:
    with start(tmp_path / "run") as folder:
        for step in range(4):
            row = replace(ROW, step=step, kL3_alpha=100.0 * step)
            folder.record(row, mesh, twisted(mesh, 0.2 * step))
            check_run(folder.path, n_rows=step + 1)
        folder.write_summary({"status": "finished", "rows": 4})
    assert json.loads((folder.path / "run.json").read_text())["status"] == "finished"


@pytest.mark.parametrize("moment", [0, 1])
def test_interrupt_in_the_middle_of_a_step_leaves_no_half(
    tmp_path: Path, mesh: Disk, monkeypatch: pytest.MonkeyPatch, moment: int
) -> None:
    """Ctrl-C while the shape (0) or the series (1) takes its final name."""
    rename, calls = os.replace, []

    def interrupted(source: Path, target: Path) -> None:
        calls.append(target)
        if len(calls) > moment:
            raise KeyboardInterrupt
        rename(source, target)

    with start(tmp_path / "run") as folder:
        folder.record(ROW, mesh, mesh.x)
        monkeypatch.setattr(os, "replace", interrupted)
        with pytest.raises(KeyboardInterrupt):
            folder.record(replace(ROW, step=1, kL3_alpha=9.0), mesh, mesh.x)
    check_run(folder.path, n_rows=1)


def check_run(path: Path, n_rows: int) -> None:
    """Every row has its shape, every file of the series is whole, nothing is left over."""
    rows = read_rows(path / "sweep.csv")
    assert len(rows) == n_rows
    for row in rows:
        read_shape(path / shape_name(row.step))
        about = read_vtp(path / shape_name(row.step)).field_data
        assert (about["step"][0], about["kL3_alpha"][0]) == (row.step, row.kL3_alpha)
    series = ElementTree.parse(path / "sweep.pvd").getroot().findall(".//DataSet")
    assert len(series) >= n_rows
    for entry in series:
        assert read_vtp(path / entry.attrib["file"]).lines
    json.loads((path / "run.json").read_text())
    names = {file.name for file in path.rglob("*") if file.is_file()}
    assert not {name for name in names if name.startswith(".")}


FULL_DISK = """
import resource, sys
from dataclasses import replace
from pathlib import Path
sys.path.insert(0, {tests!r})
from tests.runs.test_folder import ROW, disk_points, mesh_of, start
from eulerplateau.errors import OutputError

mesh = mesh_of(*disk_points(6))
with start(Path({path!r})) as folder:
    folder.record(ROW, mesh, mesh.x)
    room = (folder.path / {growing!r}).stat().st_size + {more}
    resource.setrlimit(resource.RLIMIT_FSIZE, (room, room))
    try:
        for step in range(1, 1000):
            folder.record(replace(ROW, step=step), mesh, mesh.x)
    except OutputError as error:
        sys.exit(error.exit_code)
"""


@pytest.mark.parametrize(
    ("growing", "more"),
    [("shapes/shape_0000.vtp", -100), ("shapes/shape_0000.vtp", 100)],
)
def test_full_disk_ends_with_exit_code_5_and_what_was_recorded(
    tmp_path: Path, growing: str, more: int
) -> None:
    """No file may outgrow a limit: the next shape, or later the series or the table."""
    path = tmp_path / "run"
    script = FULL_DISK.format(
        tests=str(Path(__file__).parents[2]), path=str(path), growing=growing, more=more
    )
    done = subprocess.run([sys.executable, "-c", script], check=False)
    assert done.returncode == 5
    check_run(path, n_rows=len(read_rows(path / "sweep.csv")))
    assert len(read_rows(path / "sweep.csv")) >= 1


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("thesis.tex", "years of work"),
        ("run.json", "{}"),
        ("run.json", "[1]"),
        ("run.json", "no json"),
        ("run.json", '{"program": "another"}'),
    ],
)
def test_foreign_folder_is_refused_and_untouched(
    tmp_path: Path, name: str, content: str
) -> None:
    (tmp_path / name).write_text(content)
    (tmp_path / "sweep.csv").write_text("mine")
    with pytest.raises(OutputError) as caught:
        start(tmp_path)
    assert caught.value.path == tmp_path
    assert (tmp_path / name).read_text() == content
    assert (tmp_path / "sweep.csv").read_text() == "mine"


def test_earlier_run_is_replaced_and_other_files_are_kept(
    tmp_path: Path, mesh: Disk
) -> None:
    with start(tmp_path) as folder:
        for step in range(3):
            folder.record(replace(ROW, step=step), mesh, mesh.x)
    (tmp_path / "pictures").mkdir()
    (tmp_path / "pictures" / "shape_0000.png").write_bytes(b"old")
    (tmp_path / "diagram.png").write_bytes(b"old")
    (tmp_path / "notes.txt").write_text("mine")
    with start(tmp_path) as folder:
        folder.record(ROW, mesh, mesh.x)
    check_run(tmp_path, n_rows=1)
    files = {str(p.relative_to(tmp_path)) for p in tmp_path.rglob("*") if p.is_file()}
    ours = {"run.json", "sweep.csv", "sweep.pvd", shape_name(0), loop_name(0)}
    assert files == {*ours, "notes.txt"}
    assert (tmp_path / "notes.txt").read_text() == "mine"
