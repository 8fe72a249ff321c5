"""`eulerplateau live` as a shell sees it: what it needs, where it is, how it ends."""

from __future__ import annotations

import re
import signal
import sys
from pathlib import Path

import pytest

from eulerplateau.mesh import write_mesh
from eulerplateau.mesh.disk import Disk
from tests.helpers.command import command_line, run_here
from tests.helpers.processes import PATIENCE, started


@pytest.fixture
def spec(tmp_path: Path, oval: Disk) -> Path:
    write_mesh(oval, tmp_path / "oval.vtp")
    path = tmp_path / "run.toml"
    path.write_text('[mesh]\nfile = "oval.vtp"\n[sweep]\nloads = [500, 900]\n')
    return path


def test_extra_that_is_missing_is_named(
    spec: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "aiohttp", None)
    result = run_here("live", spec, "--no-browser")
    assert result.returncode == 1
    assert result.stderr.splitlines() == [
        "eulerplateau: live needs aiohttp: pip install 'eulerplateau[live]'"
    ]


def test_a_wrong_run_is_told_before_anything_is_served(spec: Path) -> None:
    spec.write_text(spec.read_text().replace("500", "-500"))
    result = run_here("live", spec, "--no-browser")
    assert (result.returncode, result.stdout) == (2, "")
    assert "sweep.loads" in result.stderr


@pytest.mark.slow
def test_it_says_where_it_is_and_ends_with_a_signal(spec: Path) -> None:
    with started(command_line("live", spec, "--no-browser")) as process:
        assert process.stdout is not None
        address = process.stdout.readline()
        assert re.fullmatch(r"http://127\.0\.0\.1:\d+/[\w-]{32}/\n", address)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=PATIENCE)
    assert process.returncode == 130
    folder = spec.with_suffix("")
    assert said.splitlines()[-1] == (
        f"eulerplateau: interrupted: {folder}: 0 shapes were saved"
    )
    assert not folder.exists()
