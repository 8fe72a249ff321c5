"""`eulerplateau render`: which shapes it draws, and how it ends."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner

from eulerplateau.cli.render import render
from eulerplateau.errors import (
    EulerPlateauError,
    MissingLibraryError,
    OutputError,
    SpecError,
)
from eulerplateau.mesh.disk import Disk
from eulerplateau.pictures.render import chosen_steps
from eulerplateau.runs import read_run
from tests.helpers.drawing import let_one_child_draw
from tests.helpers.shapes import disk_points, mesh_of
from tests.pictures.test_render import record, twisted
from tests.runs.test_folder import start
from tests.runs.test_output import ROW


@pytest.fixture(scope="module")
def mesh() -> Disk:
    return mesh_of(*disk_points(4))


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory, mesh: Disk) -> Path:
    """Loads 0, 100, ..., 400."""
    path = tmp_path_factory.mktemp("run")
    record(path, mesh, [twisted(mesh, t) for t in (0.0, 0.1, 0.2, 0.3, 0.4)])
    return path


def carried_out(*arguments: object) -> EulerPlateauError | None:
    """Run `eulerplateau render`; return the error it ends with."""
    words = [str(argument) for argument in arguments]
    result = CliRunner().invoke(render, words, standalone_mode=False)
    if result.exception is None:
        return None
    assert isinstance(result.exception, EulerPlateauError), result.exception
    return result.exception


def test_command_draws_what_was_chosen(run: Path) -> None:
    chosen = ["--step", 1, "--load", 290.0, "--colour", "soap", "--quiet"]
    assert carried_out(run, *chosen) is None
    names = {path.name for path in (run / "pictures").iterdir()}
    assert names == {"shape_0001_soap.png", "shape_0003_soap.png", "sheet_soap.png"}


def test_pictures_go_where_the_command_is_told(
    run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    let_one_child_draw(monkeypatch)
    there = tmp_path / "new" / "pics"
    assert carried_out(run, "--step", 2, "-o", there) is None
    assert [path.name for path in there.iterdir()] == ["shape_0002.png"]
    assert not (run / "pictures" / "shape_0002.png").exists()


def test_a_load_means_the_nearest_shape_of_each_leg(tmp_path: Path, mesh: Disk) -> None:
    loads = [0.0, 100.0, 200.0, 300.0, 190.0, 90.0]
    with start(tmp_path) as folder:
        for step, load in enumerate(loads):
            row = replace(ROW, step=step, kL3_alpha=load)
            folder.record(row, mesh, twisted(mesh, 0.001 * load))
    run = read_run(tmp_path)
    assert chosen_steps(run, [], [110.0]) == [1, 5]
    assert chosen_steps(run, [5, 0], [199.0, 10.0]) == [0, 2, 4, 5]
    assert chosen_steps(run, [], [300.0]) == [3]


@pytest.mark.parametrize(
    ("option", "value"),
    [
        ("--step", 99),
        ("--load", 1e6),
        ("--colour", "no_such_field"),
        ("--format", "mp4"),
    ],
)
def test_wrong_choice_ends_with_2_and_names_the_option(
    run: Path, option: str, value: object
) -> None:
    error = carried_out(run, option, value)
    assert isinstance(error, SpecError)
    assert error.key == option
    assert error.exit_code == 2


def test_folder_that_is_no_run_ends_with_5(tmp_path: Path) -> None:
    error = carried_out(tmp_path)
    assert isinstance(error, OutputError)
    assert error.exit_code == 5


def test_mp4_without_its_library_ends_with_1_and_says_what_to_install(
    run: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "av", None)
    error = carried_out(run, "--animate", "sweep", "--format", "mp4")
    assert isinstance(error, MissingLibraryError)
    assert error.exit_code == 1
    assert "pip install 'eulerplateau[mp4]'" in str(error)
    assert not (run / "pictures" / "sweep.mp4").exists()


def test_pictures_that_fail_end_with_5(run: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        "eulerplateau.pictures.render.drawing.draw_in_child", lambda *_, **__: False
    )
    error = carried_out(run, "--all", "--animate", "sweep")
    assert isinstance(error, OutputError)
    assert error.exit_code == 5
