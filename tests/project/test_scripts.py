"""The set-up: made once, redone when it must be, recovered when interrupted.

The logic is tried with a stand-in for Python, in a second; continuous integration does the
real thing, because it starts from a fresh clone. Nothing is ever installed here: besides
the few programs they are made of, all that the scripts find is a stand-in for apt-get.
"""

from __future__ import annotations

import os
import shutil
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import pytest

from tests.helpers.processes import PATIENCE, Process, started

ROOT = Path(__file__).parents[2]

# What the scripts and the stand-ins call; a system without flock does without.
TOOLS = ["bash", "cat", "cp", "dirname", "env", "flock", "head", "mkdir", "mv"]
TOOLS += ["mktemp", "readlink", "rm", "sleep", "tail", "touch"]

# Notes what it is asked to do. `-m venv` copies it into place, as Python does with itself.
PYTHON = """#!/usr/bin/env bash
case "$*" in
*version_info*) echo "$VERSION" ;;
*ensurepip*) eval "$HAS_VENV" ;;
*ctypes*) [[ -e $HOME/libraries ]] || echo "$LACKING" ;;
"-I "*) ;;
*"-m venv "*)
    mkdir -p "$3/bin" && cp "$0" "$3/bin/python"
    echo venv >>"$JOURNAL"
    ;;
*"-m pip "*)
    echo pip >>"$JOURNAL"
    eval "$DURING_PIP"
    ;;
*-m*)
    printf '%s\\n' "$*" >>"$JOURNAL"
    printf '%s\\n' "$PWD" "${NUMBA_CACHE_DIR-}" "$@" >"$JOURNAL.program"
    if [[ "$*" == *"-m $FAILING"* ]]; then exit "$EXIT_CODE"; fi
    ;;
esac
"""

# Notes the command and the packages, without the options and their values.
APT = """#!/usr/bin/env bash
words=()
for word; do
    case $word in -* | *=*) ;; *) words+=("$word") ;; esac
done
printf '%s\\n' "apt-get ${words[*]}" >>"$JOURNAL"
eval "$DURING_APT"
"""

ID = """#!/usr/bin/env bash
echo "$USER_ID"
"""


@dataclass
class Clone:
    """A clone with the scripts and the stand-in, and what has been done in it so far."""

    path: Path
    home: Path

    @property
    def journal(self) -> Path:
        return self.home / "journal"

    @property
    def programs(self) -> Path:
        """The one folder in which the scripts find programs."""
        return self.home / "programs"

    def add_program(self, name: str, text: str) -> None:
        path = self.programs / name
        path.write_text(text)
        path.chmod(0o755)

    def start(self, *command: str, **variables: str) -> AbstractContextManager[Process]:
        """Start scripts/... from the home directory; `variables` change the environment."""
        environment = {
            "PATH": str(self.programs),
            "HOME": str(self.home),
            "PYTHON": str(self.programs / "python"),
            "JOURNAL": str(self.journal),
            "USER_ID": "1000",
            "VERSION": "3.12.1",
            "HAS_VENV": "true",
            "LACKING": "",
            "DURING_APT": "false",
            "DURING_PIP": "true",
            "FAILING": "eulerplateau",
            "EXIT_CODE": "4",
        }
        script, *arguments = command
        return started(
            [str(self.path / "scripts" / script), *arguments],
            cwd=self.home,
            env=environment | variables,
        )

    def run(self, *command: str, **variables: str) -> tuple[int, list[str]]:
        """Return the exit code and what was asked of Python and apt-get in this run."""
        self.journal.write_text("")
        with self.start(*command, **variables) as process:
            process.communicate(timeout=PATIENCE)
        return process.returncode, self.asked()

    def asked(self) -> list[str]:
        """Return what was asked for, with COMPILE for the run that compiles."""
        lines = self.journal.read_text().splitlines()
        return [COMPILE if COMPILES in line else line for line in lines]


SWEEP = "-P -m eulerplateau sweep"
COMPILE, COMPILES = "compile", "--set sweep.loads=[1,700] --out"
INSTALL = ["venv", "pip", "pip"]
SET_UP = [*INSTALL, COMPILE]


def apt(*packages: str) -> list[str]:
    """Return what is asked of apt-get to install `packages`."""
    return ["apt-get update", f"apt-get install {' '.join(packages)}"]


@pytest.fixture
def clone(tmp_path: Path) -> Clone:
    """Return a clone that has not been set up."""
    path = tmp_path / "a clone"
    shutil.copytree(ROOT / "scripts", path / "scripts")
    for name in ("requirements.lock", "pyproject.toml"):
        shutil.copy(ROOT / name, path)
    clone = Clone(path, tmp_path)
    clone.programs.mkdir()
    for tool in filter(shutil.which, TOOLS):
        (clone.programs / tool).symlink_to(str(shutil.which(tool)))
    for name, text in (("python", PYTHON), ("apt-get", APT), ("id", ID)):
        clone.add_program(name, text)
    return clone


@pytest.fixture
def ready(clone: Clone) -> Clone:
    """Return a clone that has been set up."""
    clone.run("sweep")
    return clone


def test_first_start_sets_up_and_passes_everything_on(clone: Clone) -> None:
    code, asked = clone.run("sweep", "a run.toml", "--set", "x=1 2")
    assert code == 4
    assert asked == [*SET_UP, f"{SWEEP} a run.toml --set x=1 2"]
    directory, _, *arguments = Path(f"{clone.journal}.program").read_text().splitlines()
    assert directory == str(clone.home)
    assert arguments == [*SWEEP.split(), "a run.toml", "--set", "x=1 2"]


def test_second_start_neither_makes_nor_installs_anything(ready: Clone) -> None:
    assert ready.run("sweep") == (4, [SWEEP])


def test_script_called_through_a_link_finds_its_repository(ready: Clone) -> None:
    link = ready.path / "scripts" / "link"
    link.symlink_to("sweep")
    assert ready.run("link") == (4, [SWEEP])


@pytest.mark.parametrize("study", ["benchmark", "twist_threshold"])
def test_study_is_started_as_a_package_with_the_same_arguments(
    ready: Clone, study: str
) -> None:
    code, asked = ready.run(study, "--csv", "a table.csv", PYTHONPATH="/elsewhere")
    assert code == 0
    assert asked == [f"-P -m scripts.studies.{study} --csv a table.csv"]


@pytest.mark.parametrize("name", ["requirements.lock", "pyproject.toml"])
def test_changed_requirements_are_installed_in_place(ready: Clone, name: str) -> None:
    with (ready.path / name).open("a") as file:
        file.write("# changed\n")
    assert ready.run("sweep") == (4, ["pip", "pip", COMPILE, SWEEP])
    assert ready.run("sweep") == (4, [SWEEP])


def test_another_python_gets_an_environment_of_its_own(ready: Clone) -> None:
    assert ready.run("sweep", VERSION="3.13.0") == (4, [*SET_UP, SWEEP])


def test_moved_clone_is_set_up_anew(ready: Clone) -> None:
    ready.path = ready.path.rename(ready.home / "moved")
    assert ready.run("sweep") == (4, [*SET_UP, SWEEP])


@pytest.mark.parametrize("end", ["exit 1", "kill -KILL $PPID"])
def test_interrupted_set_up_is_redone_from_nothing(clone: Clone, end: str) -> None:
    code, asked = clone.run("sweep", DURING_PIP=end)
    assert code not in {0, 4}
    assert asked == ["venv", "pip"]
    (clone.path / ".venv" / "half").touch()
    assert clone.run("sweep") == (4, [*SET_UP, SWEEP])
    assert not (clone.path / ".venv" / "half").exists()


def test_interrupted_change_is_redone_from_nothing(ready: Clone) -> None:
    (ready.path / "requirements.lock").write_text("changed")
    assert ready.run("sweep", DURING_PIP="kill -KILL $PPID")[1] == ["pip"]
    assert ready.run("sweep") == (4, [*SET_UP, SWEEP])


def test_two_first_starts_at_once_set_up_once(clone: Clone) -> None:
    clone.journal.write_text("")
    start = partial(clone.start, "sweep", DURING_PIP="sleep 0.2")
    with start() as one, start() as two:
        for process in (one, two):
            process.communicate(timeout=PATIENCE)
            assert process.returncode == 4
    assert clone.asked() == [*SET_UP, SWEEP, SWEEP]


@pytest.mark.parametrize("version", ["", "2.7.18", "3.10.13", "3.100.1"])
def test_unsuitable_python_is_refused_and_changes_nothing(
    ready: Clone, version: str
) -> None:
    assert ready.run("sweep", VERSION=version) == (1, [])
    assert ready.run("sweep") == (4, [SWEEP])


def test_without_a_home_caches_stay_in_the_environment(ready: Clone) -> None:
    ready.run("sweep", HOME="/nonexistent")
    cache = Path(f"{ready.journal}.program").read_text().splitlines()[1]
    assert Path(cache).is_relative_to(ready.path / ".venv")


PYTEST = "-m pytest -n auto --dist loadfile --no-loadscope-reorder -m not slow -x"


@pytest.mark.parametrize(
    "failing", ["ruff check", "ruff format", "mypy", "tests.warm", "pytest"]
)
def test_every_check_runs_and_any_failure_counts(ready: Clone, failing: str) -> None:
    code, asked = ready.run("test", "-x", FAILING=failing, EXIT_CODE="5")
    assert code == 1
    # It compiles for the tests while the checks run, and looks at types beside them all.
    assert "-m tests.warm" in asked[: asked.index(PYTEST)]
    asked.remove("-m tests.warm")
    asked.remove("-m mypy")
    assert asked == [
        "-m ruff check",
        "-m ruff format --check",
        PYTEST,
    ]


def test_slow_runs_the_slow_tests_only(ready: Clone) -> None:
    assert ready.run("test", "--slow", "-x") == (0, ["-m pytest -m slow -x"])
    assert ready.run("test", "--slow", FAILING="pytest", EXIT_CODE="5")[0] == 1


AS_ROOT = {"USER_ID": "0"}

# What needs programs that are no Python packages, and the packages that bring them.
NEEDS = [
    (["test", "--slow"], ["chromium", "chromium-driver"], ["chromium", "chromedriver"]),
    (["error_vs_time"], ["evolver-nox"], ["evolver-nox-d"]),
]


@pytest.mark.parametrize(("command", "packages", "programs"), NEEDS)
def test_root_installs_the_programs_a_script_needs_and_has_not(
    ready: Clone, command: list[str], packages: list[str], programs: list[str]
) -> None:
    then = ready.run(*command)
    assert ready.run(*command, **AS_ROOT) == (then[0], [*apt(*packages), *then[1]])
    for program in programs:
        ready.add_program(program, "#!/bin/sh\n")
    assert ready.run(*command, **AS_ROOT) == then


@pytest.mark.parametrize(("command", "packages", "programs"), NEEDS)
def test_nothing_is_installed_without_root_or_apt(
    ready: Clone, command: list[str], packages: list[str], programs: list[str]
) -> None:
    code, asked = ready.run(*command)
    assert code == 0
    assert not [line for line in asked if line.startswith("apt-get")]
    (ready.programs / "apt-get").unlink()
    assert ready.run(*command, **AS_ROOT) == (code, asked)


def test_root_installs_missing_libraries_while_setting_up(clone: Clone) -> None:
    lacking = AS_ROOT | {"LACKING": "libone libtwo"}
    # An apt that fails stops nothing, and is not asked again.
    wanted = apt("libone", "libtwo")
    assert clone.run("sweep", **lacking) == (4, [*INSTALL, *wanted, COMPILE, SWEEP])
    assert clone.run("sweep", **lacking) == (4, [SWEEP])


def test_that_all_libraries_were_found_is_remembered(clone: Clone) -> None:
    lacking = AS_ROOT | {"LACKING": "libone"}
    code, asked = clone.run("sweep", **lacking, DURING_APT='touch "$HOME/libraries"')
    assert (code, asked) == (4, [*INSTALL, *apt("libone"), COMPILE, SWEEP])
    assert (clone.path / ".venv" / "libraries-found").exists()


def test_a_user_without_the_libraries_is_set_up_all_the_same(clone: Clone) -> None:
    assert clone.run("sweep", LACKING="libone") == (4, [*SET_UP, SWEEP])


def test_root_installs_the_venv_module_where_it_is_a_package_of_its_own(
    clone: Clone,
) -> None:
    need = {"HAS_VENV": "[[ -e $HOME/module ]]"}
    wanted = apt("python3.12-venv")
    assert clone.run("sweep", **need) == (1, [])
    assert clone.run("sweep", **need, **AS_ROOT) == (1, wanted)
    code, asked = clone.run("sweep", **need, **AS_ROOT, DURING_APT='touch "$HOME/module"')
    assert (code, asked) == (4, [*wanted, *SET_UP, SWEEP])


@pytest.mark.parametrize("script", ["scripts/sweep", "scripts/test", ".ci/run"])
def test_commands_are_executable(script: str) -> None:
    assert os.access(ROOT / script, os.X_OK)
