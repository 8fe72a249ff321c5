"""Curves of special points in two parameters, of energies with exact ones."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.branches import (
    BIFURCATION,
    FOLD,
    End,
    LocusPoint,
    Special,
    StepControl,
    follow_locus,
    locus_start,
    special_at,
)
from eulerplateau.branches.control import Motion
from eulerplateau.branches.locus_ahead import Ahead
from eulerplateau.branches.locus_between import between
from eulerplateau.errors import SpecError
from eulerplateau.loop import LoopEnergy, Term, Unconstrained
from eulerplateau.threads import one_thread
from tests.helpers import shapes

# Energies of (x, y) and (p, r): slope, second derivative, derivative of the slope by p, r.
Jet = Callable[[float, float, float, float], tuple[object, object, object, object]]


def cusp(x: float, y: float, p: float, r: float) -> tuple[object, ...]:
    """x^4/4 - p x^2/2 - r x + y^2/2: folds at p = 3 x^2, r = -2 x^3."""
    slope, curved = (x**3 - p * x - r, y), ((3 * x**2 - p, 0), (0, 1))
    return slope, curved, (-x, 0), (-1, 0)


def pitchfork(x: float, y: float, p: float, r: float) -> tuple[object, ...]:
    """x^4/4 - p x^2/2 + r y x^2 + y^2/2: at p = 0; a_3 = 1 - 2 r^2."""
    slope = (x**3 - p * x + 2 * r * x * y, y + r * x**2)
    curved = ((3 * x**2 - p + 2 * r * y, 2 * r * x), (2 * r * x, 1))
    return slope, curved, (-x, 0), (2 * x * y, x**2)


def parabola(x: float, y: float, p: float, r: float) -> tuple[object, ...]:
    """x^3/3 + (r - p^2) x + y^2/2: folds at x = 0 on r = p^2."""
    return (x**2 + r - p**2, y), ((2 * x, 0), (0, 1)), (-2 * p, 0), (1, 0)


def circle(x: float, y: float, p: float, r: float) -> tuple[object, ...]:
    """x^3/3 + (p^2 + r^2 - 1) x + y^2 (r - 1/2)/2: y is lost beside where r = 1/2."""
    slope, curved = (x**2 + p**2 + r**2 - 1, (r - 0.5) * y), ((2 * x, 0), (0, r - 0.5))
    return slope, curved, (2 * p, 0), (2 * r, y)


def sextic(x: float, y: float, p: float, r: float) -> tuple[object, ...]:
    """-p x^2/2 + r x^4/4 + x^6/6 + (y - p - r)^2/2: folds at p = -x^4, r = -2 x^2."""
    slope, curved = -p * x + r * x**3 + x**5, -p + 3 * r * x**2 + 5 * x**4
    return (slope, y - p - r), ((curved, 0), (0, 1)), (-x, -1), (x**3, -1)


def flawed(x: float, y: float, p: float, r: float) -> tuple[object, ...]:
    """x^4/4 - p x^2/2 - r^3 x + y^2/2: symmetric only as long as r = 0."""
    slope, curved = x**3 - p * x - r**3, 3 * x**2 - p
    return (slope, y), ((curved, 0), (0, 1)), (-x, 0), (-3 * r**2, 0)


@dataclass(frozen=True)
class Exact(Term):
    jet: Jet
    p: float
    r: float

    def _part(self, number: int, x: FloatArray) -> FloatArray:
        return np.array(self.jet(*x[:, 0], self.p, self.r)[number], dtype=float)

    def force(self, x: FloatArray) -> FloatArray:
        return self._part(0, x)[:, None]

    def hessian(self, x: FloatArray) -> FloatArray:
        return self._part(1, x)

    def rate(self, parameter: str, x: FloatArray) -> FloatArray | None:
        return self._part({"p": 2, "r": 3}[parameter], x)[:, None]


@dataclass(frozen=True)
class Weight(Term):
    """A constant force: residuals are parts of the largest force, of which there is one."""

    size: float

    def force(self, x: FloatArray) -> FloatArray:
        return np.full_like(x, self.size)

    def hessian(self, x: FloatArray) -> FloatArray:
        return np.zeros((len(x), len(x)))


@dataclass(frozen=True)
class ExactFamily:
    jet: Jet
    r: float = 0.0
    parameter: str = "p"

    def energy(self, value: float) -> LoopEnergy:
        exact = Exact(self.jet, value, self.r)
        terms = {"exact": exact, "down": Weight(-1.0), "up": Weight(1.0)}
        nothing = np.zeros((2, 0))
        return LoopEnergy(terms, Unconstrained(), np.ones(2), lambda x: nothing)

    def with_value(self, parameter: str, value: float) -> ExactFamily:
        assert parameter == "r"
        return replace(self, r=value)

    def positions(self, x: FloatArray) -> FloatArray:
        angle = np.linspace(0, 2 * np.pi, 12, endpoint=False)
        ring = np.column_stack([np.cos(angle), np.sin(angle), np.sin(2 * angle)])
        return ring * [1 + x[0, 0], 1 + x[1, 0], x[0, 0]]

    def near(self, x: FloatArray) -> ExactFamily:
        return self

    released = near

    def kept(self, x: FloatArray) -> Mapping[str, FloatArray]:
        return {}

    def restored(self, kept: Mapping[str, FloatArray]) -> ExactFamily:
        return self


def curve(
    jet: Jet, x: float, p: float, r: float, kind: str = FOLD, reach: float = 2.0
) -> list[LocusPoint]:
    control = StepControl((-reach, reach), 1.0, 0.01, 0.1, least=-np.inf)
    family = ExactFamily(jet, r)
    special = special_at(family, np.array([[x], [0.0]]), p, kind)
    with one_thread():
        return list(follow_locus(locus_start(special, "r", r, (control, control))))


def specials(points: list[LocusPoint]) -> list[tuple[str, FloatArray]]:
    return [(p.special, p.values) for p in points if p.special not in ("", "start")]


@pytest.mark.slow
def test_folds_go_through_their_cusp() -> None:
    points = curve(cusp, 0.5, 0.75, -0.25)
    assert {point.end for point in points} == {"", End.WINDOW}
    p, r = np.transpose([point.values for point in points])
    np.testing.assert_allclose((p / 3) ** 3, (r / 2) ** 2, atol=1e-11)
    assert r.min() < -0.9
    assert r.max() > 0.9
    ((kind, place),) = specials(points)
    assert kind == Special.CUSP
    np.testing.assert_allclose(place, 0, atol=1e-9)
    for point in points:  # a_2 = 3 x, up to the mode's sign
        x = point.model.x[0, 0]
        assert abs(point.coefficient) == pytest.approx(3 * abs(x), abs=1e-6)


def spaced(step: float, count: int) -> list[LocusPoint]:
    """Points of a parabola, the steps between them as good as even."""
    control = StepControl((-2.0, 2.0), 1.0, step, step, least=-np.inf)
    special = special_at(ExactFamily(parabola, 0.04), np.zeros((2, 1)), 0.2, FOLD)
    with one_thread():
        points = follow_locus(locus_start(special, "r", 0.04, (control, control)))
        return list(islice((it for it in points if it.special != Special.TURN), count))


def test_a_curve_goes_on_as_six_points_say_and_as_two_do_between() -> None:
    steps, ahead, amid = [0.02, 0.01], [], []
    for step in steps:
        *known, last = spaced(step, 7)
        way = known[-1].direction
        reach = last.dot(way, last.place - known[-1].place)
        going = Ahead(tuple(reversed(known)), way * 0.0)
        missed = going.guess(reach)[0] - last.place
        ahead.append(np.sqrt(last.dot(missed, missed)))
        p, r = between(known[-1], last, 0.5, way)[0].rates
        amid.append(abs(r - p**2))
    assert shapes.fitted_order(steps, ahead) == pytest.approx(7, abs=0.6)
    assert shapes.fitted_order(steps, amid) == pytest.approx(4, abs=0.1)


def test_what_a_step_misses_the_next_one_does_not() -> None:
    """Of directions that are all wrong by the same."""
    known = spaced(0.02, 8)
    wrong = Motion(np.zeros((2, 1)), np.array([1e-3, -1e-3]))
    bent = [replace(point, direction=point.direction + wrong) for point in known]
    ahead = Ahead.of(bent[0])
    for point in bent[1:-1]:
        ahead = ahead.then(point)
    step = known[-2].dot(bent[-2].direction, known[-1].place - known[-2].place)
    missed = ahead.guess(step)[0] - known[-1].place
    assert np.sqrt(known[-1].dot(missed, missed)) < 0.05 * 1e-3 * step


@pytest.mark.slow
def test_a_bifurcation_that_the_second_parameter_breaks_leaves_its_folds() -> None:
    points = curve(cusp, 0.0, 0.0, 0.0, BIFURCATION)
    assert not any(point.course.symmetric for point in points)
    assert points[0].special == Special.CUSP
    assert specials(points) == [(Special.CUSP, points[0].values)]
    p, r = np.transpose([point.values for point in points])
    np.testing.assert_allclose((p / 3) ** 3, (r / 2) ** 2, atol=1e-11)
    assert np.ptp(r) > 2


def test_a_pitchfork_stays_and_changes_its_nature_where_its_cubic_coefficient_says() -> (
    None
):
    points = curve(pitchfork, 0.0, 0.0, 0.2, BIFURCATION)
    assert all(point.course.symmetric for point in points)
    for point in points:
        assert point.values[0] == pytest.approx(0, abs=1e-12)
        assert point.coefficient == pytest.approx(1 - 2 * point.values[1] ** 2, abs=1e-5)
    found = specials(points)
    assert {kind for kind, _ in found} == {Special.NATURE}
    places = sorted(place[1] for _, place in found)
    assert places == pytest.approx([-np.sqrt(0.5), np.sqrt(0.5)], abs=1e-6)


@pytest.mark.slow
def test_where_a_curve_turns_in_the_second_parameter() -> None:
    points = curve(parabola, 0.0, 1.0, 1.0)
    p, r = np.transpose([point.values for point in points])
    np.testing.assert_allclose(r, p**2, atol=1e-11)
    ((kind, place),) = specials(points)
    assert kind == Special.TURN
    np.testing.assert_allclose(place, 0, atol=1e-9)


@pytest.mark.slow
def test_a_closed_curve_ends_at_its_start_and_says_where_another_mode_is_lost() -> None:
    points = curve(circle, 0.0, 1.0, 0.0)
    assert points[-1].end == End.CLOSED
    assert min(point.arclength for point in points) == 0
    found = specials(points)
    double = [place for kind, place in found if kind == Special.DOUBLE]
    turns = [place for kind, place in found if kind == Special.TURN]
    np.testing.assert_allclose([place[1] for place in double], 0.5, atol=1e-9)
    assert sorted(place[1] for place in turns) == pytest.approx([-1, 1], abs=1e-9)
    assert len(double) == 2
    for point in points:
        assert point.n_unstable == (point.values[1] < 0.5) or point.special


def test_two_modes_at_once_are_no_fold() -> None:
    control = StepControl((-2.0, 2.0), 1.0, least=-np.inf)
    special = special_at(ExactFamily(circle, 0.5), np.zeros((2, 1)), np.sqrt(0.75), FOLD)
    with pytest.raises(SpecError, match="at once"):
        locus_start(replace(special, multiplicity=2), "r", 0.5, (control, control))


@pytest.mark.slow
def test_where_folds_end_on_the_bifurcation_they_leave_their_mirror_images_begin() -> None:
    points = curve(sextic, 0.7, -(0.7**4), -2 * 0.7**2, reach=1.5)
    ordinary = [point for point in points if not point.special]
    p, r = np.transpose([point.values for point in ordinary])
    x = np.array([point.model.x[0, 0] for point in ordinary])
    assert x.min() < -0.7
    assert x.max() > 0.7
    np.testing.assert_allclose(p, -(x**4), atol=1e-9)
    np.testing.assert_allclose(r, -2 * x**2, atol=1e-7)
    ((kind, place),) = specials(points)
    assert kind == Special.MEETING
    # Their equations are singular there: next to it r is known to rounding over x^2.
    np.testing.assert_allclose(place, 0, atol=2e-6)


def test_a_bifurcation_ends_where_its_symmetry_does() -> None:
    points = curve(flawed, 0.0, 0.0, 0.0, BIFURCATION)
    ends = [point for point in points if point.end]
    assert [point.end for point in ends] == 2 * [End.UNBALANCED]
    assert all(abs(point.values[1]) < 0.2 for point in points)
