"""What a run specification (runs/*.toml) may say."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Discriminator, Field, Tag, model_validator

from eulerplateau.errors import SpecError
from eulerplateau.film import FILM_LOADS
from eulerplateau.mesh import MeshSpec
from eulerplateau.runs.bench_load import BenchLoad, bench_load
from eulerplateau.runs.bench_spec import RodSettings
from eulerplateau.runs.film_spec import FilmSettings
from eulerplateau.runs.loads import Loads
from eulerplateau.runs.loop_spec import LoopSettings
from eulerplateau.runs.parameters import BENCH, NEEDED, own_parameter
from eulerplateau.runs.spec_files import read_spec
from eulerplateau.runs.sweep_spec import BranchSettings, SweepSettings
from eulerplateau.settings import Settings


class StoredMesh(Settings):
    """A mesh file, or a mesh specification in a file; relative to the run's file."""

    file: str


class StartSettings(Settings):
    """The first shape: the flat mesh, each vertex displaced across its plane.

    Or one that a run has written, displaced only if that is asked for.

    Attributes
    ----------
    file : str
        A shape of a run on the same mesh (shapes/*.vtp); relative to the run's file.
    displacement : float
        Standard deviation, in units of L, of a normal distribution; 0 with a file.
    seed : int
        Of NumPy's default generator.
    """

    file: str | None = None
    displacement: float = Field(default=1e-3, ge=0)
    seed: int = Field(default=1, ge=0)

    @model_validator(mode="before")
    @classmethod
    def _undisplaced_from_a_file(cls, given: Any) -> Any:
        if isinstance(given, dict) and given.get("file") is not None:
            return {"displacement": 0.0, **given}
        return given


class SolverSettings(Settings):
    """Which solver, and after how many iterations it gives up on a load."""

    name: Literal["newton", "cg", "cg-plain"] = "newton"
    max_iterations: int | None = Field(default=None, ge=1)


class OutputSettings(Settings):
    """What is written beside the rows and the plain shapes.

    Attributes
    ----------
    modes : int
        So many of the lowest modes go into every shape of a sweep, as vector fields.
    """

    modes: int = Field(default=0, ge=0)


class CatalogueSettings(Settings):
    """How `eulerplateau catalogue` seeks the equilibria at each load.

    Attributes
    ----------
    loads : as sweep.loads, in k L^3 / alpha of springs and sigma_hat of other films
        By default those of sweep.loads.
    starts : int
        So many random loops, and so many guesses for deflation.
    index : int
        Equilibria of Morse index up to this one are listed.
    distance : float, in units of L
        Two equilibria closer than this (r.m.s.) are the same.
    seed : int
    """

    loads: Loads | None = None
    starts: int = Field(default=100, ge=1)
    index: int = Field(default=4, ge=0)
    distance: float = Field(default=0.01, gt=0)
    seed: int = Field(default=1, ge=0)


def _kind_of_mesh(given: Any) -> str:
    if isinstance(given, str):
        problem = f'found "{given}"; should be a section: write mesh.file = "{given}"'
        raise SpecError("mesh", problem)
    specified = isinstance(given, dict) and "file" not in given
    return "specified" if specified or isinstance(given, MeshSpec) else "stored"


class RunSpec(Settings):
    """One run: a mesh, a film, a loop, a start, the loads, a solver."""

    mesh: Annotated[
        Annotated[StoredMesh, Tag("stored")] | Annotated[MeshSpec, Tag("specified")],
        Discriminator(_kind_of_mesh),
    ]
    film: FilmSettings = FilmSettings()
    rod: RodSettings | None = None
    loop: LoopSettings = LoopSettings()
    start: StartSettings = StartSettings()
    sweep: SweepSettings = Field(
        description="says what is varied, along branches too, as sweep.loads = [1, 1000]"
    )
    solver: SolverSettings = SolverSettings()
    output: OutputSettings = OutputSettings()
    branches: BranchSettings = BranchSettings()
    catalogue: CatalogueSettings = CatalogueSettings()

    @model_validator(mode="after")
    def _quantity_is_the_films(self) -> RunSpec:
        quantity, load = self.sweep.quantity, FILM_LOADS[self.film.model]
        if quantity not in (None, load.column, load.constant):
            raise SpecError(
                "sweep.quantity",
                f"found {quantity!r}; should be {load.column!r} or {load.constant!r} with "
                f"film.model = {self.film.model!r}",
            )
        return self

    @model_validator(mode="after")
    def _only_area_stays_in_its_plane(self) -> RunSpec:
        if self.film.plane and self.film.model != "area":
            raise SpecError(
                "film.plane", f"needs film.model = 'area'; found {self.film.model!r}"
            )
        if self.film.plane and self.loop.rest_curvature:
            problem = "should be false with loop.rest_curvature"
            raise SpecError("film.plane", problem)
        if self.film.plane and self.output.modes:
            raise SpecError("output.modes", "should be 0 with film.plane = true")
        return self

    @model_validator(mode="after")
    def _contact_is_newtons(self) -> RunSpec:
        if self.loop.diameter is None:
            return self
        if self.solver.name != "newton":
            problem = f"found {self.solver.name!r}; should be 'newton' with loop.diameter"
            raise SpecError("solver.name", problem)
        if self.loop.diameter == "rod" and "length" in (self.sweep.varied, self.explored):
            problem = "should be a number along a length: the rod's would change with it"
            raise SpecError("loop.diameter", problem)
        _ = self.diameter
        return self

    @model_validator(mode="after")
    def _what_is_varied_is_there(self) -> RunSpec:
        for key, section in ("sweep", self.sweep), ("branches", self.branches):
            needed = NEEDED.get(section.parameter or "load")
            if needed is not None and not getattr(self.loop, needed):
                problem = f"found {section.parameter!r}; needs loop.{needed}"
                raise SpecError(f"{key}.parameter", problem)
        _ = self.twist_ratio
        self.branches.check_window(self.explored)
        if self.bench is not None:
            return self
        others = {self.sweep.varied, self.explored} - {"load"}
        if not others and self.film.load is not None:
            problem = "is for runs that vary something else: loads are sweep.loads"
            raise SpecError("film.load", problem)
        if others and self.film.load is None:
            what = " and ".join(sorted(others))
            raise SpecError("film.load", f"is missing: the load at which {what} is varied")
        return self

    @model_validator(mode="after")
    def _loads_are_finite(self) -> RunSpec:
        if not np.isfinite(self.loads()).all():
            raise ValueError("sweep.loads times L^3 / alpha overflows: use smaller values")
        return self

    @property
    def explored(self) -> str:
        """What is varied along branches."""
        return self.branches.parameter or self.sweep.varied

    @property
    def twist_ratio(self) -> float | None:
        """C / B of the loop, its own or that of its rod; None where twist escapes."""
        given = self.loop.twist_ratio
        if given != "rod":
            return given
        return (self.rod or RodSettings()).twist_ratio

    @property
    def diameter(self) -> float | None:
        """The loop's thickness in units of its length; None where it has none."""
        given = self.loop.diameter
        if given != "rod":
            return given
        return (self.rod or RodSettings()).thickness(self.loop.length)

    @property
    def bench(self) -> BenchLoad | None:
        """What sets the load in units; None where the run says the load itself."""
        return bench_load(self.rod, self.loop, self.film, self.sweep, self.explored)

    @property
    def held(self) -> float | None:
        """The load at which another parameter is varied; None where loads are varied."""
        if self.bench is None:
            return self.film.load
        return None if self.sweep.varied in BENCH else self.bench.at()

    def column(self, varied: str) -> str:
        """Return what rows call what is varied: its column, and the unit it is shown in."""
        if varied in BENCH:
            unit = self.sweep.unit or self.branches.unit or BENCH[varied].unit
            return replace(BENCH[varied], unit=unit).quantity
        return FILM_LOADS[self.film.model].column if varied == "load" else varied

    def values(self) -> list[float]:
        """Return what is swept, loads or values of another parameter, in order."""
        if self.sweep.varied == "load":
            return self.loads()
        own = own_parameter(self.column(self.sweep.varied))
        values = self.sweep.in_order()
        return values if own is None else [own.shown(value) for value in values]

    def steps(self) -> list[tuple[float, dict[str, float]]]:
        """Return, of each step of a sweep, what is varied of the problem, and own cells."""
        varied = self.sweep.varied
        if varied not in BENCH:
            return [(value, {}) for value in self.values()]
        column, values = BENCH[varied].column, self.sweep.in_order()
        cells = [{column: value} for value in values]
        return list(zip(self.loads(), cells, strict=True))

    def cells_at(self, load: float) -> dict[str, float]:
        """Return what a row says besides where a quantity of the bench sets its load."""
        if self.bench is None or self.explored not in BENCH:
            return {}
        return {BENCH[self.explored].column: self.bench.value(self.explored, load)}

    def window(self) -> tuple[float, float]:
        """Return the window of branches in the problem's parameter; SpecError for none."""
        swept = self.explored == self.sweep.varied
        values = self.loads() if self.explored == "load" else self.sweep.in_order()
        values = values if swept else []
        if self.explored == "load" and values:
            values = [load for load in values if load > 0] or [1.0]
        low, high = self.branches.window(self.explored, values)
        if self.bench is None or self.explored not in BENCH:
            return low, high
        return self.bench.at(**{self.explored: low}), self.bench.at(**{self.explored: high})

    def loads(self) -> list[float]:
        """Return the film's loads in the order in which they are swept."""
        bench, varied = self.bench, self.sweep.varied
        if bench is not None and varied in BENCH:
            return [bench.at(**{varied: value}) for value in self.sweep.in_order()]
        if self.held is not None and varied != "load":
            return [self.held]
        scale = 1.0
        if self.sweep.quantity == FILM_LOADS[self.film.model].constant:
            length, rod = self.loop.length, self.rod or RodSettings()
            alpha = self.loop.alpha if rod.rigidity is None else rod.rigidity / 2
            # Not length**3, which raises where a product overflows to infinity.
            scale = length * length * length / alpha
        return [scale * value for value in self.sweep.in_order()]


def load_run(path: Path, overrides: dict[str, Any]) -> RunSpec:
    """Read the specification of a film's run; see `read_spec`."""
    return read_spec(path, overrides, RunSpec)
