"""The share of outlines whose fitted intervals hold the truth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eulerplateau.exact.outline import fit_outline
from scripts.studies.outline_fit.outlines import LENGTH, outline

QUANTITIES = ("sigma_hat", "size", "strength")


@dataclass(frozen=True)
class Hit:
    """Whether the intervals of one outline hold the truth; the load's half width.

    And whether the outline was taken for that of another curve.
    """

    kind: str
    sigma_hat: bool
    size: bool
    strength: bool
    lobes: bool
    width: float
    misfit: bool


def hit(number: int, seed: int) -> Hit:
    """Fit one outline."""
    made = outline(number, np.random.default_rng((seed, number)))
    fit = fit_outline(made.points)
    load = fit.sigma_hat
    assert load is not None
    truth = {"size": LENGTH, "strength": made.sigma_hat / LENGTH**3}
    inside = {
        name: getattr(fit, name).low <= value <= getattr(fit, name).high
        for name, value in truth.items()
    }
    return Hit(
        made.kind,
        sigma_hat=load.low <= made.sigma_hat <= load.high,
        lobes=fit.lobes == made.lobes,
        width=(load.high - load.low) / 2 / made.sigma_hat,
        misfit=fit.is_misfit,
        **inside,
    )
