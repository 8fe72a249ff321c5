"""Rows: what those of films and of cells have in common, and those of films."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import Any, Protocol, TypeVar

from eulerplateau.film import LOADS, SPRING_LOAD, Load
from eulerplateau.runs.parameters import own_parameter
from eulerplateau.solvers import Equilibrium, Status


class LoadName(Protocol):
    """What the load of a row is called."""

    @property
    def column(self) -> str:
        """Its column in every table."""

    @property
    def text(self) -> str:
        """Its name in ASCII."""

    @property
    def tex(self) -> str:
        """Its name in TeX."""

    @property
    def label(self) -> str:
        """Its name as a label of an axis."""

    @property
    def word(self) -> str:
        """What it is in a word or two."""

    @property
    def unit(self) -> str:
        """The unit in which it is shown; empty of a pure number."""

    def shown(self, value: float) -> float:
        """Return a value of its column in the unit in which it is shown."""


class Record(Protocol):
    """What a row has of whatever is followed in a parameter: a film, a cell."""

    @property
    def step(self) -> int:
        """Its number in the run."""

    @property
    def n_unstable(self) -> int | None:
        """The Morse index; None where it is not known."""

    @property
    def status(self) -> Status:
        """How the solver ended."""

    @property
    def load(self) -> float:
        """The parameter that is varied."""

    @property
    def load_name(self) -> LoadName:
        """What that is called."""

    @property
    def converged(self) -> bool:
        """Whether the row is an equilibrium to be trusted."""


class BranchRecord(Record, Protocol):
    """What a point of a branch has: see BranchRow."""

    @property
    def branch(self) -> int:
        """The number of the branch."""

    @property
    def origin(self) -> int | None:
        """The special point it starts from."""

    @property
    def special(self) -> int | None:
        """The number of this special point."""

    @property
    def arclength(self) -> float:
        """How far along the branch."""


@dataclass(frozen=True)
class Row:
    """One load of a sweep; its fields but the last, in this order, are sweep.csv's columns.

    `quantity` says which of kL3_alpha and sigma_hat is to be taken for the load, or which
    column for it where another parameter is varied, with the unit in which that is shown
    if it has one ("length_m in cm"); the table does not repeat it in every row, for
    run.json knows the film and what is varied.

    Units: lengths L, energies alpha/L, max_turning and waist_twist degrees. None is an
    empty cell ("not computed"); a float that came out as NaN or infinite is written `nan`
    or `inf`, so that the two stay apart (pandas reads an empty cell and `nan` as NaN).
    """

    step: int
    kL3_alpha: float  # noqa: N815 - the column's name
    sigma_hat: float
    energy: float
    film_energy: float
    bending_energy: float
    abs_kappa_n: float
    total_gauss_curvature: float
    area: float
    n_unstable: int | None
    lowest_eigenvalue: float | None
    residual: float
    length_error: float
    iterations: int
    seconds: float
    status: Status
    max_turning: float
    waist_twist: float
    self_intersections: int | None
    aspect: float
    min_angle: float
    film_residual: float
    quantity: str = field(default=SPRING_LOAD.column, kw_only=True)

    @property
    def load(self) -> float:
        """The load, in the unit that `quantity` says, or what is varied in place of it."""
        name = self.load_name
        return name.shown(float(getattr(self, name.column)))

    @property
    def energy_rate(self) -> float:
        """The derivative of the energy by what is varied, at an equilibrium."""
        own = own_parameter(self.quantity)
        return self.film_energy / self.load if own is None else own.energy_rate(self)

    @property
    def load_name(self) -> LoadName:
        """What this load is called."""
        return own_parameter(self.quantity) or LOADS[self.quantity]

    @property
    def converged(self) -> bool:
        """Whether the row is an equilibrium to be trusted."""
        return self.status is Status.CONVERGED


@dataclass(frozen=True)
class BranchRow(Row):
    """One point of a branch: a row of branches.csv, the columns of sweep.csv and these.

    Attributes
    ----------
    branch : int, counted from 0
    origin : int, the number of the special point the branch starts from; None for the first
    special : int, the number of this special point; None for a regular point
    arclength : float, from the special point the branch starts from, or its first point
    """

    branch: int
    origin: int | None
    special: int | None
    arclength: float


@dataclass(frozen=True)
class _OfTwist:
    """What a row says of the twist of a loop that resists it.

    Attributes
    ----------
    twist_energy : float, in units of alpha / L; a part of `energy`
    writhe, link : float, in turns; right-handed is positive
    twist_moment : float, M = C 2 pi (link - writhe) / L, in units of alpha / L
        That at the weld, where a rod is curved by nature and it is not the same everywhere.
    """

    twist_energy: float
    writhe: float
    link: float
    twist_moment: float


@dataclass(frozen=True)
class TwistRow(_OfTwist, Row):
    """One load, or link, of a sweep of a loop that resists twist."""


@dataclass(frozen=True)
class TwistBranchRow(_OfTwist, BranchRow):
    """One point of a branch of a loop that resists twist."""


@dataclass(frozen=True)
class _OfCurvedRod(_OfTwist):
    """What a row says of a loop that is curved by nature besides.

    Attributes
    ----------
    rest_curvature : float, the natural curvature over that of a circle
    """

    rest_curvature: float


@dataclass(frozen=True)
class CurvedRodRow(_OfCurvedRod, Row):
    """One load of a sweep of a loop that is curved by nature."""


@dataclass(frozen=True)
class CurvedRodBranchRow(_OfCurvedRod, BranchRow):
    """One point of a branch of a loop that is curved by nature."""


@dataclass(frozen=True)
class CatalogueRow(Row):
    """An equilibrium of a catalogue: the columns of sweep.csv and these.

    Attributes
    ----------
    number : int, among those at its load, by energy
    symmetry : str, in words
    by_starts, by_deflation : int, how many searches have come to it
    first_start, first_guess : int
        The first random loop, and the first guess of deflation, that led to it; 0 if it is
        where deflation begins, None if none did.
    """

    number: int
    symmetry: str
    by_starts: int
    by_deflation: int
    first_start: int | None
    first_guess: int | None


def columns(row_type: type[Any]) -> tuple[str, ...]:
    """Return the names of the columns of a table of such rows: their fields."""
    return tuple(column.name for column in fields(row_type) if not column.kw_only)


COLUMNS = columns(Row)

R = TypeVar("R", bound=Row)


def make_row(
    step: int, found: Equilibrium, load: Load, row_type: type[R], cells: dict[str, Any]
) -> R:
    """Return the row of an equilibrium; `cells` holds the fields of its Measures.

    `load` says what found.load is. Of a film with a tension, kL3_alpha is the load at which
    springs on equilateral triangles carry the same.
    """
    return row_type(
        step=step,
        kL3_alpha=load.springs(found.load),
        sigma_hat=load.tension(found.load),
        energy=found.energy,
        film_energy=found.film_energy,
        bending_energy=found.bending_energy,
        n_unstable=found.n_unstable,
        lowest_eigenvalue=found.lowest_eigenvalue,
        residual=found.residual,
        film_residual=found.film_residual,
        length_error=found.length_error,
        iterations=found.iterations,
        seconds=found.seconds,
        status=found.status,
        **{"quantity": load.column, **cells},
    )
