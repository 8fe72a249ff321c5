"""Rows of cells: sweep.csv and branches.csv of `eulerplateau cell`."""

from __future__ import annotations

from dataclasses import dataclass, field

from eulerplateau.solvers import Status


@dataclass(frozen=True)
class CellParameter:
    """What is varied along a run of a cell; see table.LoadName.

    Attributes
    ----------
    energy : str, the column of the part of the energy that is proportional to it
    meaning : str, what it is in words; with its definition in TeX
    """

    column: str
    text: str
    tex: str
    energy: str
    meaning: str

    @property
    def label(self) -> str:
        """The name as a label of an axis."""
        return self.meaning

    @property
    def word(self) -> str:
        """What it is in a word or two."""
        return self.meaning.partition(" $")[0]

    @property
    def unit(self) -> str:
        """That in which it is shown: a pure number has none."""
        return ""

    def shown(self, value: float) -> float:
        """Return a value of the column as it is shown: itself."""
        return value


CELL_PARAMETERS = {
    "sigma_hat": CellParameter(
        "sigma_hat",
        "sigma_hat",
        r"\hat\sigma",
        "film_energy",
        r"contractility $\hat\sigma=\sigma R_0^3/\alpha$",
    ),
    "ks_hat": CellParameter(
        "ks_hat",
        "ks_hat",
        r"\hat k_s",
        "adhesion_energy",
        r"stiffness of the adhesions $\hat k_s=k_s R_0^3/\alpha$",
    ),
}


@dataclass(frozen=True)
class CellRow:
    """One state of a cell; its fields but the last, in this order, are the columns.

    Units: lengths R_0, energies alpha / R_0, forces alpha / R_0^2, max_turning degrees.
    Over the cell's adhesions kappa_adhesion, extension and traction are means, over its
    sides kappa_mid is the least: below zero a side is inflected. largest_traction is that
    of one adhesion, tangential the largest |(r - r_0).t|.
    """

    step: int
    sigma_hat: float
    ks_hat: float
    beta_hat: float
    energy: float
    bending_energy: float
    film_energy: float
    adhesion_energy: float
    line_energy: float
    perimeter: float
    area: float
    kappa_adhesion: float
    kappa_mid: float
    extension: float
    traction: float
    largest_traction: float
    tangential: float
    n_unstable: int | None
    lowest_eigenvalue: float | None
    residual: float
    iterations: int
    seconds: float
    status: Status
    max_turning: float
    quantity: str = field(default="sigma_hat", kw_only=True)

    @property
    def load(self) -> float:
        """What is varied, by the name `quantity`."""
        return float(getattr(self, self.quantity))

    @property
    def load_energy(self) -> float:
        """The part of the energy that is proportional to it."""
        return float(getattr(self, self.load_name.energy))

    @property
    def energy_rate(self) -> float:
        """The derivative of the energy by what is varied, at an equilibrium."""
        return self.load_energy / self.load

    @property
    def load_name(self) -> CellParameter:
        """What that is called."""
        return CELL_PARAMETERS[self.quantity]

    @property
    def converged(self) -> bool:
        """Whether the row is an equilibrium to be trusted."""
        return self.status is Status.CONVERGED


@dataclass(frozen=True)
class CellBranchRow(CellRow):
    """One point of a branch of a cell: see BranchRow."""

    branch: int
    origin: int | None
    special: int | None
    arclength: float
