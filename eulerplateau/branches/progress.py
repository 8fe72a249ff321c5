"""How far an exploration has come: plain arrays from which it goes on, to the bit.

What an exploration does next depends on more than where it is: a soap film comes to rest
from where it last was, and its last digits with it. So every step begins with families made
from what was kept of them, whether that was just now or is read from a file.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.control import Direction
from eulerplateau.branches.family import Family
from eulerplateau.branches.point import BranchPoint
from eulerplateau.solvers import tangent_model

Arrays = Mapping[str, NDArray[Any]]


@dataclass(frozen=True)
class KeptPoint:
    """A point of a branch, and what makes its family again as it was there."""

    point: BranchPoint
    kept: Arrays

    @classmethod
    def of(cls, point: BranchPoint) -> KeptPoint:
        """Keep a point."""
        kept = point.family.kept(point.x)
        return cls(point, {name: array.copy() for name, array in kept.items()})

    def again(self) -> BranchPoint:
        """Return the point in a family that remembers nothing else."""
        family = self.point.family.restored(self.kept)
        if family is self.point.family:
            return self.point
        model = tangent_model(family.energy(self.point.value), self.point.x)
        return replace(self.point, family=family, model=model)


@dataclass(order=True, frozen=True)
class Lead:
    """A branch to follow: those from more stable points first, then as found."""

    n_unstable: int
    order: int
    start: KeptPoint = field(compare=False)
    origin: int | None = field(compare=False)


@dataclass(frozen=True)
class Progress:
    """All that the rest of an exploration depends on, between two of its steps.

    Attributes
    ----------
    leads : a heap
    met : the special points found: (loop (n, d) as it lies in space, value) of each
    order : int, how many leads there have been
    branch : int, the number of the branch that is followed, or of the next
    origin : int or None, the number of the special point it starts from
    here : the last point of the branch; None between two branches
    before : the last whose stability is beyond doubt
    step, left : as of a Place
    """

    leads: tuple[Lead, ...]
    met: tuple[tuple[FloatArray, float], ...] = ()
    order: int = 0
    branch: int = 0
    origin: int | None = None
    here: KeptPoint | None = None
    before: KeptPoint | None = None
    step: float = 0.0
    left: int = 0

    def ended(self) -> Progress:
        """Return the progress where the branch that is followed has ended."""
        return replace(self, branch=self.branch + 1, here=None, before=None)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Return it as arrays, for `progress_from`."""
        points = [lead.start for lead in self.leads]
        points += [self.here] if self.here is not None else []
        apart = self.before is not None and self.before is not self.here
        points += [self.before] if apart and self.before is not None else []
        leads = [(lead.n_unstable, lead.order, _number(lead.origin)) for lead in self.leads]
        counts = self.order, self.branch, _number(self.origin), self.left
        held = self.here is not None, apart
        found = {
            "leads": np.array(leads, dtype=np.int64).reshape(-1, 3),
            "counts": np.array([*counts, *held], dtype=np.int64),
            "step": np.array(self.step),
            "values": np.array([value for _, value in self.met]),
        }
        found |= {f"met.{k}": x for k, (x, _) in enumerate(self.met)}
        for k, point in enumerate(points):
            found |= {f"{k}.{name}": array for name, array in _arrays(point).items()}
        return found


def progress_from(arrays: Arrays, family: Family) -> Progress:
    """Return what `Progress.arrays` came from, in families like a given one.

    Raises KeyError or ValueError for arrays of anything else.
    """
    order, branch, origin, left, is_held, is_apart = (int(n) for n in arrays["counts"])
    points = _points(arrays, family)
    leads = tuple(
        Lead(int(n), int(k), next(points), _place(int(origin)))
        for n, k, origin in arrays["leads"]
    )
    here = next(points) if is_held else None
    met = tuple((arrays[f"met.{k}"], float(v)) for k, v in enumerate(arrays["values"]))
    return Progress(
        leads=leads,
        met=met,
        order=order,
        branch=branch,
        origin=_place(origin),
        here=here,
        before=next(points) if is_apart else here,
        step=float(arrays["step"]),
        left=left,
    )


def _arrays(point: KeptPoint) -> dict[str, NDArray[Any]]:
    at = point.point
    numbers = at.value, at.direction.rate, at.arclength, at.corrections
    return {
        "x": at.x,
        "displacement": at.direction.displacement,
        "numbers": np.array(numbers, dtype=np.float64),
        **{f"family.{name}": array for name, array in point.kept.items()},
    }


def _points(arrays: Arrays, family: Family) -> Iterator[KeptPoint]:
    k = 0
    while True:
        own = {
            name.removeprefix(f"{k}."): array
            for name, array in arrays.items()
            if name.startswith(f"{k}.")
        }
        value, rate, arclength, corrections = (float(number) for number in own["numbers"])
        kept = {
            name.removeprefix("family."): array
            for name, array in own.items()
            if name.startswith("family.")
        }
        made = family.restored(kept)
        model = tangent_model(made.energy(value), own["x"])
        direction = Direction(own["displacement"], rate)
        point = BranchPoint(made, model, value, direction, arclength, int(corrections))
        yield KeptPoint(point, kept)
        k += 1


def _number(origin: int | None) -> int:
    return -1 if origin is None else origin


def _place(number: int) -> int | None:
    return None if number < 0 else number
