"""A run folder read back: its rows, its film's load, its special points, its shapes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from eulerplateau.errors import MissingLibraryError, OutputError
from eulerplateau.film import SPRING_LOAD
from eulerplateau.runs.kinds import FILM, Kind, film_kind
from eulerplateau.runs.rows import LoadName, Record, columns
from eulerplateau.runs.run_files import read_summary
from eulerplateau.runs.series import Branch, Leg, read_branches, read_legs
from eulerplateau.runs.series_file import SPECIAL, shape_name
from eulerplateau.runs.shape_files import ShapeSequence, read_shapes
from eulerplateau.runs.states import distinct_steps, stable_states
from eulerplateau.runs.table import read_rows, read_special


@dataclass(frozen=True, repr=False)
class Run:
    """A run folder, of a sweep or of branches, read back; it prints in a line.

    Attributes
    ----------
    folder : Path
    rows : of sweep.csv or branches.csv, Row or CellRow as the run follows a film or a cell
    explored : bool, whether they are those of branches.csv
    name : str, the last parts of the folder's path, as many as tell the runs read together
    label : str, the name, and what of film, mesh and solver tells them
    about : what run.json says; empty if it says nothing
    special : by number, what special_points.csv says of each point; empty for a sweep
    """

    folder: Path
    rows: tuple[Any, ...]
    explored: bool = False
    name: str = ""
    label: str = ""
    about: Mapping[str, Any] = field(default_factory=dict)
    special: Mapping[int, Mapping[str, str]] = field(default_factory=dict)

    def __repr__(self) -> str:
        kind = f"points on {len(self.branches)} branches" if self.branches else "loads"
        loads = [row.load for row in self.rows]
        window = f", {self.load.text} {min(loads):g} to {max(loads):g}" if loads else ""
        status = self.about.get("status", "no status")
        name = self.name or self.folder.name
        return f"<Run {name}: {len(self.rows)} {kind}{window}, {status}>"

    @property
    def load(self) -> LoadName:
        """The load its rows are read and shown over."""
        return self.rows[0].load_name if self.rows else SPRING_LOAD

    @property
    def kind(self) -> Kind:
        """What it follows, a film or a cell."""
        return kind_of(self.about)

    @cached_property
    def branches(self) -> tuple[Branch, ...]:
        """Its branches; none if it is a sweep."""
        return tuple(read_branches(self.rows)) if self.explored else ()

    @cached_property
    def series(self) -> tuple[Branch, ...] | tuple[Leg, ...]:
        """The curves of its diagram, which cover all rows in order: branches, or legs."""
        return self.branches or tuple(read_legs(self.rows))

    @property
    def first_leg(self) -> list[Any]:
        """The converged rows of a sweep up to where its load turns, or of branch 0."""
        return [row for row in self.series[0].rows if row.converged]

    @property
    def between(self) -> tuple[float, float] | None:
        """The loads to be looked at more closely.

        Of a sweep of a film, those between which it first leaves its plane and returns to
        it; of branches, those of the first stable one between two special points.
        """
        if not self.branches:
            return self.kind.states.between(self.first_leg)
        bridge = next((branch for branch in self.branches if branch.bridges), None)
        return None if bridge is None else (bridge.loads.min(), bridge.loads.max())

    def states(self) -> list[Any]:
        """Return the rows that show the distinct states, by load."""
        if self.branches:
            found = stable_states(
                [
                    branch.rows[part]
                    for branch in self.branches
                    for stable, part in branch.stretches()
                    if stable
                ],
                self.kind.states,
            )
        else:
            chosen = set(self.distinct_steps())
            found = [row for row in self.rows if row.step in chosen]
        return sorted(found, key=lambda row: row.load)

    def distinct_steps(self) -> list[int]:
        """Return the steps that show the distinct states of a sweep, in its order."""
        return distinct_steps(self.rows, self.kind.states)

    def shape_path(self, row: Record) -> Path:
        """Return the file of a row's shape."""
        return self.folder / shape_name(row.step)

    def shapes(self) -> ShapeSequence:
        """Read the shapes of all rows, as `read_shapes` does."""
        return read_shapes([self.shape_path(row) for row in self.rows])

    def table(self) -> Any:
        """Return the rows as a pandas DataFrame, with the columns of the file.

        Raises MissingLibraryError if there is no pandas, which only this asks for.
        """
        try:
            import pandas
        except ImportError:
            problem = "a table of rows needs pandas: pip install pandas"
            raise MissingLibraryError(problem) from None
        names = columns(type(self.rows[0])) if self.rows else self.kind.columns
        cells = {name: [getattr(row, name) for row in self.rows] for name in names}
        cells["status"] = [status.value for status in cells["status"]]
        return pandas.DataFrame(cells)


def read_run(folder: str | Path) -> Run:
    """Read a run folder as `sweep` and `branches` write it, finished or not.

    Raises OutputError naming the folder if it is no run or has no rows yet, or the table
    that cannot be read.
    """
    return read_runs([Path(folder)])[0]


def read_runs(folders: Sequence[Path]) -> list[Run]:
    """Read run folders to be compared; raises what `read_run` raises.

    A folder named twice counts once; of films of different kinds all loads are sigma_hat.
    """
    distinct = list({folder.resolve(): folder for folder in folders}.values())
    runs = [_read(folder) for folder in distinct]
    first = runs[0].kind if runs else None
    for run in runs:
        if first is None or run.kind.name != first.name:
            problem = f"is the run of a {run.kind.name}: show one kind at a time"
            raise OutputError(run.folder, problem)
    if len({run.load.column for run in runs}) > 1:
        runs = [_over(run, run.kind.common_load) for run in runs]
    elif len({run.rows[0].quantity for run in runs}) > 1:  # in several units: in the first
        runs = [_over(run, runs[0].rows[0].quantity) for run in runs]
    names = _names(distinct)
    labels = _labels(names, runs)
    return [
        replace(run, name=name, label=label)
        for run, name, label in zip(runs, names, labels, strict=True)
    ]


def _read(folder: Path) -> Run:
    about = read_summary(folder)
    kind = kind_of(about)
    quantity = kind.quantity(about)
    rows: Sequence[Record]
    special: dict[int, dict[str, str]] = {}
    explored = (folder / "branches.csv").is_file()
    if explored:
        rows = read_rows(folder / "branches.csv", kind.branch_row, quantity)
        special = read_special(folder / SPECIAL)
    elif (folder / "sweep.csv").is_file():
        rows = read_rows(folder / "sweep.csv", kind.row, quantity)
    else:
        problem = "is no run folder: it has neither a sweep.csv nor a branches.csv"
        raise OutputError(folder, problem)
    if not rows:
        raise OutputError(folder, "has no rows yet: there is nothing to show")
    return Run(folder, tuple(rows), explored, about=about, special=special)


def _over(run: Run, column: str | None) -> Run:
    """Return a run shown over another of its rows' loads, one that several have."""
    if column is None:
        problem = f"varies {run.load.text}, another run something else: show them apart"
        raise OutputError(run.folder, problem)
    return replace(run, rows=tuple(replace(row, quantity=column) for row in run.rows))


def kind_of(about: Mapping[str, Any]) -> Kind:
    """Return the kind of run a run.json belongs to: a film's, unless it says otherwise."""
    if about.get("kind") == "cell":
        # Loaded for cells only.
        from eulerplateau.runs.cell_kind import CELL

        return CELL
    try:
        loop, varied = about["spec"]["loop"], about.get("varied", "load")
        return film_kind(loop.get("twist_ratio"), loop.get("rest_curvature"), varied)
    except (AttributeError, KeyError, TypeError):
        return FILM


def _names(folders: Sequence[Path]) -> list[str]:
    """Return the last parts of the folders' paths, as many as tell them apart."""
    parts = [folder.resolve().parts for folder in folders]
    for count in range(1, max((len(part) for part in parts), default=0) + 1):
        names = ["/".join(part[-count:]) for part in parts]
        if len(set(names)) == len(names):
            return names
    return []


def _labels(names: Sequence[str], runs: Sequence[Run]) -> list[str]:
    """Return the names, and what run.json says wherever it says different things."""
    notes = [run.kind.notes(run.about) for run in runs]
    told = [set(column) != {column[0]} for column in zip(*notes, strict=True)]
    found = []
    for name, own in zip(names, notes, strict=True):
        telling = [text for text, tell in zip(own, told, strict=True) if tell and text]
        found.append(", ".join([name, *telling]))
    return found
