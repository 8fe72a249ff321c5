"""A case of an ensemble: its name, which says all that decides its results, and its run."""

from __future__ import annotations

import json
import logging
import time
from collections.abc import Callable
from dataclasses import dataclass
from hashlib import sha256
from importlib import import_module
from pathlib import Path
from typing import Any

from eulerplateau.errors import EulerPlateauError, SpecError
from eulerplateau.runs.continuing import RESULTS
from eulerplateau.runs.inputs import contents
from eulerplateau.runs.spec_files import FILE_KEYS
from eulerplateau.settings import Settings

# What a case may be: where its specification is defined, and what carries it out. Only
# what is asked for is loaded.
KINDS = {
    "sweep": ("spec.RunSpec", "sweep.run_sweep"),
    "branches": ("spec.RunSpec", "exploration.run_branches"),
    "cell sweep": ("cell_spec.CellRunSpec", "cell_runs.run_cell_sweep"),
    "cell branches": ("cell_spec.CellRunSpec", "cell_runs.run_cell_branches"),
}

# Hexadecimal digits of a name: among a million cases two are alike once in 1e7 ensembles.
_DIGITS = 16

_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Case:
    """One run of an ensemble.

    Attributes
    ----------
    name : str, see `case_name`
    kind : str, one of KINDS
    spec : RunSpec or CellRunSpec
    label : str, what tells it from the others of its file
    """

    name: str
    kind: str
    spec: Settings
    label: str


@dataclass(frozen=True)
class Outcome:
    """What carrying out a case came to.

    Attributes
    ----------
    rows : int
    not_converged : int, of the rows those that are no equilibria
    seconds : float
    problem : str, why it failed; empty if it did not
    exit_code : int, that of what it failed with; 0 if it did not
    """

    rows: int
    not_converged: int
    seconds: float
    problem: str = ""
    exit_code: int = 0


def spec_type(kind: str) -> type[Settings]:
    """Return the type of the specifications of a kind of case."""
    found: type[Settings] = _named(KINDS[kind][0])
    return found


def case_name(kind: str, spec: Settings) -> str:
    """Return the name of a case: a hash of what decides its results.

    That is its kind, the keys of its specification that are not at their defaults, the
    contents of the files it names, and the version of the results, which is raised where
    a default changes. Where files lie, how a specification is written and in which order,
    makes no difference.
    """
    said = spec.model_dump(mode="json", exclude_defaults=True)
    read = {}
    for key in FILE_KEYS:
        section, _, entry = key.partition(".")
        path = said[section].pop(entry, None) if section in said else None
        if path is not None:
            read[key] = contents(path)
    identity = {"kind": kind, "spec": said, "contents": read, "results": RESULTS}
    text = json.dumps(identity, sort_keys=True, allow_nan=False)
    return sha256(text.encode()).hexdigest()[:_DIGITS]


def carry_out(task: tuple[Case, Path]) -> Outcome:
    """Carry out a case in its folder; raises nothing: what went wrong is in the outcome."""
    case, folder = task
    began = time.perf_counter()
    # Loaded by those who compute.
    from eulerplateau.threads import one_thread

    try:
        if case_name(case.kind, case.spec) != case.name:
            raise SpecError(case.label, "one of its files has changed: call again")
        run: Callable[[Any, Path], Any] = _named(KINDS[case.kind][1])
        with one_thread():
            rows = run(case.spec, folder).rows
    except EulerPlateauError as error:
        return _failed(began, str(error), error.exit_code)
    except OSError as error:
        problem = f"{error.filename or 'a file'}: {error.strerror or error}"
        return _failed(began, problem, 5)
    except Exception as error:
        # A mistake of the program's own costs this case alone, and is not hidden.
        _log.exception("%s: %s", case.name, case.label)
        return _failed(began, f"{type(error).__name__}: {error}", 1)
    lost = sum(not row.converged for row in rows)
    return Outcome(len(rows), lost, time.perf_counter() - began)


def _failed(began: float, problem: str, exit_code: int) -> Outcome:
    return Outcome(0, 0, time.perf_counter() - began, problem, exit_code)


def _named(place: str) -> Any:
    """Return what a file of runs/ has, by "file.name"."""
    file, _, name = place.partition(".")
    return getattr(import_module(f"eulerplateau.runs.{file}"), name)
