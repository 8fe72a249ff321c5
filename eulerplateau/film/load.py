"""The load of a film: the number its energy is proportional to, and what it is called.

Springs are loaded by k L^3 / alpha, films with a tension by sigma_hat = sigma L^3 / alpha.
A record carries both; where a film has one load, as on an axis, it is the film's own.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

# sigma = 2 sqrt(3) k on equilateral triangles when the loop is inextensible: the interior
# edges then carry the whole Dirichlet energy (docs/films.md).
SPRING_TENSION = 2 * math.sqrt(3.0)


@dataclass(frozen=True)
class Load:
    """One of the two loads.

    Attributes
    ----------
    column : str, its column in every table, and what sweep.quantity calls it
    constant : str, what sweep.quantity calls the film's constant: load = constant L^3/alpha
    tension_per_load : float, effective sigma_hat per unit of load
    text, tex : its name in ASCII and in TeX
    """

    column: str
    constant: str
    tension_per_load: float
    text: str
    tex: str

    def tension(self, load: float) -> float:
        """Return the sigma_hat of such a load."""
        return self.tension_per_load * load

    def springs(self, load: float) -> float:
        """Return the k L^3/alpha of such a load: exactly itself if that is what it is."""
        return self.tension_per_load / SPRING_TENSION * load

    @property
    def word(self) -> str:
        """What it is in a word."""
        return "load"

    @property
    def unit(self) -> str:
        """That in which it is shown: a pure number has none."""
        return ""

    def shown(self, value: float) -> float:
        """Return a value of the column as it is shown: itself."""
        return value

    @property
    def label(self) -> str:
        """The name as a label of an axis."""
        return f"${self.tex}$"


_TEX = r"kL^3/\alpha", r"\hat\sigma"
SPRING_LOAD = Load("kL3_alpha", "k", SPRING_TENSION, "kL3/alpha", _TEX[0])
TENSION = Load("sigma_hat", "sigma", 1.0, "sigma_hat", _TEX[1])

# By the films' names, as in film.model.
FILM_LOADS = {"springs": SPRING_LOAD, "dirichlet": TENSION, "area": TENSION}
LOADS = {load.column: load for load in (SPRING_LOAD, TENSION)}
