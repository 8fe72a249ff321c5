"""Gradings, Dirichlet form and the energies' derivatives of the spectral film."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from scipy.special import ellipj

from eulerplateau.errors import SpecError
from eulerplateau.exact.conformal.basis import Basis, make_basis
from eulerplateau.exact.conformal.energy import (
    bending_blocks,
    bending_gradient,
    bending_hessian,
    length_blocks,
    length_gradient,
    length_hessian,
    terms,
)
from eulerplateau.exact.conformal.families import GENERAL, HALF_TURNS, TWISTED, Family
from eulerplateau.exact.conformal.grading import Grading, dirichlet_form

CROWDINGS = (1.0, 0.3, 1e-2, 1e-4, 1e-8)


def loop(basis: Basis, seed: int = 3) -> np.ndarray:
    """Return a smooth loop with no symmetry but the basis's."""
    noise = np.random.default_rng(seed).standard_normal(basis.size)
    c = 0.01 * noise / basis.wavenumbers**4
    x, y, _ = basis.slices
    c[x] += 0.2 * np.array([column == ("cos", 1) for column in basis.columns[0]])
    c[y] += 0.1 * np.array([column == ("sin", 1) for column in basis.columns[1]])
    return c


@pytest.mark.parametrize("crowding", [0.9, 0.3, 0.03])
def test_elliptic_functions_are_those_of_scipy(crowding: float) -> None:
    u = np.linspace(-20, 20, 301)
    expected = ellipj(u, 1 - crowding**2)[:3]
    np.testing.assert_allclose(Grading(crowding).functions(u), expected, atol=1e-12)


@pytest.mark.parametrize("crowding", CROWDINGS)
def test_identities_hold_however_crowded(crowding: float) -> None:
    grading = Grading(crowding)
    phi = np.linspace(-3, 9, 201)
    sn, cn, dn = grading.functions(grading.stretch * (phi - pi / 2))
    np.testing.assert_allclose(sn**2 + cn**2, 1, rtol=1e-13)
    np.testing.assert_allclose(dn, np.sqrt(cn**2 + (crowding * sn) ** 2), rtol=1e-9)
    turns = (grading.phi(sn, cn) - phi) / (2 * pi)
    np.testing.assert_allclose(turns, np.round(turns), atol=1e-9)


def test_theta_is_the_integral_of_its_rate() -> None:
    grading = Grading(0.1)
    phi = 2 * pi * np.arange(64) / 64
    theta = grading.theta(phi)
    # theta - phi is periodic: its derivative by Fourier series.
    series = np.fft.rfft(theta - phi)
    slope = np.fft.irfft(1j * np.arange(33) * series)
    np.testing.assert_allclose(1 + slope, grading.rate(phi), atol=1e-7)


@pytest.mark.parametrize("crowding", CROWDINGS)
def test_dirichlet_energy_of_each_harmonic_is_half_pi_k(crowding: float) -> None:
    points = 1024
    form = dirichlet_form(Grading(crowding), points)
    theta = Grading(crowding).theta(2 * pi * np.arange(points) / points)
    for k in range(1, 9):
        for wave in (np.cos(k * theta), np.sin(k * theta)):
            assert wave @ form @ wave / 2 == pytest.approx(pi * k / 2, rel=1e-11)


def test_dirichlet_energy_converges_faster_than_any_power() -> None:
    errors = []
    for points in (24, 48, 96):
        form = dirichlet_form(Grading(1e-2), points)
        wave = np.sin(Grading(1e-2).theta(2 * pi * np.arange(points) / points))
        errors.append(abs(wave @ form @ wave / pi - 1))
    # Twice the points square the error at least, where that is not rounding.
    assert errors[1] < errors[0] ** 1.8
    assert errors[2] < max(errors[1] ** 1.8, 1e-13)


@pytest.mark.parametrize("family", [GENERAL, TWISTED], ids=lambda family: family.name)
def test_derivatives_leave_remainders_of_second_and_third_order(family: Family) -> None:
    basis = make_basis(10, family, 0.5)
    c = loop(basis)
    way = loop(basis, 5)
    t, curve = terms(basis, c), basis.curve(c)
    hessians = (
        bending_hessian(basis, curve),
        length_hessian(basis, curve),
        basis.dirichlet,
    )
    sizes = 0.1 * 0.5 ** np.arange(1, 6)
    for name, hessian in zip(("bending", "length", "area"), hessians, strict=True):
        slope = getattr(t, f"{name}_gradient") @ way
        value = getattr(t, name)
        bend = way @ hessian @ way / 2
        ahead = np.array([getattr(terms(basis, c + h * way), name) for h in sizes])
        first = np.abs(ahead - value - sizes * slope)
        assert np.polyfit(np.log(sizes), np.log(first), 1)[0] == pytest.approx(2, abs=0.15)
        second = np.abs(ahead - value - sizes * slope - sizes**2 * bend)
        if name == "area":  # quadratic
            assert second.max() < 1e-13 * value
        else:
            order = np.polyfit(np.log(sizes[1:]), np.log(second[1:]), 1)[0]
            assert order == pytest.approx(3, abs=0.25)


def test_energies_are_those_of_a_rotated_and_of_a_larger_loop() -> None:
    basis = make_basis(12, GENERAL)
    c = loop(basis)
    x = basis.curve(c).x
    rotation = np.linalg.qr(np.random.default_rng(1).standard_normal((3, 3)))[0]
    t, rotated = terms(basis, c), terms(basis, basis.project(x @ rotation))
    larger = terms(basis, 3 * c)
    for name, power in (("bending", -1), ("length", 1), ("area", 2)):
        assert getattr(rotated, name) == pytest.approx(getattr(t, name), rel=1e-12)
        assert getattr(larger, name) == pytest.approx(
            3**power * getattr(t, name), rel=1e-12
        )


def test_a_symmetric_loops_hessian_falls_into_the_blocks_of_the_half_turns() -> None:
    whole, symmetric = make_basis(8, GENERAL, 0.4), make_basis(8, TWISTED, 0.4)
    c = loop(symmetric)
    curve = symmetric.curve(c)
    hessian = bending_hessian(whole, curve) + length_hessian(whole, curve) + whole.dirichlet
    assert sum(make_basis(8, family, 0.4).size for family in HALF_TURNS) == whole.size
    rest = hessian.copy()
    for family in HALF_TURNS:
        part = make_basis(8, family, 0.4)
        block = bending_hessian(part, curve) + length_hessian(part, curve) + part.dirichlet
        into = np.stack([whole.embed(part, row) for row in np.eye(part.size)])
        scale = np.abs(hessian).max()
        np.testing.assert_allclose(into @ hessian @ into.T, block, atol=1e-12 * scale)
        rest -= into.T @ block @ into
    assert np.abs(rest).max() < 1e-12 * np.abs(hessian).max()


@pytest.mark.parametrize("family", HALF_TURNS, ids=lambda family: family.name)
def test_a_quarter_of_a_symmetric_loop_stands_for_all_of_it(family: Family) -> None:
    """Loops, gradients, and products with displacements that keep some half-turn."""
    whole, symmetric = make_basis(8, GENERAL, 0.4), make_basis(8, TWISTED, 0.4)
    part, c = make_basis(8, family, 0.4), loop(symmetric)
    curve, there = symmetric.curve(c), whole.curve(whole.embed(symmetric, c))
    for mine, theirs in zip(curve, there, strict=True):
        np.testing.assert_allclose(mine, theirs, atol=1e-12 * np.abs(theirs).max())
    way = loop(part, 5)
    inside = whole.embed(part, way)
    for slope in (bending_gradient, length_gradient):
        full = slope(whole, there)
        assert slope(part, curve) @ way == pytest.approx(
            full @ inside, abs=1e-11 * np.linalg.norm(full)
        )
    for blocks in (bending_blocks, length_blocks):
        full = blocks(whole, there).product(whole, inside)
        mine = whole.embed(part, blocks(part, curve).product(part, way))
        np.testing.assert_allclose(mine, full, atol=1e-11 * np.abs(full).max())
        matrix = blocks(part, curve).matrix(part)
        np.testing.assert_allclose(
            whole.embed(part, matrix @ way), full, atol=1e-11 * np.abs(full).max()
        )


def test_another_grading_keeps_the_loop_and_its_energies() -> None:
    few, old, new = (make_basis(n, TWISTED, w) for n, w in ((8, 1), (64, 1), (96, 0.05)))
    c = old.embed(few, loop(few))
    before, after = terms(old, c), terms(new, new.transfer(old, c))
    for name in ("bending", "length", "area"):
        assert getattr(after, name) == pytest.approx(getattr(before, name), rel=1e-10)


@pytest.mark.parametrize(
    ("harmonics", "crowding", "key"),
    [
        (3, 1.0, "harmonics"),
        (8, 0.0, "crowding"),
        (8, 1.5, "crowding"),
        (8, -1.0, "crowding"),
    ],
)
def test_impossible_bases_are_refused(harmonics: int, crowding: float, key: str) -> None:
    with pytest.raises(SpecError) as error:
        make_basis(harmonics, TWISTED, crowding)
    assert error.value.key == key
