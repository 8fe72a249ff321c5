"""The true film against exact results: planar films, thresholds, balance of forces."""

from __future__ import annotations

from itertools import pairwise
from math import copysign, pi

import numpy as np
import pytest

from eulerplateau.exact.conformal.basis import make_basis
from eulerplateau.exact.conformal.branch import (
    BranchError,
    BranchPoint,
    go_to_load,
    locate,
    switch,
)
from eulerplateau.exact.conformal.equilibrium import correct, disk
from eulerplateau.exact.conformal.families import ABOUT_X, ABOUT_Z, PLANAR, TWISTED, Family
from eulerplateau.exact.conformal.geometry import edge, surface, waist
from eulerplateau.exact.conformal.second_variation import modes, morse_index
from eulerplateau.exact.planar import planar_film, thresholds
from tests.helpers.conformal_films import BUCKLING, SADDLE, onset, planar, saddle, twisted

KAPPA = 2 * pi
# Films in space: twisted ones below 1855.68, a saddle above 96 pi^3.
FILMS = {
    "twisted 1800": lambda: twisted(1800.0),
    "twisted 1400": lambda: twisted(1400.0),
    "saddle 3400": lambda: go_to_load(saddle(0.02), 3400.0),
}


@pytest.fixture(params=FILMS)
def in_space(request: pytest.FixtureRequest) -> BranchPoint:
    return FILMS[request.param]()


@pytest.mark.parametrize("load", [1600.0, 2000.0])
def test_two_lobes_converge_exponentially_to_the_exact_film(load: float) -> None:
    exact = planar_film(2, load)
    errors = []
    for harmonics in (12, 20, 28, 36) if load < 1800 else (24, 32, 40, 48):
        film = planar(load, harmonics, 0.1 if load < 1800 else 0.01).film
        errors.append(abs(film.energy / exact.energy - 1))
        assert film.energy >= exact.energy * (1 - 1e-13)
    # Each eight harmonics divide the error by the same factor or more, down to rounding.
    assert all(after < max(before / 8, 2e-14) for before, after in pairwise(errors))
    assert film.area == pytest.approx(exact.area, rel=max(1e3 * errors[-1], 1e-12))
    assert waist(film) == pytest.approx(2 * exact.positions(0.25)[1], rel=1e-6)


def test_three_lobes_converge_exponentially_to_the_exact_film() -> None:
    mirror = Family("mirror", ((("cos", 0), ("cos", 1)), (("sin", 0), ("sin", 1)), ()))
    exact, errors = planar_film(3, 4500.0), []
    for harmonics in (40, 80, 120):
        round_film = disk(make_basis(harmonics, mirror), thresholds(3).sigma_buckling)
        mode = min(modes(round_film, mirror), key=lambda m: abs(m.eigenvalue))
        tip = mode.basis.curve(mode.coefficients).x[0, 0]
        film = go_to_load(switch(round_film, mode, copysign(0.02, tip)), 4500.0).film
        errors.append(abs(film.energy / exact.energy - 1))
    assert all(after < before / 1000 for before, after in pairwise(errors))
    assert errors[-1] < 1e-11


@pytest.mark.parametrize("n", [2, 3, 4])
@pytest.mark.parametrize("load", [100.0, 3000.0])
def test_transverse_eigenvalues_of_the_disk_are_exact(n: int, load: float) -> None:
    # z = cos n theta: 2 z''^2 + (beta - 3 kappa^2) z'^2 and a film of energy pi n / 2.
    exact = 2 * KAPPA**4 * n**2 * (n**2 - 1) - load * KAPPA * n * (n - 1)
    film = disk(make_basis(16, TWISTED), load)
    family = TWISTED if n % 2 == 0 else ABOUT_X
    found = [m.eigenvalue for m in modes(film, family, 40) if m.transverse > 0.5]
    assert min(abs(value - exact) for value in found) < 1e-8 * KAPPA**4


@pytest.mark.parametrize("load", [1400.0, 1500.0, 2900.0, 3000.0, 3900.0, 4000.0, 5900.0])
def test_morse_index_of_the_disk_counts_the_thresholds_below(load: float) -> None:
    film = disk(make_basis(16, TWISTED), load)
    planar_modes = sum(load > 16 * pi**3 * (n**2 - 1) for n in range(2, 9))
    across = sum(load > 16 * pi**3 * n * (n + 1) for n in range(2, 9))
    assert morse_index(film) == 2 * (planar_modes + across)


def test_disk_leaves_the_plane_at_96_pi_cubed() -> None:
    film = disk(make_basis(12, TWISTED), SADDLE)
    lowest = min(abs(m.eigenvalue) for m in modes(film, TWISTED))
    # d eigenvalue / d load = -2 kappa.
    assert lowest / (2 * KAPPA) < 1e-10 * SADDLE


@pytest.mark.parametrize(("part", "index"), [(-1e-9, 2), (1e-9, 4)])
def test_morse_index_sees_a_threshold_to_a_part_in_a_billion(
    part: float, index: int
) -> None:
    """Eigenvalues of 4e-5 there are above the noise, small as they are beside others."""
    assert morse_index(disk(make_basis(8, TWISTED), SADDLE * (1 + part))) == index


def test_two_lobes_have_no_unstable_mode_before_the_twist_and_one_after() -> None:
    film, mode = onset()
    assert mode.transverse == pytest.approx(1, abs=1e-12)
    assert morse_index(planar(film.load - 5).film) == 0
    assert morse_index(planar(film.load + 5).film) == 1


def test_onset_of_the_twist_does_not_depend_on_the_grid() -> None:
    loads = [onset(*grid)[0].load for grid in ((48, 0.02), (64, 0.02), (64, 0.005))]
    assert max(loads) - min(loads) < 1e-8 * loads[0]


def test_twisted_films_lie_below_the_onset_by_the_square_of_their_amplitude() -> None:
    film, mode = onset()
    amplitudes = 0.008 * 0.5 ** np.arange(4)
    points = [switch(film, mode, float(a)) for a in amplitudes]
    below = np.array([film.load - point.load for point in points])
    assert (below > 0).all()
    order = np.polyfit(np.log(amplitudes), np.log(below), 1)[0]
    assert order == pytest.approx(2, abs=0.01)
    assert all(morse_index(point.film) == 1 for point in points)


def test_saddles_lie_above_96_pi_cubed_and_inherit_the_disks_instability() -> None:
    amplitudes = 0.008 * 0.5 ** np.arange(4)
    points = [saddle(float(a)) for a in amplitudes]
    above = np.array([point.load - SADDLE for point in points])
    assert (above > 0).all()
    assert np.polyfit(np.log(amplitudes), np.log(above), 1)[0] == pytest.approx(2, abs=0.01)
    assert all(morse_index(point.film) == 2 for point in points)
    # Perturbation theory (docs/true-film.md): load / onset - 1 = 19/18 h^2 + O(h^4), h the
    # height in radii of the disk.
    height = [2 * pi * float(np.abs(point.film.curve.x[:, 2]).max()) for point in points]
    errors = np.abs(above / SADDLE / np.array(height) ** 2 - 19 / 18)
    assert np.polyfit(np.log(height), np.log(errors), 1)[0] == pytest.approx(2, abs=0.05)


def test_energy_grows_with_the_load_by_the_area(in_space: BranchPoint) -> None:
    load = in_space.load
    h = 0.5
    energy = {}
    for k in (-2, -1, 1, 2):
        way = in_space if k * in_space.direction.load > 0 else in_space.reversed()
        energy[k] = go_to_load(way, load + k * h).film.energy
    slope = (8 * (energy[1] - energy[-1]) - (energy[2] - energy[-2])) / (12 * h)
    assert slope == pytest.approx(in_space.film.area, rel=1e-9)


def test_rod_is_in_balance_with_the_pull_of_the_surface(in_space: BranchPoint) -> None:
    film = in_space.film
    frame = edge(film)
    assert frame.conformality < 1e-8
    assert frame.force_balance(film.load, film.beta) < 1e-6
    assert frame.weights.sum() == pytest.approx(1, abs=1e-12)
    assert frame.kappa_n @ frame.weights == pytest.approx(0, abs=1e-10)
    assert frame.abs_kappa_n > 0.5


def test_planar_film_is_in_balance_and_has_no_gauss_curvature() -> None:
    film = planar(1700.0, 80).film
    frame = edge(film)
    assert frame.force_balance(film.load, film.beta) < 1e-6
    assert frame.abs_kappa_n == pytest.approx(0, abs=1e-12)
    assert frame.total_gauss_curvature == pytest.approx(0, abs=1e-12)


def test_edge_has_the_normals_of_the_harmonic_surface() -> None:
    film = twisted(1800.0).film
    whole = surface(film)
    # On the loop, the derivative by the radius of each harmonic r^k is k times it.
    inner = whole.at(0.999, whole.points)
    outer = whole.at(1.0, whole.points)
    theta = film.basis.grading.theta(film.basis.phi)
    nearest = np.round(theta / (2 * pi) * whole.points).astype(int) % whole.points
    way = (inner - outer)[nearest]
    way /= np.linalg.norm(way, axis=1)[:, None]
    assert ((way * edge(film).conormal).sum(axis=1)).min() > 0.99


def test_gauss_curvature_by_the_edge_is_that_of_the_surface() -> None:
    film = twisted(1800.0).film
    whole = surface(film)
    n = whole.points
    k = np.arange(len(whole.series))[:, None]
    nodes, weights = np.polynomial.legendre.leggauss(60)
    total = 0.0
    for r, w in zip((nodes + 1) / 2, weights / 2, strict=True):
        # X_w = sum k c_k w^(k-1) is isotropic; K dA = -|X_w x X_ww|^2 / |X_w|^4 dA.
        first, second = (
            k * r ** np.maximum(k - 1, 0),
            k * (k - 1) * r ** np.maximum(k - 2, 0),
        )
        z1 = 2 * np.fft.ifft(
            np.vstack([first * whole.series, 0 * whole.series[1:-1]]), axis=0
        )
        z2 = 2 * np.fft.ifft(
            np.vstack([second * whole.series, 0 * whole.series[1:-1]]), axis=0
        )
        turn = np.exp(1j * 2 * pi * np.arange(n) / n)[:, None]
        z1, z2 = z1 / turn, z2 / turn**2
        cross = np.linalg.norm(np.cross(z1, z2), axis=1)
        size = np.linalg.norm(z1, axis=1)
        total -= 2 * pi / n * w * r * float((2 * cross**2 / size**4).sum())
    assert total == pytest.approx(edge(film).total_gauss_curvature, rel=1e-3)


def test_a_film_is_found_again_from_nearby() -> None:
    film = planar(1700.0).film
    again = correct(film.basis, 1.001 * film.coefficients, film.beta, film.load)
    assert again is not None
    assert again.energy == pytest.approx(film.energy, rel=1e-13)


def test_where_no_eigenvalue_changes_its_sign_nothing_is_located() -> None:
    point = planar(1700.0)
    with pytest.raises(BranchError):
        locate(point, go_to_load(point, 1720.0), ABOUT_Z)


def test_a_branch_that_does_not_reach_a_load_says_so() -> None:
    # Twisted films exist below the onset only; beyond it the branch turns back.
    with pytest.raises(BranchError):
        go_to_load(twisted(1800.0).reversed(), 1900.0, max_points=40)


def test_families_hold_the_films_they_describe() -> None:
    assert planar(1700.0).film.basis.family == PLANAR
    assert twisted(1800.0).film.basis.family == TWISTED
    assert disk(make_basis(8, PLANAR), BUCKLING).energy == pytest.approx(
        BUCKLING / (4 * pi) + 4 * pi**2, rel=1e-13
    )
