"""Which rod a loop is made of, in the numbers that one gives."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import isfinite

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError
from eulerplateau.loop.loop import Loop
from eulerplateau.loop.term import MOST


@dataclass(frozen=True)
class Rod:
    """What a rod resists beside bending, and what it was before its ends were welded.

    Attributes
    ----------
    twist_ratio : C / B, the rigidities' ratio; None if twist escapes, and costs nothing
    link : the turns it was given
    rest_curvature : q = k0 L / 2 pi, its natural curvature over that of a circle
    diameter : its thickness, in units of L; None if its strands only meet
    """

    twist_ratio: float | None = None
    link: float = 0.0
    rest_curvature: float = 0.0
    diameter: float | None = None

    def loop(self, rest_lengths: FloatArray, in_plane: bool) -> Loop:
        """Return a loop of the rod; raises SpecError for numbers that no rod has.

        rest_lengths : (n_b,) float, of its edges; in_plane : whether it is kept in a plane
        """
        self._refuse_what_is_no_number()
        self._refuse_wrong_diameter()
        bare = Loop(rest_lengths, diameter=self.diameter)
        if self.twist_ratio is None:
            self._refuse_without_twist()
            return bare
        self._refuse_wrong_numbers(self.twist_ratio)
        if self.rest_curvature != 0.0:
            if in_plane:
                problem = "is known for films in space; leave out plane, or this"
                raise SpecError("rest_curvature", problem)
            # Loaded for such loops only, and what is below likewise.
            from eulerplateau.loop.curved_rod import CurvedRod

            rod = CurvedRod(bare, self.twist_ratio, self.link, self.rest_curvature)
            return replace(bare, terms={"rod": rod})
        from eulerplateau.loop.twist import PlaneTwist, Twist

        twist = PlaneTwist if in_plane else Twist
        terms = {"twist": twist(bare, self.twist_ratio, self.link)}
        return replace(bare, terms=terms)

    def _refuse_what_is_no_number(self) -> None:
        for name, value in vars(self).items():
            try:
                isfinite(0.0 if value is None else value)
            except TypeError:
                raise SpecError(name, f"found {value!r}; should be a number") from None

    def _refuse_wrong_diameter(self) -> None:
        most = MOST["diameter"]
        if self.diameter is not None and not 0.0 < self.diameter <= most:
            problem = f"found {self.diameter:g}; should be above 0, up to {most:g}"
            raise SpecError("diameter", problem)

    def _refuse_without_twist(self) -> None:
        if self.link != 0.0:
            raise SpecError("link", "needs twist_ratio: twist that costs nothing is lost")
        if self.rest_curvature != 0.0:
            problem = "needs twist_ratio: a rod that twists for nothing turns as it likes"
            raise SpecError("rest_curvature", problem)

    def _refuse_wrong_numbers(self, twist_ratio: float) -> None:
        if not (twist_ratio > 0.0 and isfinite(twist_ratio)):
            raise SpecError("twist_ratio", f"found {twist_ratio:g}; should be positive")
        if not isfinite(self.link):
            raise SpecError("link", f"found {self.link:g}; should be a number of turns")
        if not 0.0 <= self.rest_curvature < float("inf"):
            problem = f"found {self.rest_curvature:g}; should be a number, 0 or more"
            raise SpecError("rest_curvature", problem)
