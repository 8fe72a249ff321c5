"""What films of given writhe say: which rods stay flat, and which loops stay twisted."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import pi

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from eulerplateau.branches.conformal import critical_moment
from eulerplateau.exact.conformal import BUCKLING
from scripts.studies.welded_loop.curves import NONE, Row, first_rows, ratio_at_no_writhe

ISOTROPIC = (2 / 3, 1.0)


@dataclass(frozen=True)
class Load:
    """What holds at one load.

    Attributes
    ----------
    flat : C/B above which the flat film (lobes, or the disk's pitchfork) is kept
    every : C/B above which there is one stable film for every link, from flat to pinched
    twisted : C/B below which a rod welded straight has a stable twisted film
    """

    load: float
    flat: float
    every: float
    twisted: float
    steepest: float


def at_load(rows: list[Row]) -> Load:
    """Return what the films at one load say."""
    return Load(
        load=rows[0].load,
        flat=ratio_at_no_writhe(rows)[0],
        every=max(row.ratio for row in rows),
        twisted=max(
            -row.moment / (4 * pi * row.writhe) for row in rows if row.writhe > NONE
        ),
        steepest=max(rows, key=lambda row: row.ratio).writhe,
    )


@cache
def nature(load: float) -> tuple[float, float]:
    """Return C/B at no writhe and its change: beside lobes positive is subcritical."""
    return ratio_at_no_writhe(first_rows(load))


def hardest() -> tuple[float, float]:
    """Return the C/B above which lobes stay flat at every load, and where that is asked."""
    found = minimize_scalar(
        lambda load: -nature(load)[0], bounds=(2220.0, 2420.0), options={"xatol": 0.05}
    )
    return float(-found.fun), float(found.x)


def flat_up_to(twist_ratio: float) -> float:
    """Return the load up to which a rod welded straight, of C/B below 0.48, stays flat."""
    window = (1856.0, 2200.0)
    return float(brentq(lambda load: nature(load)[0] - twist_ratio, *window, xtol=1e-6))


def nature_changes() -> tuple[float, float]:
    """Return load and C/B at which the twist's pitchfork turns supercritical."""
    load = float(brentq(lambda load: nature(load)[1], 1900.0, 2300.0, xtol=1e-3))
    return load, nature(load)[0]


def disk_turns_supercritical(twist_ratio: float) -> float:
    """Return the load above which the disk's pitchfork in the link is supercritical."""
    window = (100.0, 0.995 * BUCKLING)
    return float(brentq(lambda load: nature(load)[0] - twist_ratio, *window, xtol=1e-4))


def disk_link(load: float, twist_ratio: float) -> float:
    """Return the link at which the disk yields."""
    return critical_moment(load) / (4 * pi * twist_ratio)


def snaps(rows: list[Row], twist_ratio: float) -> list[tuple[float, float]]:
    """Return (link, writhe) of the folds in the link that films of these rows meet."""
    links = np.array([row.link(twist_ratio) for row in rows])
    turns = np.flatnonzero(np.diff(np.sign(np.diff(links)))) + 1
    return [(float(links[i]), rows[i].writhe) for i in turns]
