"""Loads from nothing to far beyond what a mesh can carry: right, or not called right."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.errors import SpecError
from eulerplateau.loop.lengths import close_with_lengths
from eulerplateau.loop.loop import largest_turning
from eulerplateau.mesh.disk import Disk
from eulerplateau.runs.spec import RunSpec
from eulerplateau.settings import validate
from eulerplateau.solvers import Equilibrium, Problem, Status, solve
from tests.helpers import equilibria
from tests.helpers.extremes import FIXED, cases, oval
from tests.helpers.marks import quick_with

TINY = (0.0, 1e-300, 1e-12, 1e-6)
HUGE = (1e5, 1e6, 1e8, 1e12)


def solved(film: str, load: float, solver: str = "newton", rings: int = 6) -> Equilibrium:
    found = cases.run(oval(rings), film, load, solver).found
    assert found is not None
    return found


@pytest.mark.parametrize("load", TINY)
@pytest.mark.parametrize("film", FIXED)
def test_load_next_to_nothing_adds_its_film_to_the_bare_loop_to_1e_11(
    film: str, load: float
) -> None:
    """E(l) = E(0) + l F(0) + O(l^2), the loop being that of least bending energy."""
    bare, found = solved(film, 0.0), solved(film, load)
    assert found.status is Status.CONVERGED
    slope = Problem(oval().mesh, film).film.energy_gradient(bare.shape, 1.0)[0]
    assert found.energy == pytest.approx(bare.energy + load * slope, rel=1e-11)
    assert found.film_energy == pytest.approx(load * slope, rel=1e-6)


@pytest.mark.parametrize("solver", cases.SOLVERS)
@pytest.mark.parametrize("load", TINY)
@pytest.mark.parametrize("film", FIXED)
def test_film_too_soft_to_be_felt_is_flat_and_at_rest_all_the_same(
    film: str, load: float, solver: str
) -> None:
    outcome = cases.run(oval(3), film, load, solver)
    assert outcome.word == "converged"
    assert outcome.measures is not None
    assert outcome.measures["abs_kappa_n"] < 1e-6
    assert outcome.measures["self_intersections"] == 0


# By conjugate gradients, which take a second each, the least and the greatest.
ENDS = [(load, solver) for load in HUGE for solver in cases.SOLVERS]
QUICK = [end for end in ENDS if end[1] == "newton" or end[0] in (HUGE[0], HUGE[-1])]


@pytest.mark.parametrize(("load", "solver"), quick_with(QUICK, ENDS))
@pytest.mark.parametrize("film", FIXED)
def test_load_beyond_the_mesh_ends_and_is_never_called_converged(
    film: str, load: float, solver: str
) -> None:
    case = oval(3)
    problem, start = Problem(case.mesh, film), case.mesh.x + case.displacement
    found = solve(problem, load, start, solver=solver, max_iterations=2000)
    assert found.status not in (Status.CONVERGED, Status.NOT_FINITE)
    assert found.iterations < 2 * 2000
    assert np.isfinite(found.energy)
    if found.status is Status.UNRESOLVED:
        assert equilibria.turning(found.shape.x_loop) > 30


@pytest.mark.parametrize("load", HUGE)
@pytest.mark.parametrize("film", FIXED)
def test_unresolved_equilibria_balance_all_the_same(film: str, load: float) -> None:
    """The status is about the mesh, not about the residual."""
    found = solved(film, load)
    assert found.status is Status.UNRESOLVED
    assert found.residual < 1e-10
    assert found.length_error < 1e-12


@pytest.mark.parametrize("solver", cases.SOLVERS)
@pytest.mark.parametrize("load", [1e101, 1e200, 1e308, np.inf])
def test_load_whose_forces_overflow_is_refused_as_not_finite(
    load: float, solver: str
) -> None:
    found = solved("springs", load, solver)
    assert found.status is Status.NOT_FINITE
    assert found.iterations == 0


@pytest.mark.parametrize("solver", cases.SOLVERS)
def test_load_that_is_no_number_is_refused_by_name(solver: str) -> None:
    with pytest.raises(SpecError) as caught:
        solved("springs", np.nan, solver)
    assert caught.value.key == "load"


@pytest.mark.parametrize("alpha", [1.0, 2.0**-10, 2.0**-20, 2.0**-40])
def test_bending_modulus_to_zero_at_fixed_spring_constant_is_the_load_to_infinity(
    alpha: float,
) -> None:
    settings = {
        "mesh": {"file": "any.vtp"},
        "loop": {"alpha": alpha, "length": 2.0},
        "sweep": {"loads": [64.0], "quantity": "k"},
    }
    spec = validate(settings, RunSpec, "case")
    assert spec.loads() == [64.0 * 8 / alpha]
    status = solved("springs", spec.loads()[0]).status
    assert status is (Status.CONVERGED if alpha == 1.0 else Status.UNRESOLVED)


@pytest.mark.parametrize("film", FIXED)
def test_unresolved_loop_is_resolved_by_a_finer_mesh(film: str) -> None:
    load = cases.own_load(film, 8000.0)
    coarse, fine, finest = (solved(film, load, rings=rings) for rings in (5, 10, 20))
    assert coarse.status is Status.UNRESOLVED
    assert fine.status is finest.status is Status.CONVERGED
    assert abs(fine.energy - finest.energy) < abs(coarse.energy - finest.energy)


@pytest.mark.parametrize(("sides", "status"), [(11, "unresolved"), (12, "converged")])
def test_regular_polygon_is_resolved_from_twelve_sides_on(sides: int, status: str) -> None:
    """A dodecagon turns by exactly 30 degrees: not by more."""
    assert cases.run(cases.polygon(sides), "springs", 0.0).word == status


@pytest.mark.parametrize("angle", [0.0, 10.0, 90.0, 170.0, 180.0])
def test_largest_turning_of_a_bent_square_is_the_angle_it_is_bent_by(angle: float) -> None:
    """Four equal edges; the rhombus closes whatever its angle."""
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    x = np.array([[0, 0, 0], [1, 0, 0], [1 + c, s, 0], [c, s, 0]]) / 4
    turning = largest_turning(x)
    assert turning == pytest.approx(max(angle, 180.0 - angle), abs=1e-12)


@pytest.mark.parametrize("bend", [1.0, 1.5, 2.0, 3.0])
def test_any_record_is_judged_by_its_loop_alone(bend: float) -> None:
    """The rule is the problem's: solvers and branches ask it about every shape."""
    problem = Problem(oval().mesh)
    guess = oval().mesh.x[problem.disk.loop] * [bend, 1.0, 1.0]
    x_loop = close_with_lengths(problem.loop, guess)
    assert x_loop is not None
    shape = equilibria.spanned(problem, x_loop)
    found = problem.equilibrium(shape, np.zeros(36), 1.0, Status.CONVERGED)
    assert problem.classified(found).status is equilibria.verdict(x_loop)


def test_failures_keep_their_own_status() -> None:
    problem = Problem(cases.polygon(5).mesh)
    for status in set(Status) - {Status.CONVERGED}:
        found = problem.equilibrium(problem.disk.shape, np.zeros(5), 1.0, status)
        assert problem.classified(found).status is status


def test_papers_mesh_carries_a_load_of_1e4_and_none_of_1e5(elongated: Disk) -> None:
    start = cases.disk(elongated.x, elongated.triangles)
    for load, status in ((1e4, Status.CONVERGED), (1e5, Status.UNRESOLVED)):
        assert cases.run(start, "springs", load).word == status.value
