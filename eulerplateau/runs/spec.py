"""What a run specification (runs/*.toml) may say."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Discriminator, Field, Tag, model_validator

from eulerplateau.errors import SpecError
from eulerplateau.film import FILM_LOADS
from eulerplateau.mesh import MeshSpec
from eulerplateau.runs.loads import Load as Load, Loads, in_order as in_order
from eulerplateau.runs.loop_spec import LoopSettings
from eulerplateau.runs.parameters import NEEDED
from eulerplateau.runs.sweep_spec import BranchSettings, SweepSettings
from eulerplateau.settings import Model, Settings, read_toml, validate

# Keys that name a file.
FILE_KEYS = "mesh.file", "start.file", "cell.points"


class StoredMesh(Settings):
    """A mesh file, or a mesh specification in a file; relative to the run's file."""

    file: str


class FilmSettings(Settings):
    """Which film spans the loop: springs, Dirichlet's energy, or the true area.

    Attributes
    ----------
    plane : bool
        Keeps a film of the true area in its plane, where its loop is all it needs.
    load : float, k L^3 / alpha of springs and sigma_hat of other films
        Where another parameter than the load is varied: that at which it is.
    """

    model: Literal["springs", "dirichlet", "area"] = "springs"
    plane: bool = False
    load: float | None = Field(default=None, ge=0)


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
    loop: LoopSettings = LoopSettings()
    start: StartSettings = StartSettings()
    sweep: SweepSettings
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
    def _what_is_varied_is_there(self) -> RunSpec:
        for key, section in ("sweep", self.sweep), ("branches", self.branches):
            needed = NEEDED.get(section.parameter or "load")
            if needed is not None and not getattr(self.loop, needed):
                problem = f"found {section.parameter!r}; needs loop.{needed}"
                raise SpecError(f"{key}.parameter", problem)
        others = {self.sweep.varied, self.explored} - {"load"}
        if not others and self.film.load is not None:
            problem = "is for runs that vary something else: loads are sweep.loads"
            raise SpecError("film.load", problem)
        if others and self.film.load is None:
            what = " and ".join(sorted(others))
            raise SpecError("film.load", f"is missing: the load at which {what} is varied")
        self.branches.check_window(self.explored)
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

    def column(self, varied: str) -> str:
        """Return the column of what is varied."""
        return FILM_LOADS[self.film.model].column if varied == "load" else varied

    def values(self) -> list[float]:
        """Return what is swept, loads or values of another parameter, in order."""
        return self.loads() if self.sweep.varied == "load" else self.sweep.in_order()

    def window(self) -> tuple[float, float]:
        """Return the window of branches; raises SpecError where it is none."""
        values = self.values() if self.explored == self.sweep.varied else []
        if self.explored == "load" and values:
            values = [load for load in values if load > 0] or [1.0]
        return self.branches.window(self.explored, values)

    def loads(self) -> list[float]:
        """Return the film's loads in the order in which they are swept."""
        if self.film.load is not None and self.sweep.varied != "load":
            return [self.film.load]
        scale = 1.0
        if self.sweep.quantity == FILM_LOADS[self.film.model].constant:
            length = self.loop.length
            # Not length**3, which raises where a product overflows to infinity.
            scale = length * length * length / self.loop.alpha
        return [scale * value for value in self.sweep.in_order()]


def load_run(path: Path, overrides: dict[str, Any]) -> RunSpec:
    """Read the specification of a film's run; see `read_spec`."""
    return read_spec(path, overrides, RunSpec)


def read_spec(path: Path, overrides: dict[str, Any], model: type[Model]) -> Model:
    """Read a specification, with `overrides` {dotted key: value} on top.

    A relative file that it names is looked for beside it. Raises SpecError.
    """
    data = read_toml(path)
    for key, value in overrides.items():
        override(data, key, value)
    return validate(located(data, path.parent), model, str(path))


def located(data: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Return a specification, read as plain data, with its files looked for in a folder."""
    for key in FILE_KEYS:
        name, _, entry = key.partition(".")
        section = data.get(name)
        if isinstance(section, dict) and isinstance(section.get(entry), str):
            section[entry] = str(folder / at_home(key, section[entry]))
    return data


def at_home(key: str, file: str) -> Path:
    """Return the path of a file, `~` being the home directory.

    Raises SpecError if nobody has that home, or no file can have the name.
    """
    if "\0" in file:
        raise SpecError(key, f"found {file!r}; a file's name holds no NUL")
    try:
        return Path(file).expanduser()
    except RuntimeError:
        raise SpecError(key, f"found {file!r}; whose home directory is not known") from None


def described(spec: Settings) -> dict[str, Any]:
    """Return a specification as run.json has it: files are found from wherever one is."""
    data: dict[str, Any] = spec.model_dump(mode="json")
    return located(data, Path.cwd())


def override(data: dict[str, Any], key: str, value: Any) -> None:
    """Replace a dotted key of a specification read as plain data; raises SpecError."""
    *sections, name = key.split(".")
    if not sections:
        raise SpecError(key, "should name its section, as in solver.name or sweep.loads")
    for section in sections:
        data = data.setdefault(section, {})
        if not isinstance(data, dict):
            raise SpecError(key, f"{section} is not a section of the specification")
    data[name] = value


def leaves(table: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the dotted keys of nested tables; how they are written makes no difference."""
    for key, value in table.items():
        if isinstance(value, dict) and value:
            yield from leaves(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value
