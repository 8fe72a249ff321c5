"""The command `plot`: the files it writes, exit codes for what is wrong."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from click import Choice
from click.testing import CliRunner
from matplotlib.image import imread

from eulerplateau.cli.plot import plot
from eulerplateau.errors import OutputError
from eulerplateau.mesh.disk import Disk
from eulerplateau.pictures.comparison import WHAT
from tests.helpers.plotted_runs import record, row_at, swept
from tests.helpers.shapes import disk_points, mesh_of


@pytest.fixture(scope="module")
def mesh() -> Disk:
    return mesh_of(*disk_points(5))


@pytest.fixture(scope="module")
def sweep(tmp_path_factory: pytest.TempPathFactory, mesh: Disk) -> Path:
    return record(tmp_path_factory.mktemp("runs") / "long", mesh, swept())


def run_cli(*arguments: object) -> int | BaseException | None:
    """Return the exit code of `plot`, or the error the program turns into one."""
    result = CliRunner().invoke(plot, [str(argument) for argument in arguments])
    return (
        result.exception if isinstance(result.exception, OutputError) else result.exit_code
    )


def test_command_draws_in_the_format_its_file_asks_for(tmp_path: Path, sweep: Path) -> None:
    out = tmp_path / "plot.pdf"
    assert run_cli(sweep, sweep, "-o", out, "--what", "energy") == 0
    assert out.read_bytes().startswith(b"%PDF")


@pytest.mark.slow
@pytest.mark.parametrize("backend", ["module://matplotlib_inline.backend_inline", "TkAgg"])
def test_a_notebook_s_backend_is_not_asked_for(
    tmp_path: Path, sweep: Path, backend: str
) -> None:
    """Jupyter exports one that is not there elsewhere; others want a display."""
    out = tmp_path / "plot.png"
    words = ["plot", str(sweep), "-o", str(out), "--what", "curvature"]
    command = [sys.executable, "-m", "eulerplateau", *words]
    environment = {**os.environ, "MPLBACKEND": backend}
    subprocess.run(command, env=environment, check=True)
    assert imread(out)[..., :3].std() > 0.05


@pytest.mark.parametrize("case", ["missing", "no run", "no rows", "no onset"])
def test_folders_that_cannot_be_plotted_end_with_exit_code_5(
    tmp_path: Path, mesh: Disk, case: str
) -> None:
    folder = tmp_path / "run"
    if case == "no run":
        folder.mkdir()
    elif case != "missing":
        record(folder, mesh, [] if case == "no rows" else [row_at(0, 1.0)])
    found = run_cli(folder, "-o", tmp_path / "plot.png", "--what", "onset")
    assert isinstance(found, OutputError)
    assert (found.exit_code, found.path) == (5, folder)
    assert not (tmp_path / "plot.png").exists()


def test_place_that_cannot_be_written_is_an_error(tmp_path: Path, sweep: Path) -> None:
    found = run_cli(sweep, "-o", tmp_path / "none" / "plot.png", "--what", "curvature")
    assert isinstance(found, OutputError)


@pytest.mark.parametrize(
    "arguments", [("-o", "plot.jpg"), ("--what", "nothing"), ("--unknown",)]
)
def test_wrong_arguments_end_with_exit_code_2(
    sweep: Path, arguments: tuple[str, ...]
) -> None:
    assert run_cli(sweep, *arguments) == 2


def test_command_offers_what_there_is() -> None:
    choice = next(option for option in plot.params if option.name == "what")
    assert isinstance(choice.type, Choice)
    assert tuple(choice.type.choices) == WHAT
