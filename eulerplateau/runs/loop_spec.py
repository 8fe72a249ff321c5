"""What a run specification may say of its loop: of which rod it is made."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from eulerplateau.errors import SpecError
from eulerplateau.loop import MOST
from eulerplateau.runs.bench_spec import Length
from eulerplateau.settings import Settings

_Diameter = Annotated[float, Field(gt=0, le=MOST["diameter"])]


class LoopSettings(Settings):
    """The loop's bending modulus and length: they turn a film's constant into a load.

    And its twist: without `twist_ratio` that escapes, and costs nothing. And what it was
    before its ends were welded, which is no matter to a rod whose twist escapes. And its
    thickness: without `diameter` it has none, and its strands pass through each other.

    Attributes
    ----------
    alpha : float
        Bending energy is alpha * kappa^2 per length (the rod's rigidity is 2 alpha).
    length : float, or "20 cm"
        In m, where the load is set by [rod] and film.surface_tension.
    twist_ratio : float or "rod"
        C / B, the rigidity to twist over that to bending: 2/3 to 1 for a round rod. "rod"
        takes it from rod.poisson_ratio.
    link : float
        Turns that the rod was given before its ends were welded; by default none.
    rest_curvature : float
        The rod's natural curvature over 2 pi / length, that of a circle; by default none.
    diameter : float or "rod"
        The rod's thickness over its length; its strands touch and pass through nothing.
        "rod" takes it from rod.diameter and length.
    """

    alpha: float = Field(default=1.0, gt=0)
    length: Length = 1.0
    twist_ratio: Annotated[float, Field(gt=0)] | Literal["rod"] | None = None
    link: float | None = None
    rest_curvature: float | None = Field(default=None, ge=0)
    diameter: _Diameter | Literal["rod"] | None = None

    @model_validator(mode="after")
    def _a_rod_needs_a_rigidity(self) -> LoopSettings:
        if self.twist_ratio is None:
            lost = "needs loop.twist_ratio: twist that costs nothing is lost"
            for name in ("link", "rest_curvature"):
                if getattr(self, name) is not None:
                    raise SpecError(f"loop.{name}", lost)
        return self

    def refuse_thickness(self, who: str) -> None:
        """Raise SpecError where the loop has a diameter and `who` know no contact."""
        if self.diameter is not None:
            problem = f"should be absent: {who} know no contact; sweeps and branches do"
            raise SpecError("loop.diameter", problem)
