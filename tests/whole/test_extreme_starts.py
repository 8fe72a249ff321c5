"""Starts that look like nothing: the minimum all the same, or no word of convergence."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
import pytest

from eulerplateau.solvers.equilibrium import Equilibrium, Status
from tests.helpers.extremes import FIXED, cases, oval

Change = Callable[[cases.DisplacedDisk], cases.DisplacedDisk]
STARTS: dict[str, Change] = {
    "crumpled a little": partial(cases.crumpled, size=0.05),
    "crumpled beyond recognition": partial(cases.crumpled, size=0.5),
    "crumpled, ten times too large": partial(cases.crumpled, size=5.0),
    "crossed in the plane": cases.crossed,
    "doubly covered in the plane": cases.doubly_covered,
}
NOT_NUMBERS = (np.nan, np.inf, -np.inf)


def found(case: cases.DisplacedDisk, film: str, load: float, solver: str) -> Equilibrium:
    result = cases.run(case, film, load, solver).found
    assert result is not None
    return result


@pytest.mark.parametrize("start", STARTS)
@pytest.mark.parametrize("film", FIXED)
@pytest.mark.parametrize("tension", [0.0, 1000.0])
def test_newton_reaches_the_only_minimum_to_1e_11_from(
    start: str, film: str, tension: float
) -> None:
    """Below the disk's first threshold, 1488, there is no other."""
    load = cases.own_load(film, tension)
    expected = found(oval(), film, load, "newton")
    reached = found(STARTS[start](oval()), film, load, "newton")
    assert reached.status is expected.status is Status.CONVERGED
    assert reached.energy == pytest.approx(expected.energy, rel=1e-11)
    assert reached.n_unstable == 0


@pytest.mark.parametrize("start", STARTS)
@pytest.mark.parametrize("film", FIXED)
def test_cg_reaches_the_only_minimum_to_1e_8_from(start: str, film: str) -> None:
    load = cases.own_load(film, 1000.0)
    expected = found(oval(4), film, load, "newton")
    reached = found(STARTS[start](oval(4)), film, load, "cg")
    assert reached.status is Status.CONVERGED
    assert reached.energy == pytest.approx(expected.energy, rel=1e-8)


@pytest.mark.parametrize("start", STARTS)
@pytest.mark.parametrize("film", FIXED)
@pytest.mark.parametrize("tension", [2600.0, 5200.0])
def test_with_several_minima_newton_ends_in_one_of_them_from(
    start: str, film: str, tension: float
) -> None:
    """Balanced to 1e-9 and with no way down: nothing that merely looks like one."""
    case = STARTS[start](oval())
    outcome = cases.run(case, film, cases.own_load(film, tension))
    assert outcome.word in ("converged", "unresolved")
    assert outcome.found is not None
    assert outcome.found.residual < 1e-9
    assert outcome.found.n_unstable == 0


@pytest.mark.parametrize("solver", cases.SOLVERS)
@pytest.mark.parametrize("value", NOT_NUMBERS)
@pytest.mark.parametrize("film", FIXED)
def test_start_that_is_not_finite_is_refused_before_any_step(
    film: str, value: float, solver: str
) -> None:
    result = found(cases.started_as(oval(), value), film, 300.0, solver)
    assert result.status is Status.NOT_FINITE
    assert result.iterations == 0
    assert np.isnan(result.residual)


@pytest.mark.parametrize("solver", cases.SOLVERS)
@pytest.mark.parametrize("film", FIXED)
def test_start_that_is_a_point_is_not_called_converged(film: str, solver: str) -> None:
    result = found(cases.as_a_point(oval()), film, 300.0, solver)
    assert result.status is Status.STALLED


@pytest.mark.parametrize("film", FIXED)
def test_start_on_a_line_is_reached_from_or_not_called_converged(film: str) -> None:
    """No direction leads off the line; and what has no area has no axes."""
    case = cases.started_as(oval(), 0.0)
    displacement = -oval().mesh.x * [0.0, 1.0, 1.0]
    outcome = cases.run(
        cases.DisplacedDisk(case.points, case.triangles, displacement), film, 300.0
    )
    assert outcome.word == "stalled"
    assert outcome.measures is not None
    assert np.isnan(outcome.measures["aspect"])
