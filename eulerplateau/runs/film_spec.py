"""What a run specification may say of its film."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from eulerplateau.runs.bench_spec import SurfaceTension
from eulerplateau.settings import Settings


class FilmSettings(Settings):
    """Which film spans the loop: springs, Dirichlet's energy, or the true area.

    Attributes
    ----------
    plane : bool
        Keeps a film of the true area in its plane, where its loop is all it needs.
    refine : bool
        Whether in sweeps a film of the true area is made finer where strands of a loop that
        has a diameter cross.
    load : float, k L^3 / alpha of springs and sigma_hat of other films
        Where another parameter than the load is varied: that at which it is.
    surface_tension : float in N/m, or "25 mN/m"
        Of the liquid: gamma, of which the film's tension is twice. With [rod] and
        loop.length it sets the load.
    """

    model: Literal["springs", "dirichlet", "area"] = "springs"
    plane: bool = False
    refine: bool = True
    load: float | None = Field(default=None, ge=0)
    surface_tension: SurfaceTension | None = None
