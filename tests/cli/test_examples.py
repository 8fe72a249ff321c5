"""`eulerplateau examples`: the committed runs and meshes, wherever one wants them."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from eulerplateau.cli import commands
from eulerplateau.errors import OutputError
from eulerplateau.runs import load_cell_run, load_run
from eulerplateau.runs.ensembles import load_ensemble
from eulerplateau.runs.spec import StoredMesh

ROOT = Path(__file__).parents[2]


def write(*words: object) -> Result:
    return CliRunner().invoke(commands, ["examples", *map(str, words)])


def contents(folder: Path) -> dict[str, bytes]:
    """Return what the files of a folder hold, by their paths in it."""
    paths = (path for path in folder.rglob("*") if path.is_file())
    return {str(path.relative_to(folder)): path.read_bytes() for path in paths}


def test_files_are_those_of_the_repository_and_its_runs_load(tmp_path: Path) -> None:
    assert write(tmp_path / "new" / "folder").exit_code == 0
    written = contents(tmp_path / "new" / "folder")
    assert {"runs/elongated.toml", "meshes/elongated.toml"} <= written.keys()
    assert {"meshes/elongated.vtp", "meshes/hexagon.vtp"} <= written.keys()
    for name, content in written.items():
        assert content == (ROOT / name).read_bytes()
    for path in (tmp_path / "new" / "folder" / "runs").iterdir():
        if path.stem.startswith("cell"):
            assert load_cell_run(path, {}).cell.made().size > 10
            continue
        if path.stem == "ensemble":
            cases = load_ensemble(path).cases
            assert all(Path(case.spec.mesh.file).is_file() for case in cases)
            continue
        spec = load_run(path, {})
        assert spec.loads()
        assert not isinstance(spec.mesh, StoredMesh) or Path(spec.mesh.file).is_file()


def test_one_line_says_what_to_run_next(tmp_path: Path) -> None:
    result = write(tmp_path)
    (line,) = result.stdout.splitlines()
    assert line.endswith(f"eulerplateau sweep {tmp_path / 'runs' / 'elongated.toml'}")
    assert write("--quiet", tmp_path).stdout == ""


def test_equal_files_are_no_obstacle_and_missing_ones_come_back(tmp_path: Path) -> None:
    write(tmp_path)
    before = contents(tmp_path)
    (tmp_path / "runs" / "area.toml").unlink()
    assert write(tmp_path).exit_code == 0
    assert contents(tmp_path) == before


def test_a_file_that_differs_is_named_and_nothing_is_written(tmp_path: Path) -> None:
    mine = tmp_path / "meshes" / "hexagon.vtp"
    mine.parent.mkdir()
    mine.write_text("mine")
    error = write(tmp_path).exception
    assert isinstance(error, OutputError)
    assert (error.path, error.exit_code) == (mine, 5)
    assert contents(tmp_path) == {"meshes/hexagon.vtp": b"mine"}


@pytest.mark.parametrize("obstacle", [".", "runs", "meshes"])
def test_a_file_in_place_of_a_folder_ends_with_5(tmp_path: Path, obstacle: str) -> None:
    folder = tmp_path / "there"
    path = folder / obstacle
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("")
    assert isinstance(write(folder).exception, OutputError)
