"""The folder of an ensemble: its cases, each a run folder, and what is kept of failures.

    ensemble.json                   the names of all cases, in the order of their file
    cases/NAME/                     the run folder of a case
    cases/NAME.failed.json          in place of it, or of the rest of it: why it failed
    ensemble.csv                    the table of all

A case is known by its name alone, so that several calls, on several machines, may fill one
folder.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from eulerplateau.errors import OutputError
from eulerplateau.mesh import write_whole
from eulerplateau.runs.run_files import read_summary

_LIST = "ensemble.json"
_MARK = {"program": "eulerplateau"}


@dataclass(frozen=True)
class Place:
    """Where a run lies, or should: its folder, and why it failed if it did.

    Attributes
    ----------
    name : str, that of a case; of another run, of its folder
    failure : what NAME.failed.json says; empty if the run did not fail
    """

    name: str
    folder: Path
    failure: Mapping[str, Any]

    @property
    def is_there(self) -> bool:
        """Whether there is anything of it."""
        return bool(self.failure) or (self.folder / "run.json").is_file()


def case_folder(out: Path, name: str) -> Path:
    """Return the run folder of a case."""
    return out / "cases" / name


def open_ensemble(out: Path, names: Sequence[str]) -> None:
    """Make the folder of an ensemble, and list its cases in it.

    Raises OutputError for one that cannot be written, or that holds something else.
    """
    try:
        if out.exists() and any(out.iterdir()) and not (out / _LIST).is_file():
            problem = "holds something else than an ensemble: name an empty or new folder"
            raise OutputError(out, problem)
        (out / "cases").mkdir(parents=True, exist_ok=True)
    except OSError as error:
        problem = f"cannot be made a folder: {error.strerror}"
        raise OutputError(out, problem) from None
    _write(out / _LIST, {**_MARK, "cases": list(names)})


def is_finished(out: Path, name: str) -> bool:
    """Whether a case has been carried out to its end."""
    return read_summary(case_folder(out, name)).get("status") == "finished"


def record_failure(out: Path, name: str, about: Mapping[str, Any] | None) -> None:
    """Keep why a case failed; or, without that, forget that an earlier call failed."""
    path = _failure(out, name)
    if about is not None:
        _write(path, {**_MARK, **about})
        return
    with suppress(FileNotFoundError):
        path.unlink()


def case_places(out: Path, names: Iterable[str]) -> list[Place]:
    """Return where the cases of these names lie."""
    return [_place(out, name) for name in names]


def read_runs_below(folders: Sequence[Path]) -> list[Place]:
    """Return all runs in folders: run folders, ensembles, and folders that hold runs.

    Those of ensembles come in the order of their files, and one that several folders have,
    as shards may, once. Raises OutputError for a folder without any.
    """
    found: dict[str, Place] = {}
    for folder in folders:
        places = _in(folder)
        if not places:
            problem = "is no run folder, and there is none in it"
            raise OutputError(folder, problem)
        for place in places:
            if place.name not in found or not found[place.name].is_there:
                found[place.name] = place
    return list(found.values())


def _in(folder: Path) -> list[Place]:
    listed = _read(folder / _LIST).get("cases")
    if isinstance(listed, list):
        return case_places(folder, listed)
    runs = [folder] if _is_run(folder) else sorted(filter(_is_run, folder.glob("*")))
    # By their paths: unlike a case's, the name of a folder says nothing of what is in it.
    return [Place(str(run.resolve()), run, {}) for run in runs]


def _is_run(folder: Path) -> bool:
    return any((folder / name).is_file() for name in ("sweep.csv", "branches.csv"))


def _place(out: Path, name: str) -> Place:
    # Of two calls at a time one fails where the other is at work, which counts.
    failure = {} if is_finished(out, name) else _read(_failure(out, name))
    return Place(name, case_folder(out, name), failure)


def _failure(out: Path, name: str) -> Path:
    return out / "cases" / f"{name}.failed.json"


def _write(path: Path, content: Mapping[str, Any]) -> None:
    write_whole(path, f"{json.dumps(content, indent=2, allow_nan=False)}\n".encode())


def _read(path: Path) -> Mapping[str, Any]:
    """Return what a file of ours says; empty without one, or if it is broken."""
    try:
        found = json.loads(path.read_bytes())
    except (OSError, ValueError):
        return {}
    return found if isinstance(found, dict) else {}
