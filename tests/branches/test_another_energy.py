"""A ring without film or length constraint: other terms, the same solver and branches."""

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np

from eulerplateau.branches import StepControl, UnboundedFamily, first_point, follow
from eulerplateau.loop import LoopEnergy, Term, Unconstrained
from eulerplateau.solvers.descent import Descent
from eulerplateau.solvers.models import DenseModels

N, TENSION, SINE = 24, 2.0, np.sin(np.pi / 24)
CIRCLE = np.exp(2j * np.pi * np.arange(N) / N)[:, None].view(float)


class Edges(Term):  # tension times the perimeter N / p, plus p^3 sum |e_v - e_{v-1}|^2
    rounding = 1e-12

    def force(self, x):
        edge = np.roll(x, -1, axis=0) - x
        bend = edge - np.roll(edge, 1, axis=0)
        length = np.sqrt((edge**2).sum(axis=1, keepdims=True))
        p = N / length.sum()
        pull = (TENSION - 3 * p**4 / N * (bend**2).sum()) * edge / length
        pull += 2 * p**3 * (bend - np.roll(bend, -1, axis=0))
        return np.roll(pull, 1, axis=0) - pull

    def hessian(self, x):  # by complex steps: the force is analytic
        steps = 1e-30j * np.eye(x.size).reshape(-1, *x.shape)
        return np.array([self.force(x + step).imag.ravel() for step in steps]) / 1e-30


@dataclass(frozen=True)
class Springs(Edges):
    stiffness: float

    def force(self, x):
        return self.stiffness * (x - CIRCLE)

    def rate(self, parameter, x):
        return x - CIRCLE if parameter == "stiffness" else None


def pinned(k):
    terms, nothing = {"edges": Edges(), "springs": Springs(k)}, np.zeros((2 * N, 0))
    return LoopEnergy(terms, Unconstrained(), np.ones(N), lambda x: nothing)


class Rings(UnboundedFamily, SimpleNamespace):
    pass


def test_radius_solves_the_cubic_along_a_branch_of_stiffness():
    """2 N s (1/R + tension R) + N k (R - 1)^2 / 2 is stationary, s = sin(pi / N)."""
    state, _ = Descent(DenseModels(pinned(5.0)), 100).run(CIRCLE * [1.2, 0.8])
    ring = Rings(parameter="stiffness", energy=pinned, rests=lambda *_: True)
    control = StepControl(window=(5.0, 200.0), unit=100.0)
    first = first_point(ring, state.model.x, 5.0, control)
    for point in (branch := [first, *follow(first, control)]):
        cubic = [point.value, 2 * TENSION * SINE - point.value, 0, -2 * SINE]
        np.testing.assert_allclose(np.hypot(*point.x.T), max(np.roots(cubic).real), 1e-10)
    assert branch[-1].value > 200 > state.stability.n_unstable == 0
