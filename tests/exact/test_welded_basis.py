"""Series whose derivatives jump at one point: tails, energy, and what they resolve."""

from math import pi

import numpy as np
import pytest

from eulerplateau.exact.conformal import GENERAL, LOBED, welded_basis
from eulerplateau.exact.conformal.tails import tail
from eulerplateau.exact.conformal.welded import POWERS
from tests.helpers.marks import quick_with


@pytest.mark.parametrize("v", [17, 73])
@pytest.mark.parametrize("p", quick_with([4.5], [3.0, 4.5, 5.0]))
def test_tails_are_the_sums_they_stand_for(p, v):
    """Near phi = 0, where they are a series, and elsewhere, where they are an integral."""
    k = np.arange(v, 1_000_000)
    phi = np.array([1e-3, 0.2, 5 / v, 7 / v, 2.0, -1.0, 6.0])
    summed = np.array([((v / k) ** p * np.exp(1j * k * at)).sum() for at in phi])
    assert np.abs(tail(p, v, phi) - summed).max() < 1e-10 * v


def test_first_tail_is_a_logarithm():
    """The sum of exp(i k phi) / k is -log(1 - exp(i phi))."""
    phi = np.array([1e-9, 1e-2, 0.4, 3.0, -0.7])
    k = np.arange(1, 20)
    whole = -np.log(1 - np.exp(1j * phi))
    left = whole - (np.exp(1j * np.outer(phi, k)) / k).sum(axis=1)
    np.testing.assert_allclose(tail(1.0, 20, phi) / 20, left, rtol=1e-9)


def a_loop(basis):
    """Return coefficients at random."""
    size = np.random.default_rng(3).standard_normal(basis.size)
    return size / (1 + basis.wavenumbers**2)


@pytest.mark.parametrize("crowding", [1.0, 0.05])
def test_dirichlet_energy_is_what_the_edge_does(crowding):
    """The energy of the harmonic extension is half the integral of x . dx/dr."""
    basis = welded_basis(16, GENERAL, crowding)
    loop = a_loop(basis)
    x = basis.at(loop, basis.phi).x
    work = 0.5 * basis.weight * float((basis.rate @ (x * basis.outwards(loop))).sum())
    assert 0.5 * loop @ basis.dirichlet @ loop == pytest.approx(work, rel=1e-10)


@pytest.mark.slow
def test_dirichlet_energy_is_that_of_all_harmonics():
    """pi k |c_k|^2 summed, of coefficients by the fast Fourier transform."""
    basis = welded_basis(16, GENERAL)
    loop, n = a_loop(basis), 1 << 13
    x = basis.at(loop, 2 * pi * (np.arange(n) + 0.5) / n).x
    series = np.abs(np.fft.rfft(x, axis=0) / n) ** 2
    summed = 2 * pi * float(np.arange(len(series)) @ series.sum(axis=1))
    assert 0.5 * loop @ basis.dirichlet @ loop == pytest.approx(summed, rel=1e-9)


def test_values_at_the_grid_give_back_the_loop():
    basis = welded_basis(24, LOBED, 0.1)
    loop = a_loop(basis)
    np.testing.assert_allclose(basis.project(basis.curve(loop).x), loop, atol=1e-12)


def cubic(basis):
    """Return the coefficients of y = sum of sin k phi / k^3: its y'' jumps by pi at 0."""
    bent = np.zeros((len(basis.phi), 3))
    bent[:, 1] = of_cubic(basis.phi)
    return basis.project(bent)


def of_cubic(phi):
    """Bernoulli's polynomial, pi^2 phi / 6 - pi phi^2 / 4 + phi^3 / 12 from 0 to 2 pi."""
    return pi**2 * phi / 6 - pi * phi * np.abs(phi) / 4 + phi**3 / 12


def test_a_jump_of_the_second_derivative_is_resolved():
    basis = welded_basis(32, LOBED)
    loop = cubic(basis)
    assert basis.tail(loop) < 1e-10
    at = np.array([1e-4, 0.01, 0.5, 3.0])
    found = basis.at(loop, at)
    np.testing.assert_allclose(found.x[:, 1], of_cubic(at), atol=1e-11)
    np.testing.assert_allclose(found.x2[:, 1], (at - pi) / 2, atol=1e-6)


def test_tail_that_harmonics_do_not_lead_to_is_seen():
    basis = welded_basis(32, LOBED)
    loop = cubic(basis)
    loop[basis.slices[1].stop - len(POWERS) : basis.slices[1].stop] *= 0.5
    assert basis.tail(loop) > 1e-4
