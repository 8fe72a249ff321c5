"""The documentation: its examples run, and its links lead somewhere."""

from __future__ import annotations

import re
import shlex
import shutil
from pathlib import Path

import click
import pytest

from eulerplateau.cli import commands
from eulerplateau.cli.cell import cell
from eulerplateau.mesh import MeshSpec
from eulerplateau.runs import load_run
from eulerplateau.runs.ensembles import running
from eulerplateau.settings import load_toml
from tests.helpers.command import run_here
from tests.helpers.drawing import let_one_child_draw
from tests.helpers.pages import DOCS, EXAMPLES, PAGES, ROOT, blocks
from tests.helpers.tasks import in_turn

TUTORIAL = DOCS / "tutorial.md"

# As the committed runs, which take longer: one flat state and one out of the plane.
SHORT_RUN = '[mesh]\nfile = "../meshes/{}.vtp"\n[sweep]\nloads = [600, 700]\n'


def examples(page: Path) -> list[tuple[str, str | None]]:
    """Return the Python blocks of a page, each with the block of text right below it."""
    pattern = r"^```python\n(.*?)^```$(?:\n\n```text\n(.*?)^```$)?"
    found = re.findall(pattern, page.read_text(), re.M | re.S)
    return [(code, said or None) for code, said in found]


def words_and_numbers(text: str) -> tuple[list[str], list[float]]:
    """Return a text's words, and its numbers; without residuals, which are rounding."""
    number = r"-?\d+(?:\.\d+)?(?:e-?\d+)?"
    text = re.sub(r"residual \S+", "residual", text)
    return re.sub(number, "#", text).split(), [float(n) for n in re.findall(number, text)]


def command_lines(page: Path, program: str) -> list[list[str]]:
    """Return the shell lines of a page that call `program`, as words without comments."""
    lines = [line for block in blocks(page, "sh") for line in block.splitlines()]
    words = [shlex.split(line, comments=True) for line in lines]
    return [line for line in words if line and line[0].startswith(program)]


def named(block: str) -> str:
    """Return the file a TOML block says it is, in its first line."""
    return block.splitlines()[0].removeprefix("# ")


@pytest.fixture
def clone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, coarse_pictures: None) -> Path:
    """Return a folder like the repository's, which the test then is in.

    Its runs are short, its diagrams coarse, and the tutorial's files are in it.
    """
    let_one_child_draw(monkeypatch)
    shutil.copytree(ROOT / "meshes", tmp_path / "meshes")
    (tmp_path / "runs").mkdir()
    for name in ("elongated", "hexagon"):
        (tmp_path / "runs" / f"{name}.toml").write_text(SHORT_RUN.format(name))
    for page in (TUTORIAL, DOCS / "many-runs.md"):
        for block in blocks(page, "toml"):
            (tmp_path / named(block)).write_text(block)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(*arguments: str) -> None:
    """Run the program as a user does; fails the test unless it exits with 0."""
    assert run_here(*arguments).returncode == 0


@pytest.mark.parametrize(
    "page", [page for page in EXAMPLES if examples(page)], ids=lambda page: page.stem
)
def test_python_examples_run_in_order_and_print_what_they_say(
    page: Path,
    clone: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    if page.stem == "many-runs":
        monkeypatch.setattr(running, "in_workers", in_turn)
    if page.stem == "gallery":
        run("sweep", "runs/elongated.toml", "--no-pictures", "--quiet")
    names: dict[str, object] = {"__name__": "__main__"}
    for code, said in examples(page):
        exec(compile(code, str(page), "exec"), names)
        printed = capsys.readouterr().out
        if said is not None:
            words, numbers = words_and_numbers(said)
            assert words_and_numbers(printed) == (words, pytest.approx(numbers, 1e-4, 1e-4))


@pytest.mark.slow
def test_commands_of_the_tutorial_on_cells_do_what_it_says(clone: Path) -> None:
    page = DOCS / "cells-tutorial.md"
    for block in blocks(page, "csv") + blocks(page, "toml"):
        (clone / named(block)).write_text(block)
    for name in ("cell", "cell-phases"):
        run_file = (ROOT / f"runs/{name}.toml").read_text()
        coarse = run_file.replace("edges_per_side = 48", "edges_per_side = 16")
        assert coarse != run_file
        (clone / f"runs/{name}.toml").write_text(coarse)
    lines = command_lines(page, "eulerplateau")
    commands_of_cells = cell.list_commands(click.Context(cell))
    assert {line[2] for line in lines if line[1] == "cell"} == set(commands_of_cells)
    for line in lines:
        run(*line[1:])
    for written in (
        "runs/my-cell/diagram.png",
        "runs/fold/special_points.csv",
        "runs/phases/phase-diagram.png",
        "cells.html",
        "areas.png",
    ):
        assert (clone / written).stat().st_size > 0, written


@pytest.mark.slow
def test_commands_of_the_page_at_the_bench_print_what_it_says(
    clone: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    page = DOCS / "bench.md"
    for block in blocks(page, "csv") + blocks(page, "toml"):
        (clone / named(block)).write_text(block)
    assert (clone / "runs/nylon.toml").read_text() == (ROOT / "runs/nylon.toml").read_text()
    pattern = r"^```sh\n(.*?)^```$(?:\n\n```text\n(.*?)^```$)?"
    found = re.findall(pattern, page.read_text(), re.M | re.S)
    assert len(found) == 3
    for line, said in found:
        done = run_here(*shlex.split(line)[1:])
        assert done.returncode == 0
        if said:
            words, numbers = words_and_numbers(said)
            printed = words_and_numbers(done.stdout)
            assert printed == (words, pytest.approx(numbers, 1e-3))
    for written in ("runs/nylon/diagram.png", "fit.png"):
        assert (clone / written).stat().st_size > 0


def test_specifications_of_the_tutorial_are_valid(clone: Path) -> None:
    specifications = [clone / named(block) for block in blocks(TUTORIAL, "toml")]
    assert {path.parent.name for path in specifications} == {"meshes", "runs"}
    for path in specifications:
        if path.parent.name == "meshes":
            load_toml(path, MeshSpec)
        else:
            assert load_run(path, {}).loads()


def test_tutorial_s_commands_do_what_it_says(clone: Path) -> None:
    lines = command_lines(TUTORIAL, "eulerplateau")
    elsewhere = {
        "planar",
        "film",
        "cell",
        "locus",
        "catalogue",
        "ensemble",
        "collect",
        "doctor",
        "estimate",
        "fit",
        "live",  # which ends when somebody ends it
    }
    assert {line[1] for line in lines} == set(commands.commands) - elsewhere
    for line in lines:
        run(*line[1:])
    for written in (
        "runs/elongated/diagram.png",
        "runs/elongated/sweep.pvd",
        "runs/kite/sweep.csv",
        "runs/kite/pictures/sheet.png",
        "runs/kite-branches/special_points.csv",
        "elongated.html",
        "kite.html",
        "kite.png",
    ):
        assert (clone / written).stat().st_size > 0


def test_commands_of_the_page_on_many_runs_do_what_it_says(
    clone: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(running, "in_workers", in_turn)
    page = DOCS / "many-runs.md"
    for line in command_lines(page, "eulerplateau"):
        if line[1] != "doctor" and "--dask" not in line:
            run(*line[1:])
    tables = [
        clone / name for name in ("seeds.csv", "runs/seeds/ensemble.csv", "table.csv")
    ]
    for path in tables:
        assert len(path.read_text().splitlines()) == 1 + 8
    assert tables[0].read_bytes() == tables[1].read_bytes()


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_commands_of_every_page_have_the_options_they_are_given(page: Path) -> None:
    for _, *words in command_lines(page, "eulerplateau"):
        command, *arguments = commands, *words
        while isinstance(command, click.Group) and arguments:
            context = click.Context(command)
            command = command.get_command(context, arguments.pop(0)) or command
        options = {
            option
            for parameter in command.params
            if isinstance(parameter, click.Option)
            for option in (*parameter.opts, *parameter.secondary_opts)
        }
        assert {word for word in arguments if word.startswith("-")} <= options


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_scripts_of_every_page_exist(page: Path) -> None:
    mentioned = set(re.findall(r"\bscripts/[a-z_]+\b(?!/)", page.read_text()))
    assert [script for script in mentioned if not (ROOT / script).is_file()] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_files_of_code_on_every_page_exist(page: Path) -> None:
    mentioned = set(re.findall(r"`(\w+/[\w/*]+\.py)`", page.read_text()))
    package = ROOT / "eulerplateau"
    assert [path for path in mentioned if not {*ROOT.glob(path), *package.glob(path)}] == []


@pytest.mark.parametrize("page", EXAMPLES, ids=lambda page: page.stem)
def test_relative_links_and_images_lead_to_files(page: Path) -> None:
    targets = re.findall(r"\]\(([^)\s#]+)(?:#[^)\s]*)?\)", page.read_text())
    local = [target for target in targets if not target.startswith("http")]
    assert [target for target in local if not (page.parent / target).is_file()] == []
