"""Run folders, of sweeps or of branches, as curves over the load."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.runs import (
    Branch,
    BranchRow,
    Row,
    distinct_steps,
    is_planar,
    legs,
    read_branches,
    read_tables,
)

Quantity = Callable[[Row], float | None]

# Stable states of branches that differ by less than this part of the largest are alike.
_ALIKE = 0.01
# A stretch of fewer points is a stub, beside a special point whose eigenvalue has no sign.
_STUB = 4


@dataclass(frozen=True)
class Run:
    """A run folder, read.

    Attributes
    ----------
    label : str, what tells it from the runs it is compared with
    folder : Path
    rows : of sweep.csv or branches.csv, at least one
    branches : empty for a sweep
    """

    label: str
    folder: Path
    rows: tuple[Row, ...]
    branches: tuple[Branch, ...] = ()

    @property
    def first_leg(self) -> list[Row]:
        """The converged rows of a sweep up to where its load turns, or of branch 0."""
        rows = list(self.branches[0].rows if self.branches else legs(self.rows)[0][1])
        return [row for row in rows if row.converged]

    @property
    def saddle(self) -> tuple[float, float] | None:
        """The loads between which a film first leaves its plane and returns to it."""
        if self.branches:
            bridge = next((branch for branch in self.branches if branch.bridges), None)
            return None if bridge is None else (bridge.loads.min(), bridge.loads.max())
        alike = groupby(sorted(self.first_leg, key=lambda row: row.load), is_planar)
        states = [(planar, [row.load for row in rows]) for planar, rows in alike]
        return next((band for band in _between_planar(states)), None)

    def states(self) -> list[Row]:
        """Return one row for each distinct state, by load."""
        if self.branches:
            found = _distinct([row for branch in self.branches for row in _middles(branch)])
        else:
            chosen = set(distinct_steps(self.rows))
            found = [row for row in self.rows if row.step in chosen]
        return sorted(found, key=lambda row: row.load)


@dataclass(frozen=True)
class Piece:
    """A part of a curve drawn in one style: loads and values (n,).

    `solid` is a sweep with its load rising, or a stable stretch of a branch.
    """

    loads: FloatArray
    values: FloatArray
    solid: bool


def read_runs(folders: Sequence[Path]) -> list[Run]:
    """Read run folders as `sweep` and `branches` write them, finished or not.

    A folder named twice counts once; of films of different kinds all loads are sigma_hat.
    Raises OutputError naming the folder that is no run
    or has no rows yet, or the table that cannot be read.
    """
    distinct = list({folder.resolve(): folder for folder in folders}.values())
    labels = _labels(distinct)
    return [
        Run(label, folder, tuple(rows), tuple(_branches(rows)))
        for label, folder, rows in zip(labels, distinct, read_tables(distinct), strict=True)
    ]


def pieces(run: Run, quantity: Quantity) -> Iterator[Piece]:
    """Yield the curve of a quantity piece by piece, with NaN for what is not finite.

    Of a quantity that was not computed, nothing.
    """
    for branch in run.branches:
        values = _values(branch.rows, quantity)
        for stable, part in _stretches(branch):
            if np.isfinite(values[part]).all():
                loads, curve = (branch.smooth(v, part) for v in (branch.loads, values))
                yield Piece(loads, curve, stable)
            elif np.isfinite(values[part]).any():
                yield Piece(branch.loads[part], values[part], stable)
    if not run.branches:
        for rising, leg in legs(run.rows):
            good = [row for row in leg if row.converged]
            loads = np.array([row.load for row in good])
            values = _values(good, quantity)
            if np.isfinite(values).any():
                yield Piece(loads, values, rising)


def _branches(rows: Sequence[Row]) -> list[Branch]:
    return read_branches([row for row in rows if isinstance(row, BranchRow)])


def _labels(folders: Sequence[Path]) -> list[str]:
    """Return the ends of the paths that tell runs apart, and what of run.json does."""
    parts = [folder.resolve().parts for folder in folders]
    names = [folder.name for folder in folders]
    for count in range(1, max((len(part) for part in parts), default=0) + 1):
        names = ["/".join(part[-count:]) for part in parts]
        if len(set(names)) == len(names):
            break
    notes = [_notes(folder) for folder in folders]
    told = [set(column) != {column[0]} for column in zip(*notes, strict=True)]
    return [
        ", ".join([name, *(text for text, tell in zip(own, told, strict=True) if tell)])
        for name, own in zip(names, notes, strict=True)
    ]


def _notes(folder: Path) -> tuple[str, ...]:
    """Return what run.json says of the film, of the mesh's size and of the solver."""
    try:
        about: dict[str, Any] = json.loads((folder / "run.json").read_bytes())
        film, solver = about["spec"]["film"]["model"], about["spec"]["solver"]["name"]
        return film, f"{about['mesh']['vertices']} vertices", solver
    except (OSError, ValueError, KeyError, TypeError):
        return "", "", ""


def _stretches(branch: Branch) -> Iterator[tuple[bool, slice]]:
    """Yield the stretches of like stability."""
    for stable, alike in groupby(enumerate(branch.stable), key=lambda pair: bool(pair[1])):
        places = [place for place, _ in alike]
        yield stable, slice(places[0], places[-1] + 2)


def _middles(branch: Branch) -> list[Row]:
    """Return the middle row of each stable stretch of a branch, stubs left out."""
    parts = [branch.rows[part] for stable, part in _stretches(branch) if stable]
    return [part[len(part) // 2] for part in parts if len(part) >= _STUB]


def _distinct(rows: Sequence[Row]) -> list[Row]:
    """Leave out what is alike in load and order parameter: mirror images."""
    kept: list[Row] = []
    load = _ALIKE * max((row.load for row in rows), default=0.0)
    bend = _ALIKE * max((row.abs_kappa_n for row in rows), default=0.0)
    for row in rows:
        if not any(
            abs(row.load - other.load) <= load
            and abs(row.abs_kappa_n - other.abs_kappa_n) <= bend
            for other in kept
        ):
            kept.append(row)
    return kept


def _between_planar(
    states: Sequence[tuple[bool, list[float]]],
) -> list[tuple[float, float]]:
    """Return the loads of the states that are not planar, and have planar neighbours."""
    return [
        (min(loads), max(loads))
        for (before, _), (planar, loads), (after, _) in zip(
            states, states[1:], states[2:], strict=False
        )
        if before and after and not planar
    ]


def _values(rows: Sequence[Row], quantity: Quantity) -> FloatArray:
    found = [quantity(row) for row in rows]
    return np.array(
        [math.nan if v is None or not math.isfinite(v) else v for v in found], dtype=float
    )
