"""Special points of the eight in contact: its fold in the link, and where it opens.

At one load and diameter the films are the same whatever resists twist; a softer rod has to
be turned farther for each, and no farther than to its fold.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from eulerplateau.branches import (
    BranchPoint,
    StepControl,
    equilibrium,
    equilibrium_near,
    film_point,
    point_near,
)
from eulerplateau.branches.conformal import ThickEight, thick_eight
from eulerplateau.branches.conformal.contact_eight import measured, reached, touching
from eulerplateau.branches.conformal.touching import Touching
from eulerplateau.branches.continuation import Kink
from eulerplateau.branches.point import first_point
from eulerplateau.branches.special import FOLD
from eulerplateau.solvers import Problem
from scripts.studies.contact_eight.on_meshes import eight_on, round_disk
from scripts.studies.contact_eight.unstable import same_of
from tests.branches.test_contact_branches import forces, kinks, places
from tests.branches.test_special_in_contact import back, first_special, unstable

LOAD, DIAMETER = 600.0, 0.02
# C/B; the stiff rod's link before the soft one's fold, and about there.
STIFF, SOFT = 3.0, 0.2
BEFORE, ABOUT = 1.33, 1.48


@cache
def stiff() -> Touching:
    values = {"load": LOAD, "twist_ratio": STIFF, "link": 1.0, "diameter": DIAMETER}
    return reached(touching(values), {**values, "link": BEFORE})


@cache
def rods() -> tuple[ThickEight, ThickEight]:
    """One film before the fold, of both rods."""
    return measured(stiff()), measured(same_of(stiff(), SOFT))


@cache
def without_mesh() -> float:
    """The most that the soft rod can be turned, by films of the stiff one."""
    near = reached(stiff(), {**stiff().values, "link": ABOUT})

    def turned(link: float) -> float:
        film = reached(near, {**near.values, "link": link})
        assert film.force > 0
        assert film.convexity > 0.1
        writhe = film.family.twist(LOAD).writhe(film.x)
        return float(writhe + (link - writhe) * STIFF / SOFT)

    bracket = (ABOUT - 0.02, ABOUT, ABOUT + 0.02)
    return -float(minimize_scalar(lambda link: -turned(link), bracket=bracket).fun)


def on_mesh(edges: int) -> float:
    """The link at the fold on a mesh, met from both sides."""
    mesh, (hard, soft) = round_disk(edges), rods()
    rod = {"twist_ratio": SOFT, "link": soft.link, "diameter": DIAMETER}
    problem = Problem(mesh, "area", refine=False, **rod)
    start = equilibrium_near(problem, eight_on(mesh, hard).shape, LOAD)
    control = StepControl((4.0, 6.0), unit=6.0, first_step=0.01, largest_step=0.02)
    special, _, after = found = first_special(
        film_point(start, problem, control, "link"), control
    )
    assert special.kind == FOLD
    assert unstable(found) == (0, 1)
    assert len(special.point.model.tensions) == edges + 1
    other, _, _ = first_special(back(after), control)
    assert other.point.value == pytest.approx(special.point.value, rel=1e-10)
    return special.point.value


@pytest.mark.slow
def test_the_fold_in_contact_is_of_second_order() -> None:
    errors = [on_mesh(edges) - without_mesh() for edges in (60, 120)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)
    assert abs(errors[1]) < 0.01 * without_mesh()


def parting(start: BranchPoint, control: StepControl) -> Kink:
    """Where strands part on the way down from a point."""
    (kink,) = kinks(list(places(back(start), 8, control)), "parts")
    return kink


@pytest.mark.slow
def test_a_film_made_anew_where_strands_part_has_them_part_there() -> None:
    """Met from above, in the film that is good near where it was met before."""
    mesh, film = round_disk(60), thick_eight(1450.0, 0.05)
    problem = Problem(mesh, "area", diameter=0.05)
    control = StepControl((500.0, 2000.0), unit=2000.0)
    there = parting(film_point(eight_on(mesh, film), problem, control), control).before
    assert equilibrium(there).residual < 1e-8
    assert np.abs(forces(there)).max() < 1e-8
    above = point_near(there.family.near(there.x), there.x, there.value + 10.0)
    assert above is not None
    again = first_point(above.family, above.x, above.value, control)
    assert parting(again, control).before.value == pytest.approx(there.value, rel=1e-9)
