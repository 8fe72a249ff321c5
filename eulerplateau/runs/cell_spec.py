"""What a specification of a cell's run (runs/cell.toml) may say."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal

from pydantic import Field, model_validator

from eulerplateau.cells import Cell, Sites, read_sites, regular_sites
from eulerplateau.errors import SpecError
from eulerplateau.runs.loads import Load, in_order
from eulerplateau.runs.spec import OutputSettings
from eulerplateau.runs.spec_files import read_spec
from eulerplateau.settings import Settings

Parameter = Literal["sigma_hat", "ks_hat"]


class CellSettings(Settings):
    """Where the cell adheres, and what it is made of.

    Attributes
    ----------
    adhesions : int
        So many, at the corners of a regular polygon of circumradius R_0 = 1.
    points : str
        Or a file of their places, x,y[,stiffness] in units of R_0; beside the run's file.
    edges_per_side : int
        Edges of the polygon from one adhesion to the next, an even number.
    sigma_hat, ks_hat, beta_hat : float
        Contractility sigma R_0^3 / alpha, stiffness k_s R_0^3 / alpha, line tension
        beta R_0^2 / alpha; of the one that is swept, where branches start.
    """

    adhesions: int | None = Field(default=None, ge=2)
    points: str | None = None
    edges_per_side: int = Field(default=32, ge=4)
    sigma_hat: float = Field(default=10.0, ge=0)
    ks_hat: float = Field(default=50.0, gt=0)
    beta_hat: float = Field(default=0.0, ge=0)

    @model_validator(mode="after")
    def _one_of_two_ways(self) -> CellSettings:
        if (self.adhesions is None) == (self.points is None):
            raise SpecError("cell.adhesions", "or cell.points should be given, one of them")
        if self.edges_per_side % 2:
            found = f"found {self.edges_per_side}; should be even"
            raise SpecError("cell.edges_per_side", found)
        return self

    def sites(self) -> Sites:
        """Return the adhesions."""
        if self.points is not None:
            return read_sites(self.points)
        return regular_sites(self.adhesions or 0)

    def made(self) -> Cell:
        """Return the cell."""
        return Cell(self.sites(), self.edges_per_side, self.beta_hat)


class CellSweepSettings(Settings):
    """What is varied, and in which order.

    Attributes
    ----------
    parameter : "sigma_hat" or "ks_hat"
    values : list of numbers, ranges {start, stop, step} and refinements
    direction : "up", "down" or "up-down"
    """

    parameter: Parameter = "sigma_hat"
    values: tuple[Load, ...] = Field(min_length=1)
    direction: Literal["up", "down", "up-down"] = "up"

    def in_order(self) -> list[float]:
        """Return the values in the order in which they are swept."""
        return in_order(self.values, self.direction)


class CellBranchSettings(Settings):
    """Where `eulerplateau cell branches` ends; a sweep does not use it.

    Attributes
    ----------
    low, high : float
        The window of the parameter; by default that of sweep.values.
    special_points, unstable_modes : int, as for films
    """

    low: float | None = Field(default=None, gt=0)
    high: float | None = Field(default=None, gt=0)
    special_points: int = Field(default=8, ge=0)
    unstable_modes: int = Field(default=3, ge=0)


class PhaseDiagramSettings(Settings):
    """The plane that `eulerplateau cell phase-diagram` draws.

    Attributes
    ----------
    sigma_hat, ks_hat : (low, high), both above 0
    columns : int
        Lines are located at so many contractilities, and at as many where they begin.
    """

    sigma_hat: tuple[float, float] = (1.0, 1000.0)
    ks_hat: tuple[float, float] = (1.0, 1000.0)
    columns: int = Field(default=40, ge=4)

    @model_validator(mode="after")
    def _ranges(self) -> PhaseDiagramSettings:
        for name in ("sigma_hat", "ks_hat"):
            low, high = getattr(self, name)
            if not 0 < low < high:
                found = f"found [{low:g}, {high:g}]; should be 0 < low < high"
                raise SpecError(f"phase_diagram.{name}", found)
        return self


class CellRunSpec(Settings):
    """One run of a cell: adhesions, what is swept, and where its diagrams end.

    `sweep` is for sweeps and branches, which ask for it; a phase diagram has no use for it.
    """

    cell: CellSettings
    sweep: CellSweepSettings | None = None
    max_iterations: int = Field(default=500, ge=1)
    branches: CellBranchSettings = CellBranchSettings()
    phase_diagram: PhaseDiagramSettings = PhaseDiagramSettings()
    output: OutputSettings = OutputSettings()

    @model_validator(mode="after")
    def _something_holds_the_cell(self) -> CellRunSpec:
        swept = self.sweep
        if swept and swept.parameter == "ks_hat" and min(swept.in_order()) <= 0:
            raise SpecError("sweep.values", "of ks_hat should be above 0")
        return self

    @property
    def swept(self) -> CellSweepSettings:
        """What is varied; raises SpecError where nothing is."""
        if self.sweep is None:
            raise SpecError("sweep.values", "should say what is varied: see runs/cell.toml")
        return self.sweep

    def pairs(self) -> list[tuple[float, float]]:
        """Return (sigma_hat, ks_hat) in the order in which they are swept."""
        return [self.pair(value) for value in self.swept.in_order()]

    def pair(self, value: float) -> tuple[float, float]:
        """Return (sigma_hat, ks_hat) at a value of what is varied."""
        if self.swept.parameter == "sigma_hat":
            return value, self.cell.ks_hat
        return self.cell.sigma_hat, value

    def window(self) -> tuple[float, float]:
        """Return the window of branches; raises SpecError where it is none."""
        values = [value for value in self.swept.in_order() if value > 0] or [1.0]
        low = self.branches.low or min(values)
        high = self.branches.high or max(values)
        if low >= high:
            raise SpecError(
                "branches.low", f"found {low:g}; should be below branches.high, {high:g}"
            )
        return low, high


def load_cell_run(path: Path, overrides: dict[str, Any]) -> CellRunSpec:
    """Read the specification of a cell's run; see `read_spec`."""
    return read_spec(path, overrides, CellRunSpec)
