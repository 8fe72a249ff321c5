"""Slips of the pen in specifications and on the command line: one line, and no memory."""

from __future__ import annotations

import resource
import shutil
from pathlib import Path

import pytest

from eulerplateau.cli.overrides import parse_setting
from eulerplateau.errors import SpecError
from eulerplateau.mesh import generate
from eulerplateau.mesh.spec import MeshSpec
from eulerplateau.runs.plan import planned
from eulerplateau.runs.spec import RunSpec, load_run
from eulerplateau.settings import validate
from tests.helpers.command import run_here

MESHES = Path(__file__).parents[2] / "meshes"
TEXT = '[mesh]\nfile = "disk.vtp"\n[sweep]\nloads = [1]\n'


@pytest.fixture(autouse=True)
def little_memory():
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    yield
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss < before + 500_000


@pytest.fixture
def run(tmp_path: Path) -> Path:
    shutil.copy(MESHES / "elongated.vtp", tmp_path / "disk.vtp")
    path = tmp_path / "run.toml"
    path.write_text(TEXT)
    return path


def mistake(run: Path, text: str) -> str:
    run.write_text(text)
    with pytest.raises(SpecError) as caught:
        load_run(run, {})
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_a_byte_order_mark_is_passed_over(run):
    run.write_bytes(b"\xef\xbb\xbf" + TEXT.encode())
    assert load_run(run, {}).loads() == [1]


def test_a_tilde_is_the_home_directory(run, monkeypatch):
    monkeypatch.setenv("HOME", "/home/somebody")
    run.write_text(TEXT.replace("disk.vtp", "~/disk.vtp"))
    assert load_run(run, {}).mesh.file == "/home/somebody/disk.vtp"
    ((spec, _),) = planned([run], [("mesh.file", ["~/other.vtp"])], None, load_run)
    assert spec.mesh.file == "/home/somebody/other.vtp"
    assert "home" in mistake(run, TEXT.replace("disk.vtp", "~no such user/disk.vtp"))


def test_a_mesh_that_is_no_section_says_what_to_write(run):
    said = mistake(run, 'mesh = "disk.stl"\n[sweep]\nloads = [1]\n')
    assert 'write mesh.file = "disk.stl"' in said


@pytest.mark.parametrize("loads", ["1000", "2.5"])
def test_a_single_load_says_how_a_list_is_written(run, loads):
    said = mistake(run, TEXT.replace("[1]", loads))
    assert said.startswith("sweep.loads: ")
    assert f"should be a list: write loads = [{loads}]" in said


ENDLESS = {
    "step": "[{start = 1, stop = 2, step = 5e-324}]",
    "step = 1e-09": "[{start = 1, stop = 2, step = 1e-9}]",
    "count": "[{onset = 1, nearest = 1e-3, farthest = 1, count = 1000000000}]",
    "at most 100000 values": "["
    + ", ".join(f"{{start = 0, stop = {i}, step = 1e-3}}" for i in range(80, 90))
    + "]",
}


@pytest.mark.parametrize("word", ENDLESS)
def test_more_loads_than_a_run_gets_through_are_refused(run, word):
    said = mistake(run, TEXT.replace("[1]", ENDLESS[word]))
    assert said.startswith("sweep.loads")
    assert word in said


HUGE = {
    "aspect": {"kind": "ellipse", "aspect": 1e8},
    "factor": {"kind": "stretched-hexagon", "factor": 1e300},
    "half_length": {"kind": "lengthened-hexagon", "half_length": 1e300},
    "sides": {"kind": "regular", "sides": 10**9},
    "points": {"kind": "corners", "points": [[i, i * i] for i in range(20_000)]},
}


@pytest.mark.parametrize("key", HUGE)
def test_polygons_that_no_machine_holds_are_refused(key):
    with pytest.raises(SpecError) as caught:
        validate({"polygon": HUGE[key]}, MeshSpec, "disk.toml")
    assert caught.value.key == f"polygon.{key}"
    assert len(str(caught.value)) < 300


def test_more_corners_than_vertices_are_refused_at_once():
    polygon = {"kind": "regular", "sides": 9_000}
    with pytest.raises(SpecError, match="the polygon alone has 9000"):
        generate(MeshSpec(polygon=polygon, vertices=500))


# More digits than Python reads, or writes; more brackets than it follows.
ENDLESSLY_LONG = ["1" * 5000, "0x" + "f" * 5000, "[" * 3000 + "]" * 3000]


@pytest.mark.parametrize("value", ENDLESSLY_LONG)
def test_numbers_and_lists_without_end_are_told_in_a_line(run, value):
    assert len(mistake(run, TEXT.replace("[1]", value))) < 300
    run.write_text(TEXT)
    settings = [parse_setting(f"sweep.loads={value}")]
    with pytest.raises(SpecError) as caught:
        planned([run], settings, None, load_run)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 300


def test_a_name_that_no_file_has_is_refused(run):
    said = mistake(run, TEXT.replace("disk.vtp", "disk\\u0000.vtp"))
    assert said.startswith("mesh.file: ")


def test_bytes_that_are_no_text_are_refused_where_they_are_no_value(run):
    """As the shell hands them on; long, so that the folder's name takes a digest of it."""
    with pytest.raises(SpecError):
        planned([run], [("solver.name", ["a" * 50 + "\udc80"])], None, load_run)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["sweep.loads=1,2"], "should be a list: write loads = [1]"),
        (["mesh.file=3"], "mesh.file: found 3"),
        (["mesh.file="], "should give a value"),
        (["start.seed=1,,2"], "should give a value"),
        (["start.seed=1,1"], "give each value of --set once"),
    ],
)
def test_settings_that_mean_nothing_are_told_in_a_line(run, words, said):
    sets = [f"--set={word}" for word in words]
    done = run_here("sweep", run, *sets, "--quiet", "--no-pictures")
    assert done.returncode == 2
    assert said in done.stderr.splitlines()[-1]
    assert "Traceback" not in done.stderr
    assert {path.name for path in run.parent.iterdir()} == {"run.toml", "disk.vtp"}


def folders(run: Path, *settings: tuple[str, list[object]]) -> list[str]:
    return [folder.name for _, folder in planned([run], [*settings], None, load_run)]


def test_folders_are_named_by_all_that_is_set(run):
    assert folders(run) == ["run"]
    displaced = folders(run, ("start.displacement", [0.001, 0.002]))
    assert displaced == ["run-displacement=0.001", "run-displacement=0.002"]
    plane = folders(run, ("film.model", ["area"]), ("film.plane", [True]))
    assert plane == ["run-model=area-plane=true"]
    assert folders(run, ("mesh.file", ["a/b.vtp", "c.vtp"])) == ["run-file=b", "run-file=c"]
    long = folders(run, ("sweep.loads", [[*range(900)], [*range(901)]]))
    assert len({*long}) == 2
    assert max(map(len, long)) < 100


def test_a_million_runs_are_refused_before_the_first_is_read(run):
    thousand = [*range(1000)]
    with pytest.raises(SpecError, match="asks for 1000000 runs"):
        folders(run, ("start.seed", thousand), ("loop.alpha", thousand))


def test_what_python_is_given_is_checked_alike():
    with pytest.raises(SpecError, match="should be a list"):
        RunSpec(mesh={"file": "disk.vtp"}, sweep={"loads": 1000})
