"""What ENSEMBLE.toml may say, and the cases it makes: a grid, a list, or both.

    [ensemble]
    kind = "sweep"                       # or "branches", "cell sweep", "cell branches"
    base = "elongated.toml"              # a run file, which the sections below go on top of

    [grid]                               # all combinations
    start.seed = [1, 2, 3]
    sweep.loads = [{ start = 600, stop = 700, step = 10 }]    # one case for each

    [[case]]                             # and each of these, with all of the grid
    film.model = "springs"

Any other section is one of a run file.
"""

from __future__ import annotations

import copy
import itertools
import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from pydantic import Field

from eulerplateau.errors import SpecError
from eulerplateau.runs.bench_spec import in_si
from eulerplateau.runs.ensembles.cases import Case, case_name, spec_type
from eulerplateau.runs.loads import Refinement, SignedRange
from eulerplateau.runs.spec_files import FILE_KEYS, at_home, leaves, located, override
from eulerplateau.settings import Settings, read_toml, unknown_key, validate

# Of one file; all are checked before the first is carried out.
_MOST_CASES = 100_000

# Their values are lists: in an ensemble a number stands for the list of it alone.
_LISTS = {"sweep.loads", "sweep.values"}

_RANGE = {"start", "stop", "step"}


class EnsembleSettings(Settings):
    """Of which kind the cases are, and the file of a run they are made from.

    Attributes
    ----------
    kind : what the cases are, by the command that would carry out one
    base : str
        A run file, beside this one.
    """

    kind: Literal["sweep", "branches", "cell sweep", "cell branches"] = "sweep"
    base: str | None = None


class _EnsembleFile(Settings):
    """The sections that are an ensemble's own."""

    ensemble: EnsembleSettings = EnsembleSettings()
    grid: dict[str, Any] = Field(default_factory=dict)
    case: tuple[dict[str, Any], ...] = ()


@dataclass(frozen=True)
class Ensemble:
    """Cases, no two alike, in the order of their file."""

    cases: tuple[Case, ...]


def load_ensemble(path: str | Path) -> Ensemble:
    """Read the cases of an ensemble; every specification is checked. Raises SpecError."""
    # Workers of a cluster may be at home in another folder.
    path = Path(path).absolute()
    data = read_toml(path)
    names = _EnsembleFile.model_fields.keys()
    own = validate({k: v for k, v in data.items() if k in names}, _EnsembleFile, str(path))
    model = spec_type(own.ensemble.kind)
    _check_sections(data, [*names, *model.model_fields])
    base = _base(own.ensemble.base, path.parent)
    sections = {key: value for key, value in data.items() if key not in names}
    _merge(base, located(sections, path.parent))
    cases: dict[str, Case] = {}
    for replaced in _combinations(data.get("case", []), data.get("grid", {})):
        given = copy.deepcopy(base)
        for key, value in replaced.items():
            _replace(given, key, _located(key, value, path.parent))
        label = ", ".join(f"{key}={_text(value)}" for key, value in replaced.items())
        spec = validate(given, model, f"{path}: {label}" if label else str(path))
        name = case_name(own.ensemble.kind, spec)
        cases.setdefault(name, Case(name, own.ensemble.kind, spec, label))
    return Ensemble(tuple(cases.values()))


def _check_sections(data: Mapping[str, Any], known: list[str]) -> None:
    for key in data:
        if key not in known:
            raise SpecError(key, unknown_key(key, known))


def _base(file: str | None, folder: Path) -> dict[str, Any]:
    """Return what the run file of an ensemble says; nothing without one."""
    if file is None:
        return {}
    path = folder / at_home("ensemble.base", file)
    return located(read_toml(path), path.parent)


def _merge(data: dict[str, Any], sections: Mapping[str, Any]) -> None:
    """Replace the keys of `data` that `sections` have."""
    for key, value in leaves(sections):
        _replace(data, key, value)


def _replace(data: dict[str, Any], key: str, value: Any) -> None:
    """Replace a key, or a whole section."""
    if "." in key:
        override(data, key, value)
    else:
        data[key] = value


def _combinations(
    listed: list[dict[str, Any]], grid: Mapping[str, Any]
) -> Iterator[dict[str, Any]]:
    """Yield what each case replaces, {dotted key: value}."""
    axes = {key: _values(key, given) for key, given in leaves(grid)}
    count = max(len(listed), 1) * math.prod(len(values) for values in axes.values())
    if count > _MOST_CASES:
        raise SpecError("grid", f"asks for {count} cases; should be at most {_MOST_CASES}")
    for number, table in enumerate(listed or [{}]):
        own = {key: _single(key, value) for key, value in leaves(table)}
        twice = sorted(own.keys() & axes.keys())
        if twice:
            raise SpecError(f"case[{number}].{twice[0]}", "is in the grid too: drop one")
        for combination in itertools.product(*axes.values()):
            yield own | dict(zip(axes, combination, strict=True))


def _values(key: str, given: Any) -> list[Any]:
    """Return the values of a key of the grid, ranges expanded."""
    if not isinstance(given, list) or not given:
        problem = f"found {_text(given)}; should be a list of values, as in [1, 2]"
        raise SpecError(f"grid.{key}", problem)
    found: list[Any] = []
    for value in given:
        if isinstance(value, dict) and value.keys() == _RANGE:
            found += _range(key, in_si(f"grid.{key}", value))
        elif isinstance(value, dict) and key in _LISTS:
            found += validate(value, Refinement, f"grid.{key}").values()
        else:
            found.append(value)
    return [_single(key, value) for value in found]


def _range(key: str, given: dict[str, Any]) -> list[Any]:
    """Return the values of a range, whole ones if it starts and steps by whole ones."""
    values = validate(given, SignedRange, f"grid.{key}").values()
    whole = all(isinstance(given[name], int) for name in ("start", "step"))
    return [int(value) for value in values] if whole else list(values)


def _single(key: str, value: Any) -> Any:
    """Return a value; of a key that takes a list, a number becomes the list of it."""
    number = isinstance(value, int | float | str) and not isinstance(value, bool)
    return [value] if key in _LISTS and number else value


def _located(key: str, value: Any, folder: Path) -> Any:
    """Return a value; a file that it names is looked for in a folder."""
    if key in FILE_KEYS and isinstance(value, str):
        return str(folder / at_home(key, value))
    if isinstance(value, dict):
        return located({key: dict(value)}, folder)[key]
    return value


def _text(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(value, default=str)
