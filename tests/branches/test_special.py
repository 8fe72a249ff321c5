"""Special points: located by an eigenvalue to rounding, whatever way one comes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.between import Interval
from eulerplateau.branches.continuation import advance, follow
from eulerplateau.branches.control import StepControl
from eulerplateau.branches.point import BranchPoint, along
from eulerplateau.branches.special import (
    BIFURCATION,
    FOLD,
    SpecialPoint,
    branches_from,
    special_points,
)
from eulerplateau.branches.symmetry import OPERATIONS, loop_distance
from eulerplateau.mesh.disk import Disk
from eulerplateau.solvers.problem import Problem
from tests.helpers import diagram, shapes
from tests.helpers.diagram import CONTROL, Diagram
from tests.helpers.equilibria import planar
from tests.helpers.marks import quick_with
from tests.helpers.shapes import fitted_order

PRECISION = 1e-8  # relative, of the loads at 474 vertices
MIRROR = np.array([1.0, 1.0, -1.0])


@pytest.fixture(scope="module")
def found() -> Diagram:
    return diagram.elongated()


@pytest.fixture(scope="module")
def onset(found: Diagram) -> SpecialPoint:
    """Where the planar branch first loses its stability, to the twisted saddle."""
    return found.specials[0]


def specials_along(start: BranchPoint, control: StepControl) -> list[SpecialPoint]:
    before, specials = start, []
    for after in follow(start, control):
        specials += special_points(before, after, control)
        before = after
    return specials


def test_critical_eigenvalue_vanishes_within_its_error_bound(found: Diagram) -> None:
    assert len(found.specials) >= 4
    for special in found.specials:
        assert abs(special.eigenvalue) <= special.point.stability.error_bound
        assert special.error < PRECISION * special.point.value


def test_mode_is_the_critical_one(found: Diagram) -> None:
    """It keeps the lengths, and the Hessian takes it to nothing."""
    for special in found.specials:
        model = special.point.model
        mode = model.basis.T @ (special.mode.ravel() * model.scale)
        assert np.linalg.norm(mode) == pytest.approx(1.0)
        largest = np.abs(model.eigen[0]).max()
        assert np.linalg.norm(model.hessian @ mode) < 1e-13 * largest


@pytest.mark.parametrize(("number", "mode"), [(0, 0), (1, 1)])
def test_loads_agree_with_interpolated_eigenvalues(
    found: Diagram, number: int, mode: int
) -> None:
    """The planar state at two close loads, found without continuation."""
    special = found.specials[number]
    close = special.point.value + np.array([-0.05, 0.05])
    states = planar(found.problem, [*np.arange(300.0, close[0], 200.0), *close])
    low, high = (model.eigen[0][mode] for model in states[-2:])
    assert low * high < 0
    crossing = close[0] + (close[1] - close[0]) * low / (low - high)
    assert crossing == pytest.approx(special.point.value, rel=PRECISION)


@pytest.mark.parametrize(
    ("low", "high", "step"),
    quick_with([(600.0, 700.0, 0.03)], [(600.0, 700.0, 0.03), (655.0, 1200.0, 0.004)]),
)
def test_onset_does_not_depend_on_window_start_or_step(
    found: Diagram, onset: SpecialPoint, low: float, high: float, step: float
) -> None:
    control = StepControl((low, high), high, first_step=step, largest_step=step)
    start = diagram.stable_point(found.problem, low, control)
    first, *_ = specials_along(start, control)
    assert first.point.value == pytest.approx(onset.point.value, rel=PRECISION)
    assert first.symmetry.breaks == onset.symmetry.breaks


def test_both_ends_of_a_branch_find_the_same_points(found: Diagram) -> None:
    """The eight is met from both sides of the twisted saddle: stated errors suffice."""
    met = [v.special for v in found.visits if v.special is not None and v.special.arrived]
    assert len(met) >= 2
    first, *others = met
    for other in others:
        error = first.error + other.error
        assert abs(other.point.value - first.point.value) <= error


@pytest.mark.slow
def test_branch_arrives_at_the_interpolated_zero_of_the_loads_rate(found: Diagram) -> None:
    """Its arclength there errs by the square of the step or less, wherever the step began.

    The point itself is known from the branch that it crosses, to an eigenvalue's rounding.
    """
    end = next(v for v in found.visits if v.special is not None and v.special.arrived)
    assert end.special is not None
    last = diagram.regular(found.branch(end.branch))[-1]
    left = along(last, end.special.point, CONTROL)
    for part in (0.3, 0.6):
        steps, errors = [0.006, 0.012], []
        for step in steps:
            before = advance(last, left - part * step, CONTROL)
            assert before is not None
            after = advance(before, step, CONTROL)
            assert after is not None
            (special,) = special_points(before, after, CONTROL)
            assert special.arrived
            gone = special.point.arclength - before.arclength
            errors.append(gone - along(before, special.point, CONTROL))
        assert max(np.abs(errors)) < 1e-2 * steps[-1]
        assert fitted_order(steps, errors) > 1.9


def test_index_changes_by_the_multiplicity(found: Diagram) -> None:
    for branch in {visit.branch for visit in found.visits}:
        visits = found.branch(branch)
        for before, here, after in zip(visits, visits[1:], visits[2:], strict=False):
            if here.special is None:
                continue
            assert here.special.multiplicity == 1
            ends = [side.point.stability.n_unstable for side in (before, after)]
            assert sorted(ends) == [here.special.n_unstable, here.special.n_unstable + 1]


def test_onset_of_the_hexagon_is_double(hexagon: Disk) -> None:
    """A saddle may point any way: two modes are lost together, as one event."""
    problem = Problem(hexagon)
    control = StepControl(window=(800.0, 900.0), unit=900.0)
    start = diagram.stable_point(problem, 800.0, control)
    (onset,) = specials_along(start, control)
    assert onset.multiplicity == 2
    assert onset.n_unstable == 0
    assert onset.symmetry.transverse > 0.999


@pytest.mark.parametrize(("stretch", "events"), [(1e-6, 1), (1e-4, 2)])
def test_modes_lost_one_after_the_other_are_two_events(stretch: float, events: int) -> None:
    """A stretched hexagon's, whose loads differ by a twentieth of the stretch."""
    points, triangles = shapes.hexagon_points(4)
    problem = Problem(shapes.mesh_of(points * [1 + stretch, 1.0], triangles))
    control = StepControl(window=(830.0, 845.0), unit=900.0)
    start = diagram.stable_point(problem, 830.0, control)
    specials = specials_along(start, control)
    assert [special.multiplicity for special in specials] == [3 - events] * events
    assert [special.n_unstable for special in specials] == [*range(events)]
    loads = [special.point.value for special in specials]
    assert np.ptp(loads) < 0.1 * stretch * loads[0]


def test_error_is_what_rounding_of_the_eigenvalue_can_move_the_load_by() -> None:
    """The bound over how fast the eigenvalue falls with the load, and little more."""
    points, triangles = shapes.hexagon_points(4)
    problem = Problem(shapes.mesh_of(points * [1.05, 1.0], triangles))
    control = StepControl(window=(700.0, 900.0), unit=900.0)
    before = diagram.stable_point(problem, 700.0, control)
    for after in follow(before, control):
        found = list(special_points(before, after, control))
        if found:
            break
        before = after
    interval = Interval(before, after, control)
    index = interval.crossing[0]
    ends = [end.stability.eigenvalues[index] for end in (before, after)]
    slope = (ends[1] - ends[0]) / (after.value - before.value)
    bound = found[0].point.stability.error_bound
    assert found[0].error >= 0.9 * bound / abs(slope)
    assert found[0].error <= 3 * bound / abs(slope) + 1e-14 * after.value


def test_first_mode_twists(onset: SpecialPoint) -> None:
    """Out of the plane; all mirrors and the inversion break, the half turns stay."""
    assert onset.symmetry.transverse > 0.999
    turns = {name for name in OPERATIONS if name.startswith("half turn")}
    assert set(onset.symmetry.keeps) == turns
    assert set(onset.symmetry.breaks) == OPERATIONS.keys() - turns


def test_eights_mode_bends_its_lobes(found: Diagram) -> None:
    """Out of the plane; the mirrors across the plane's axes and one half turn stay."""
    bent = max(
        (special for special in found.specials if special.n_unstable == 0),
        key=lambda special: special.point.value,
    )
    assert bent.symmetry.transverse > 0.999
    assert set(bent.symmetry.keeps) == {
        "mirror across long axis",
        "mirror across middle axis",
        "half turn about short axis",
    }


def test_sides_of_a_pitchfork_are_mirror_images(found: Diagram) -> None:
    for special in found.specials:
        if special.arrived:
            continue
        one, other = branches_from(special, CONTROL)
        assert loop_distance(one.x, other.x * MIRROR) < 1e-6
        assert other.value == pytest.approx(one.value, rel=1e-9)
        assert found.energy(other) == pytest.approx(found.energy(one), rel=1e-9)
        assert found.twist(one) == pytest.approx(-found.twist(other), rel=1e-5)


def test_pitchforks_open_as_the_square_of_the_amplitude(found: Diagram) -> None:
    """load - onset grows as the square of the displacement along the mode, upwards."""
    for special in found.specials:
        if special.arrived:
            continue
        side = next(iter(branches_from(special, CONTROL)))
        fine = StepControl(CONTROL.window, CONTROL.unit, 2e-4, 2e-4, max_points=12)
        points = list(follow(side, fine))
        excess = [point.value - special.point.value for point in points]
        assert min(excess) > 0
        sizes = [amplitude(found.problem, special, point) for point in points]
        assert fitted_order(sizes, excess) == pytest.approx(2.0, abs=0.02)


def amplitude(problem: Problem, special: SpecialPoint, point: BranchPoint) -> float:
    moved = (point.x - special.point.x) * special.mode
    return float(problem.loop.mean_lengths @ moved.sum(axis=1))


def test_pitchforks_are_supercritical(found: Diagram) -> None:
    """A side branch exists where the other one is less stable, and takes its stability."""
    for special in found.specials:
        if special.arrived:
            continue
        above = advance(special.point, 2e-3, CONTROL)
        below = advance(special.point, -2e-3, CONTROL)
        assert above is not None
        assert below is not None
        assert above.value > special.point.value > below.value
        assert above.stability.n_unstable == special.n_unstable + 1
        assert below.stability.n_unstable == special.n_unstable
        for side in branches_from(special, CONTROL):
            assert side.value > special.point.value
            assert side.stability.n_unstable == special.n_unstable


def test_folds_are_told_from_bifurcations() -> None:
    """A fold: the load is extreme, quadratically; no symmetry breaks, no branch leaves."""
    _, start, control = diagram.folding_branch()
    specials = specials_along(start, control)
    (fold,) = (special for special in specials if special.kind == FOLD)
    assert {special.kind for special in specials} == {FOLD, BIFURCATION}
    assert fold.symmetry.breaks == ()
    assert abs(fold.eigenvalue) <= fold.point.stability.error_bound
    assert fold.error < PRECISION * fold.point.value
    assert list(branches_from(fold, control)) == []
    steps = [1e-3, 2e-3, 4e-3]
    ends = both_ways(fold.point, steps, control)
    rise = [sum(end.value for end in pair) - 2 * fold.point.value for pair in ends]
    assert min(rise) > 0
    assert fitted_order(steps, rise) == pytest.approx(2.0, abs=0.05)
    for pair in ends:
        indices = sorted(end.stability.n_unstable for end in pair)
        assert indices == [fold.n_unstable, fold.n_unstable + 1]


def both_ways(
    point: BranchPoint, steps: Sequence[float], control: StepControl
) -> list[list[BranchPoint]]:
    back = replace(point, direction=point.direction.reversed())
    ends = []
    for step in steps:
        pair = [advance(way, step, control) for way in (point, back)]
        ends.append([end for end in pair if end is not None])
    assert all(len(pair) == 2 for pair in ends)
    return ends


def test_mode_of_a_fold_is_the_branch_direction() -> None:
    problem, start, control = diagram.folding_branch()
    fold = next(s for s in specials_along(start, control) if s.kind == FOLD)
    mass = problem.loop.mean_lengths[:, None]
    assert abs(fold.point.direction.rate) < 1e-6 * control.unit
    overlap: FloatArray = mass * fold.mode * fold.point.direction.displacement
    assert abs(overlap.sum()) == pytest.approx(1.0, abs=1e-6)
