"""What all commands spell alike, and what the shell completes."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import click
import pytest
from click.shell_completion import ShellComplete
from click.testing import CliRunner

from eulerplateau.branches import multiple
from eulerplateau.cli import commands
from eulerplateau.mesh import write_mesh
from eulerplateau.mesh.disk import Disk


def every(
    group: click.Group, *words: str
) -> Iterator[tuple[tuple[str, ...], click.Command]]:
    context = click.Context(group)
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        assert command is not None
        yield (*words, name), command
        if isinstance(command, click.Group):
            yield from every(command, *words, name)


COMMANDS = dict(every(commands))


def completed(*words: str) -> list[str]:
    """What follows the last of `words`, as far as it is typed."""
    shell = ShellComplete(commands, {}, "eulerplateau", "_EULERPLATEAU_COMPLETE")
    return [item.value for item in shell.get_completions(list(words[:-1]), words[-1])]


@pytest.mark.slow
def test_every_command_is_asked_about_by_two_letters() -> None:
    # In a fresh process: a command that was called without its group keeps its own options.
    asked = """
from click.testing import CliRunner
from tests.cli.test_options import COMMANDS, commands
for words in COMMANDS:
    answers = [CliRunner().invoke(commands, [*words, ask]) for ask in ("-h", "--help")]
    assert [answer.exit_code for answer in answers] == [0, 0], words
    assert answers[0].output == answers[1].output, words
    """
    done = subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_where_a_command_writes_is_spelt_alike() -> None:
    spellings = {
        (option.name, *option.opts)
        for command in COMMANDS.values()
        for option in command.params
        if {"-o", "--out", "--output"} & set(option.opts)
    }
    assert spellings == {("out", "-o", "--out", "--output")}


def test_the_shell_completes_what_is_not_a_file() -> None:
    assert completed("sweep", "--solver", "c") == ["cg", "cg-plain"]
    assert completed("sweep", "--set", "solver.n") == ["solver.name="]
    assert completed("sweep", "--set", "solver.name=n") == ["solver.name=newton"]
    assert completed("branches", "--set", "film.plane=") == [
        "film.plane=true",
        "film.plane=false",
    ]
    assert "cell.adhesions=" in completed("cell", "sweep", "--set", "cell.")
    assert "kappa_n" in completed("render", "--colour", "kappa")
    assert completed("sweep", "--set", "no.such.key=") == []


def test_events_of_several_eigenvalues_say_of_how_many() -> None:
    assert [multiple(n) for n in (1, 2, 3)] == ["", " (double)", " (3-fold)"]


def test_run_json_names_its_mesh_from_wherever_it_is_read(
    tmp_path: Path, oval: Disk, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "runs").mkdir()
    write_mesh(oval, tmp_path / "oval.vtp")
    text = '[mesh]\nfile = "../oval.vtp"\n[sweep]\nloads = [1]\n'
    (tmp_path / "runs" / "one.toml").write_text(text)
    monkeypatch.chdir(tmp_path)
    run = ["sweep", "runs/one.toml", "--no-pictures", "--quiet"]
    assert CliRunner().invoke(commands, run, standalone_mode=False).return_value == 0
    said = Path(
        json.loads((tmp_path / "runs/one/run.json").read_text())["spec"]["mesh"]["file"]
    )
    assert said.is_absolute()
    assert said.samefile(tmp_path / "oval.vtp")
