"""The eight in contact by another method: strands that are soft, and no constraint.

k oint oint (d - |x(s) - x(t)|)_+^2 ds dt over the points of both strands pushes them
apart; the length is left free and scaled away; quasi-Newton steps downhill. The strands
indent each other: for k to infinity the film is that of a hard rod of the distance left.
"""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from scipy.optimize import minimize

from eulerplateau.branches.conformal.contact_eight import touching
from eulerplateau.exact.conformal import TWISTED, crossing, make_basis, precondition, waves
from eulerplateau.exact.conformal.energy import terms

LOAD, DIAMETER, PHI = 1700.0, 0.05, np.linspace(-0.35, 0.35, 121)


def held(diameter):
    return touching({"load": LOAD, "twist_ratio": 0.0, "link": 0.0, "diameter": diameter})


class Soft:
    """Soft strands: energy, gradient, and the sum of their forces."""

    def __init__(self, basis, stiffness):
        self.basis, self.stiffness = basis, stiffness
        self.rows = [
            [waves(columns, middle + PHI) for columns in basis.columns]
            for middle in (pi / 2, 3 * pi / 2)
        ]
        self.weight = (PHI[1] - PHI[0]) ** 2

    def strand(self, c, which, order):
        parts = zip(self.rows[which], self.basis.slices, strict=True)
        return np.stack([rows[order] @ c[part] for rows, part in parts], axis=1)

    def __call__(self, c):
        p, q = self.strand(c, 0, 0), self.strand(c, 1, 0)
        p1, q1 = self.strand(c, 0, 1), self.strand(c, 1, 1)
        u, v = np.linalg.norm(p1, axis=1), np.linalg.norm(q1, axis=1)
        apart = p[:, None] - q
        distance = np.linalg.norm(apart, axis=2)
        deep = np.maximum(DIAMETER - distance, 0)
        k = self.stiffness * self.weight
        push = -2 * k * (np.outer(u, v) * deep / distance)[:, :, None] * apart
        slopes = [
            (push.sum(axis=1), (k * deep**2 @ v / u)[:, None] * p1),
            (-push.sum(axis=0), (k * u @ deep**2 / v)[:, None] * q1),
        ]
        gradient = sum(
            np.concatenate([self.rows[i][a][o].T @ slopes[i][o][:, a] for a in range(3)])
            for i in range(2)
            for o in range(2)
        )
        return k * u @ deep**2 @ v, gradient, 2 * k * u @ deep @ v


def rest(soft, start):
    """Return the loop of length 1 at which film, bending and strands rest."""
    scale = precondition(soft.basis)

    def energy(y):
        c = scale * y
        t = terms(soft.basis, c)
        size, gauge = t.length, t.length_gradient
        push, slope, _ = soft(c / size)
        gradient = t.bending * gauge + size * t.bending_gradient
        gradient += LOAD * (t.area_gradient / size**2 - 2 * t.area / size**3 * gauge)
        gradient += slope / size - (slope @ c) / size**2 * gauge
        value = size * t.bending + LOAD * t.area / size**2 + push
        return value, scale * gradient

    found = minimize(energy, start / scale, jac=True, method="BFGS", options={"gtol": 1e-5})
    assert found.success
    c = scale * found.x
    return c / terms(soft.basis, c).length


@pytest.mark.slow
def test_soft_strands_become_hard_ones():
    hard = held(DIAMETER)
    basis = make_basis(40, TWISTED, hard.basis.crowding)
    c = basis.transfer(hard.basis, hard.family.unknowns.loop(hard.x).coefficients)
    errors = []
    for stiffness in (1e7, 1e8, 1e9):
        soft = Soft(basis, stiffness)
        c = rest(soft, c)
        t, at = terms(basis, c), crossing(basis, c)
        same = held(at.distance)
        errors.append(
            [
                t.bending + LOAD * t.area - same.energy,
                soft(c)[2] / same.force - 1,
                at.angle - same.crossing.angle,
            ]
        )
    energy, force, angle = np.abs(errors).T
    for error in (energy, force, angle):
        assert (error[1:] < 0.4 * error[:-1]).all()
    assert energy[-1] < 1e-5
    assert force[-1] < 5e-3
    assert angle[-1] < 0.02
