"""Carry out a run from Python, as the command line does, and read back what it came to."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from eulerplateau.errors import SpecError
from eulerplateau.runs.plan import load_with, run_name
from eulerplateau.runs.record import Run, read_run
from eulerplateau.runs.spec import RunSpec, load_run


def run(
    spec: str | Path | RunSpec | Mapping[str, Any],
    folder: str | Path | None = None,
    settings: Mapping[str, Any] | None = None,
    *,
    branches: bool = False,
    overwrite: bool = False,
) -> Run:
    """Sweep the loads of a specification into a folder, and return what is there.

    Rows and shapes are on disk as they come. Rows that did not converge raise nothing:
    their `status` says so.

    Parameters
    ----------
    spec : a file such as runs/elongated.toml, or what such a file holds
    folder : where to; by default beside the file, with its name and what is replaced
        (and -branches)
        This very run, if it is there, is kept and goes on where it was interrupted.
    settings : {dotted key: value}
        Keys of a file to be replaced, as in {"start.seed": 3}.
    branches : bool
        Explore the branches instead of sweeping the loads.
    overwrite : bool
        Replace another run that lies in the folder.

    Raises
    ------
    SpecError, MeshError, OutputError, ConflictError : what is wrong, in a line
    """
    if isinstance(spec, str | Path):
        path = Path(spec)
        chosen = load_with(path, settings or {}, load_run)
        name = run_name(path, settings or {}) + ("-branches" if branches else "")
        target = path.with_name(name) if folder is None else Path(folder)
    else:
        if settings:
            raise SpecError(
                "settings", "replace keys of a file: change the mapping instead"
            )
        if folder is None:
            raise SpecError("folder", "should be given where the specification is no file")
        chosen = spec if isinstance(spec, RunSpec) else RunSpec(**spec)
        target = Path(folder)
    if branches:
        from eulerplateau.runs.exploration import run_branches

        run_branches(chosen, target, overwrite=overwrite)
    else:
        from eulerplateau.runs.sweep import run_sweep

        run_sweep(chosen, target, overwrite=overwrite)
    return read_run(target)
