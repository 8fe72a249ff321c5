"""The command line as a user meets it: exit codes, folders, silence, what it loads."""

from __future__ import annotations

import statistics
import subprocess
import sys
import time
from pathlib import Path

import pytest
from conftest import ROOT

from eulerplateau.output.table import read_rows

RUN = f"""
[mesh]
file = "{ROOT / "meshes" / "elongated.vtp"}"
[sweep]
loads = [300, 700]
"""


def eulerplateau(
    *arguments: object, cwd: Path | None = None
) -> subprocess.CompletedProcess:
    command = [sys.executable, "-m", "eulerplateau", *map(str, arguments)]
    return subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=False)


@pytest.fixture
def spec(tmp_path):
    path = tmp_path / "run.toml"
    path.write_text(RUN, encoding="utf-8")
    return path


def test_sweep_writes_its_folder_beside_the_specification(spec):
    done = eulerplateau("sweep", spec, "--no-pictures")
    assert done.returncode == 0
    folder = spec.with_suffix("")
    assert len(read_rows(folder / "sweep.csv")) == 2
    assert len(list((folder / "shapes").glob("*.vtp"))) == 2
    assert not (folder / "diagram.png").exists()


def test_quiet_sweep_says_nothing_and_draws(spec, tmp_path):
    done = eulerplateau("sweep", spec, "--quiet", "--out", tmp_path / "out")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert (tmp_path / "out" / "diagram.png").stat().st_size > 10_000


def test_several_specs_and_values_make_a_folder_each(spec, tmp_path):
    other = spec.with_name("other.toml")
    other.write_text(RUN, encoding="utf-8")
    done = eulerplateau(
        *("sweep", spec, other, "--no-pictures", "--out", tmp_path / "out"),
        *("--set", "start.seed=1,2", "--set", "sweep.loads=[100],[200]"),
    )
    assert done.returncode == 0
    folders = sorted(path.name for path in (tmp_path / "out").iterdir())
    assert len(folders) == 8
    loads = {read_rows(tmp_path / "out" / f / "sweep.csv")[0].kL3_alpha for f in folders}
    assert loads == {100.0, 200.0}


CROSSED = '[polygon]\nkind = "corners"\npoints = [[0, 0], [1, 1], [1, 0], [0, 1]]\n'


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (["sweep", "none.toml"], 2),
        (["sweep"], 2),
        (["sweep", "run.toml", "--solver", "simplex"], 2),
        (["sweep", "run.toml", "--set", "loop.alpha=-1"], 2),
        (["sweep", "run.toml", "--set", "loop.alpha=nan"], 2),
        (["sweep", "run.toml", "--set", "alpha"], 2),
        (["sweep", "run.toml", "--set", "mesh.file=none.vtp"], 2),
        (["sweep", "run.toml", "--sovler", "cg"], 2),
        (["mesh", "crossed.toml", "-o", "mesh.vtp"], 2),
        (["sweep", "run.toml", "--set", "mesh.file=broken.vtp"], 3),
        (["mesh", "broken.vtp", "-o", "mesh.vtu"], 3),
        (["sweep", "run.toml", "--set", "solver.max_iterations=1", "--no-pictures"], 4),
        (["sweep", "run.toml", "--no-pictures", "--out", "run.toml/inside"], 5),
        (["mesh", "crossed.toml/inside", "-o", "mesh.vtp"], 5),
    ],
)
def test_exit_code_tells_whose_fault_it_is_in_few_lines(spec, arguments, code):
    folder = spec.parent
    (folder / "crossed.toml").write_text(CROSSED, encoding="utf-8")
    (folder / "broken.vtp").write_text("<VTKFile>", encoding="utf-8")
    done = eulerplateau(*arguments, cwd=folder)
    assert done.returncode == code
    assert "Traceback" not in done.stderr


def test_one_bad_run_does_not_cost_the_others(spec):
    """Meshes are read when their turn comes: by then other runs may be done."""
    (spec.parent / "broken.vtp").write_text("<VTKFile>", encoding="utf-8")
    good = ROOT / "meshes" / "elongated.vtp"
    done = eulerplateau(
        *("sweep", spec, "--no-pictures", "--out", spec.parent / "out"),
        *("--set", f"mesh.file=broken.vtp,{good}"),
        cwd=spec.parent,
    )
    assert done.returncode == 3
    assert len(read_rows(spec.parent / "out" / "run-file=elongated" / "sweep.csv")) == 2


def test_mesh_is_made_and_written(spec):
    done = eulerplateau(
        "mesh", ROOT / "meshes" / "circle.toml", "-o", spec.parent / "m.vtu"
    )
    assert done.returncode == 0
    assert (spec.parent / "m.vtu").stat().st_size > 1000


def test_sweep_on_a_stored_mesh_loads_no_mesher_and_no_viewer(spec):
    command = [sys.executable, "-X", "importtime", "-m", "eulerplateau"]
    arguments = ["sweep", str(spec), "--no-pictures", "--quiet"]
    done = subprocess.run(
        [*command, *arguments], capture_output=True, text=True, check=True
    )
    loaded = {line.rpartition("|")[2].strip() for line in done.stderr.splitlines()}
    assert "eulerplateau.tangent" in loaded
    assert not loaded & {"gmsh", "pyvista", "trimesh", "matplotlib", "meshio"}


def test_help_answers_within_three_tenths_of_a_second():
    seconds = []
    for _ in range(5):
        started = time.perf_counter()
        assert eulerplateau("--help").returncode == 0
        seconds.append(time.perf_counter() - started)
    assert statistics.median(seconds) < 0.3
