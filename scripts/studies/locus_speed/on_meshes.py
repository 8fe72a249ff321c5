"""First points of curves of special points of films on meshes."""

from __future__ import annotations

import math
from dataclasses import replace

from eulerplateau.branches import (
    BIFURCATION,
    LocusPoint,
    StepControl,
    locus_start,
    special_at,
)
from eulerplateau.branches.conformal import critical_moment
from eulerplateau.branches.film_family import family_near
from eulerplateau.solvers import Problem, sweep
from scripts.studies.common import make_mesh

_ROUND, _SOFT = 0.8, 0.1
# Loads at which lobes lie flat, the last next to that at which they twist.
_LOBES = {"area": (1500.0, 1700.0, 1800.0, 1870.0, 1880.0), "springs": (690.0, 699.7)}
_WINDOWS = {"area": (1700.0, 2300.0), "springs": (600.0, 1400.0)}
_OVER = {"twist_ratio": (0.0, 0.5), "link": (-1.0, 1.0)}


def of_round_film() -> LocusPoint:
    """Return where the disk at 500 yields to its twist, over link and load; a true film."""
    disk = make_mesh(polygon={"kind": "circle"}, vertices=474)
    near = critical_moment(500.0) / (4 * math.pi * _ROUND)
    problem = Problem(disk, "area", twist_ratio=_ROUND, link=near)
    family, x = family_near(problem, disk.shape, "link", 500.0)
    special = replace(special_at(family, x, near, BIFURCATION), multiplicity=2)
    first = StepControl((-0.1, 4.0), 4.0, least=-math.inf)
    return locus_start(special, "load", 500.0, (first, StepControl((20.0, 1500.0), 1500.0)))


def of_flat_lobes(film: str, second: str) -> LocusPoint:
    """Return where flat lobes twist, over their load and C/B, or the fold over the link."""
    polygon = {"kind": "stretched-hexagon", "factor": 2.0}
    problem = Problem(make_mesh(polygon=polygon, vertices=474), film, twist_ratio=_SOFT)
    *_, last = sweep(problem, _LOBES[film])
    family, x = family_near(problem, last.shape, "load", last.load)
    special = special_at(family, x, last.load, BIFURCATION)
    window, over = _WINDOWS[film], _OVER[second]
    first = StepControl(window, window[1])
    least = 0.0 if second == "twist_ratio" else -math.inf
    value = problem.value(second, last.load)
    return locus_start(
        special, second, value, (first, StepControl(over, over[1], least=least))
    )
