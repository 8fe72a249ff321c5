"""A run of a thick loop, up and down, next to the films without a mesh at its loads."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import degrees
from pathlib import Path
from typing import Any

from eulerplateau.branches.conformal.contact_eight import reached, refined, touching
from eulerplateau.branches.conformal.touching import Touching, crowding
from eulerplateau.exact import planar_film
from eulerplateau.exact.conformal import BUCKLING, flat_eight, twisted_film
from eulerplateau.runs import read_run

# As their crossing closes the ends of the loop crowd on the conformal grid: films in
# contact are computed up to where they do so by this.
_CROWDED = 1e-11


@dataclass(frozen=True)
class Cycle:
    """The rows of a sweep up and down at one diameter, of a loop whose twist escapes."""

    rows: Sequence[Any]
    diameter: float

    @classmethod
    def of_run(cls, folder: Path) -> Cycle:
        """Return that of a run's folder."""
        run = read_run(folder)
        return cls(run.rows, float(run.about["spec"]["loop"]["diameter"]))

    @property
    def top(self) -> int:
        """The step of the highest load."""
        return int(max(self.rows, key=lambda row: row.sigma_hat).step)

    @property
    def up(self) -> dict[float, Any]:
        """The rows of rising load, by load."""
        return {row.sigma_hat: row for row in self.rows if row.step <= self.top}

    @property
    def down(self) -> dict[float, Any]:
        """The rows of falling load, and the highest, by load."""
        return {row.sigma_hat: row for row in self.rows if row.step >= self.top}

    @cached_property
    def eights(self) -> dict[float, Touching]:
        """The eights in contact without a mesh, at the loads at which one point touches."""
        opens = twisted_film(self.diameter).load
        films: dict[float, Touching] = {}
        for load in filter(self._is_known, sorted(self.up)):
            if load <= opens:
                continue
            values = {"load": load, "twist_ratio": 0.0, "link": 0.0}
            wanted = {**values, "diameter": self.diameter}
            last = films[max(films)] if films else touching(wanted)
            films[load] = reached(last, wanted)
        return films

    def _is_known(self, load: float) -> bool:
        """Return whether a row touches in one point where harmonics resolve that."""
        rows = [way[load] for way in (self.up, self.down) if load in way]
        if not any(row.contacts == 1 for row in rows):
            return False
        angle = degrees(2 * abs(flat_eight(load).angle))
        return crowding(self.diameter, angle) > _CROWDED

    def table(self) -> Iterator[list[str]]:
        """Yield a head, then by load: states up and down, the film, a mesh's errors."""
        yield [
            "load",
            "up",
            "down",
            "energy",
            "force",
            "angle",
            "energy, mesh",
            "force, mesh",
            "angle, mesh",
        ]
        for load, up in sorted(self.up.items()):
            down = self.down.get(load)
            row = down if down is not None else up
            yield [
                f"{load:g}",
                _state(up),
                "" if down is None else _state(down),
                *self._numbers(load, row),
            ]

    def _numbers(self, load: float, row: Any) -> list[str]:
        """Return the numbers of a row's film without a mesh, and what the mesh is off."""
        if row.contacts == 0:
            flat = planar_film(2, load)
            off = row.energy / flat.energy - 1
            return [f"{flat.energy:.4f}", "", "", f"{off:.0e}", "", ""]
        if load not in self.eights:
            return ["-"] * 6
        _, exact = refined(self.eights[load])
        angle = exact.crossing.angle
        return [
            f"{exact.energy:.4f}",
            f"{exact.force:.3f}",
            f"{angle:.2f}",
            f"{row.energy / exact.energy - 1:.0e}",
            f"{row.contact_force / exact.force - 1:.0e}",
            f"{row.crossing_angle - angle:.2f}",
        ]


def _state(row: Any) -> str:
    """Return in words what a row's film is."""
    if not row.converged:
        return str(row.status.value)
    if row.contacts == 0:
        return "disk" if row.sigma_hat < BUCKLING else "two lobes"
    return "eight" if row.contacts == 1 else f"{row.contacts} places"
