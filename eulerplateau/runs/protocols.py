"""What rows of all kinds have in common: those of films and of cells."""

from __future__ import annotations

from typing import Protocol

from eulerplateau.solvers import Status


class LoadName(Protocol):
    """What the load of a row is called."""

    @property
    def column(self) -> str:
        """Its column in every table."""

    @property
    def text(self) -> str:
        """Its name in ASCII."""

    @property
    def symbol(self) -> str:
        """Its name in Unicode."""

    @property
    def tex(self) -> str:
        """Its name in TeX."""

    @property
    def label(self) -> str:
        """Its name as a label of an axis."""


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
