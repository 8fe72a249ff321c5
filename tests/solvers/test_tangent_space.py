"""The second variation along one displacement, against the whole of it."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.conformal import SmoothFamily
from eulerplateau.branches.film_family import family_near
from eulerplateau.exact.conformal import TWISTED, disk as flat_disk, make_basis
from eulerplateau.loop import LoopEnergy
from eulerplateau.solvers import Problem, directional, tangent_model
from tests.solvers.test_twist import disk

RNG = np.random.default_rng(5)


def on_a_mesh(film: str) -> tuple[LoopEnergy, FloatArray]:
    """A loop of even edges, away from equilibrium, of a rod that was turned."""
    problem = Problem(disk(24), film, twist_ratio=0.7, link=0.4)
    return bent(*family_near(problem, disk(24).shape), 300.0)


def without_a_mesh() -> tuple[LoopEnergy, FloatArray]:
    basis = make_basis(8, TWISTED)
    family = SmoothFamily(basis, {"load": 300.0, "twist_ratio": 0.7, "link": 0.4})
    return bent(family, family.unknowns.x(flat_disk(basis, 300.0).coefficients), 300.0)


def bent(family: object, x: FloatArray, load: float) -> tuple[LoopEnergy, FloatArray]:
    energy = family.energy(load)  # type: ignore[attr-defined]
    softest = tangent_model(energy, x).eigen[1][:, :5].sum(axis=1)
    moved = x + 0.01 * tangent_model(energy, x).displacement(softest)
    kept = energy.constraint.project(moved)
    assert kept is not None
    return energy, kept


@pytest.mark.parametrize(
    "made",
    [
        lambda: on_a_mesh("springs"),
        lambda: on_a_mesh("area"),
        without_a_mesh,
    ],
)
def test_along_a_displacement_it_is_the_model_s(made: object) -> None:
    energy, x = made()  # type: ignore[operator]
    model, along = tangent_model(energy, x), directional(energy, x)
    np.testing.assert_allclose(along.tensions, model.tensions, rtol=1e-8, atol=1e-6)
    coefficients = RNG.standard_normal(len(model.gradient))
    # Motions that are free, or change lengths, count for nothing.
    normal = energy.constraint.force(x, np.ones_like(along.tensions))
    step = model.displacement(coefficients) + normal / model.weights[:, None]
    expected = model.hessian @ coefficients
    found = model.slope(along.pull(step))
    size = float(np.abs(expected).max())
    np.testing.assert_allclose(found, expected, atol=1e-9 * size)
    force = sum(energy.forces(x)[1:], start=energy.forces(x)[0])
    np.testing.assert_allclose(
        model.slope(along.left(force)), model.gradient, atol=1e-9 * np.abs(force).max()
    )
