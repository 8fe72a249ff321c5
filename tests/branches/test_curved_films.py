"""Films without a mesh whose rod is curved by nature: thresholds, balance, limits."""

from functools import cache
from itertools import pairwise
from math import inf, pi

import numpy as np
import pytest
from scipy.optimize import brentq

from eulerplateau.branches import StepControl, branches_from, first_point, follow
from eulerplateau.branches.conformal import (
    CurvedFamily,
    NoFilmError,
    SmoothFamily,
    Start,
    film_of,
    resolved,
    rod_film,
    tail,
)
from eulerplateau.branches.conformal.curved import curved
from eulerplateau.branches.point import point_near
from eulerplateau.branches.special import special_points
from eulerplateau.errors import SpecError
from eulerplateau.exact.conformal import GENERAL, TWISTED, disk, edge, make_basis
from eulerplateau.exact.planar import planar_film
from eulerplateau.solvers import Problem, solve, tangent_model
from tests.helpers.marks import quick_with
from tests.helpers.shapes import disk_points, mesh_of


def family_of_disk(basis, load, ratio, curvature, parameter):
    """Return the family and the disk in it."""
    values = {"load": load, "twist_ratio": ratio, "link": 0.0, "rest_curvature": curvature}
    family = CurvedFamily(basis, values, parameter)
    return family, family.unknowns.x(disk(basis, load).coefficients)


@pytest.mark.parametrize("n", [2, 3, 4])
@pytest.mark.parametrize(
    ("q", "g"),
    quick_with(
        [(0.5, 0.75), (1.4, 0.5)], [(0.3, 1.0), (0.5, 0.75), (1.0, 2 / 3), (1.4, 0.5)]
    ),
)
def test_disk_is_lost_across_its_plane_where_the_theory_says(n, q, g):
    """sigma_n = 16 pi^3 n (n + 1) [1 - q (q + g) / (q + g n^2)], to 1e-10."""
    expected = 16 * pi**3 * n * (n + 1) * (1 - q * (q + g) / (q + g * n * n))
    basis = make_basis(n + 3, TWISTED if n % 2 == 0 else GENERAL)

    def eigenvalue(load):
        model = tangent_model(
            family_of_disk(basis, load, g, q, "load")[0].energy(load),
            family_of_disk(basis, load, g, q, "load")[1],
        )
        return model.eigenvalues[np.abs(model.eigenvalues).argmin()]

    found = brentq(eigenvalue, 0.9999 * expected, 1.0001 * expected, xtol=1e-12, rtol=1e-14)
    assert found == pytest.approx(expected, rel=1e-10)


def test_natural_curvature_leaves_planar_films_and_shifts_their_energy():
    flat, known = rod_film(Start.LOBES, 1600.0, 0.75, 0.0, 0.6), planar_film(2, 1600.0)
    natural = 2 * pi * 0.6
    shift = natural**2 - 4 * pi * natural
    assert flat.energy == pytest.approx(known.energy + shift, rel=1e-10)
    assert flat.film.area == pytest.approx(known.area, rel=1e-10)
    assert flat.twist_energy == pytest.approx(0, abs=1e-20)


@cache
def saddle():
    """Return the film that leaves the disk across its plane, at q = 1.6 and 744."""
    basis = make_basis(24, TWISTED)
    family, flat = family_of_disk(basis, 24 * pi**3, 0.75, 1.3, "rest_curvature")
    control = StepControl(
        (1.2, 1.6), unit=1.0, largest_step=0.1, first_step=0.05, least=-inf
    )
    first = first_point(family, flat, 1.3, control)
    for before, after in pairwise([first, *follow(first, control)]):
        for special in special_points(before, after, control):
            for side in branches_from(special, control):
                *_, last = follow(side, control)
                landed = point_near(family, last.x, 1.6)
                return resolved(landed, control)
    raise AssertionError("the disk stays stable")


def imbalance(point):
    """Return max |F' + sigma T| / sigma with a frame.

    m = 2 kappa b - 2 k0 t x d_1 + C Omega t,  F = (F.t) t + t x m',  (F.t)' = F.t'.
    """
    family, film = point.family, film_of(point)
    frame, loop = edge(film), family.unknowns.loop(point.x)
    rod = family.twist(point.value)
    chi = family.unknowns.others(point.x)
    _, twisted, speed = family.frames.bent_and_twisted(loop.curve, chi)
    psi, _ = family.frames.angle(chi)
    t, bent = frame.tangent, frame.curvature
    u = np.array([0, 0, 1.0]) - t[:, 2:] * t
    u /= np.linalg.norm(u, axis=1)[:, None]
    normal = np.cos(psi)[:, None] * u + np.sin(psi)[:, None] * np.cross(t, u)

    def by_length(values):
        series = np.fft.rfft(values, axis=0)
        k = 1j * np.arange(len(series))[:, None]
        k[-1] = 0
        return np.fft.irfft(k * series, n=len(values), axis=0) / frame.speed[:, None]

    twist = 2 * rod.ratio * (twisted.value / speed.value)[:, None]
    natural = 2 * pi * rod.rest_curvature
    moment = 2 * np.cross(t, bent) - 2 * natural * np.cross(t, normal) + twist * t
    across = np.cross(t, by_length(moment))
    slope = (across * bent).sum(axis=1) * frame.speed
    series = np.fft.rfft(slope)
    k = np.arange(1, len(series))
    series[1:] = series[1:] / (1j * k)
    along = np.fft.irfft(series - np.r_[series[0], 0 * k], n=len(slope))[:, None]
    pull = film.load * frame.conormal
    off = by_length(along * t + across) + pull
    # The mean tension is what is left to choose: it adds beta t'.
    beta = -(off * bent).sum() / (bent**2).sum()
    return float(np.linalg.norm(off + beta * bent, axis=1).max() / film.load)


@pytest.mark.slow
def test_saddle_of_a_curved_rod_is_stable_and_balanced():
    """q = 1.6, C/B = 0.75, sigma = 24 pi^3: off its plane, without a mesh."""
    point = saddle()
    assert tail(point) < 1e-10  # of loop and frame
    assert edge(film_of(point)).abs_kappa_n > 1
    stability = point.family.in_space(point)
    assert stability.n_unstable == 0
    # What costs nothing, turning and sliding, has been taken out with its frame.
    assert stability.eigenvalues[0] > 1
    assert imbalance(point) < 1e-8


@pytest.mark.slow
def test_energy_of_the_saddle_changes_by_the_bending_it_lacks():
    """dE/dq = 2 pi (2 k0 - 2 oint k_1 ds), E along the branch by differences."""
    point, h = saddle(), 1e-3
    energies = []
    for q in (1.6 - h, 1.6 + h):
        near = point_near(point.family, point.x, q)
        film = film_of(near)
        energies.append(film.energy + near.family.twist(q).energy(near.x))
    rod = point.family.twist(point.value)
    natural = 2 * pi * rod.rest_curvature
    besides = rod.energy(point.x) - rod.twist_energy(point.x)
    bent = (natural**2 - besides) / (2 * natural)
    expected = 2 * pi * (2 * natural - 2 * bent)
    assert (energies[1] - energies[0]) / (2 * h) == pytest.approx(expected, rel=1e-5)


@pytest.mark.slow
def test_rod_that_is_hardly_curved_is_nearly_a_straight_one():
    """E(q) - E(0) tends to a multiple of q: the frame follows the curvature freely."""
    straight = rod_film(Start.TWISTED, 1700.0, 0.05)
    one, two = (rod_film(Start.TWISTED, 1700.0, 0.05, 0.0, q) for q in (0.002, 0.004))
    first, second = one.energy - straight.energy, two.energy - straight.energy
    assert first < 0
    assert second / first == pytest.approx(2, rel=0.02)
    assert one.writhe == pytest.approx(straight.writhe, abs=0.01)


@cache
def turned_once():
    """Return what the disk at 500, C/B = 1/2 and Lk = 1 leads to, at q = 0.4."""
    values = {"load": 500.0, "twist_ratio": 0.5, "link": 1.0}
    basis = make_basis(16, TWISTED)
    family = SmoothFamily(basis, values)
    flat = family.unknowns.x(disk(basis, 500.0).coefficients)
    return curved(point_near(family, flat, 500.0), 0.4)


@pytest.mark.slow
def test_film_of_a_rod_that_was_turned_once_is_stable_and_balanced():
    """q = 0.4, Lk = 1: its frame winds round it once, and there is no weld to be seen."""
    point = turned_once()
    assert tail(point) < 1e-10
    assert point.family.twist(point.value).writhe(point.x) > 0.01
    assert imbalance(point) < 1e-8
    stability = point.family.in_space(point)
    assert stability.n_unstable == 0
    assert stability.eigenvalues[0] > 1


@pytest.mark.parametrize("ratio", [0.4, pytest.param(0.7, marks=pytest.mark.slow)])
def test_disk_that_was_turned_once_gains_what_its_frame_can_take(ratio):
    """E(q) - E(0) = 4 pi^2 q^2 (1 - B / 2 C) + O(q^4).

    The frame, d_1 = n cos(s / R) + b sin(s / R), gives way by eta = a sin(s / R): that
    changes -2 k0 oint k_1 ds by 2 pi k0 a and the twist by gamma pi a^2 / 2 R. Nothing else
    answers: what pulls at the loop turns it or moves it as a whole.
    """
    straight = rod_film(Start.DISK, 500.0, ratio, 1.0)
    rises = []
    for q in (0.05, 0.1):
        found = rod_film(Start.DISK, 500.0, ratio, 1.0, q)
        rises.append((found.energy - straight.energy) / (2 * pi * q) ** 2)
    at_none = rises[0] + (rises[0] - rises[1]) / 3
    assert at_none == pytest.approx(1 - 1 / (2 * ratio), rel=1e-3)


@pytest.mark.slow
def test_film_of_a_rod_turned_the_other_way_is_the_mirror_image():
    left, right = (rod_film(Start.DISK, 500.0, 0.5, link, 0.3) for link in (-1.0, 1.0))
    assert left.energy == pytest.approx(right.energy, rel=1e-12)
    assert left.writhe == pytest.approx(-right.writhe, rel=1e-8)
    assert left.twist_moment == pytest.approx(-right.twist_moment, rel=1e-10)


@pytest.mark.slow
def test_work_of_a_turn_is_2_pi_times_the_moment_where_the_rod_was_welded():
    """dE/dLk = 2 pi M of whole turns, from either side: there the curvature jumps."""
    turned = rod_film(Start.DISK, 500.0, 0.5, 1.0, 0.3)
    h = 2e-3
    coarse, fine = (
        (
            rod_film(Start.DISK, 500.0, 0.5, 1.0 + step, 0.3).energy
            - rod_film(Start.DISK, 500.0, 0.5, 1.0 - step, 0.3).energy
        )
        / (2 * step)
        for step in (2 * h, h)
    )
    work = (4 * fine - coarse) / 3
    assert work == pytest.approx(2 * pi * turned.twist_moment, rel=1e-8)


def on_meshes(load, ratio, link, curvature, edges):
    """Yield energy, area, writhe and moment of the film on disks similar to each other."""
    for n in edges:
        mesh = mesh_of(*disk_points(n // 6))
        bent = mesh.x.copy()
        bent[:, 2] += 2 * bent[:, 0] * bent[:, 1]
        problem = Problem(
            mesh, "area", twist_ratio=ratio, link=link, rest_curvature=curvature
        )
        found = solve(problem, load, bent)
        assert found.is_minimum
        said = problem.said_of_loop(found.shape)[0]
        yield found.energy, found.film_energy / load, said["writhe"], said["twist_moment"]


def agrees(values, known, powers=(0, 2, 4)):
    """Assert that meshes come to a number with order 2, and to 1e-5 if extrapolated."""
    h, errors = 1 / np.array(EDGES), np.array(values) - known
    limit = np.linalg.lstsq(h[:, None] ** powers, errors, rcond=None)[0][0]
    assert limit == pytest.approx(0, abs=1e-5 * abs(known))
    order = np.polyfit(np.log(h), np.log(np.abs(errors)), 1)[0]
    assert order == pytest.approx(2, abs=0.15)


EDGES = (60, 84, 120, 168)


@pytest.mark.slow
def test_saddle_of_a_curved_rod_is_the_limit_of_meshes():
    point = saddle()
    energy, area, *_ = zip(*on_meshes(24 * pi**3, 0.75, 0.0, 1.6, EDGES), strict=True)
    rod = point.family.twist(point.value)
    agrees(energy, film_of(point).energy + rod.energy(point.x))
    agrees(area, film_of(point).area)


@pytest.mark.slow
def test_film_of_a_rod_that_was_turned_once_is_the_limit_of_meshes():
    """Its moment is another at every vertex, and no weld is seen there."""
    point = turned_once()
    energy, area, writhe, _ = zip(*on_meshes(500.0, 0.5, 1.0, 0.4, EDGES), strict=True)
    rod = point.family.twist(point.value)
    agrees(energy, film_of(point).energy + rod.energy(point.x))
    agrees(area, film_of(point).area)
    agrees(writhe, rod.writhe(point.x))


@pytest.mark.slow
def test_film_of_a_rod_whose_curvature_jumps_at_its_weld_is_the_limit_of_meshes():
    """The jump leaves a third power of the edges' length in what meshes err by."""
    found = rod_film(Start.DISK, 500.0, 0.75, 0.3, 0.3)
    assert found.resolved
    assert found.n_unstable == 0
    films = on_meshes(500.0, 0.75, 0.3, 0.3, EDGES)
    energy, area, writhe, moment = zip(*films, strict=True)
    known = found.energy, found.film.area, found.writhe, found.twist_moment
    for values, number in zip((energy, area, writhe, moment), known, strict=True):
        agrees(values, number, powers=(0, 2, 3))


def test_rod_whose_twist_costs_nothing_is_refused():
    with pytest.raises(SpecError, match="twist ratio"):
        rod_film(Start.LOBES, 1700.0, 0.0, 0.0, 0.5)


@pytest.mark.slow
def test_branch_that_folds_on_the_way_is_refused():
    with pytest.raises(NoFilmError, match="folds near the rest curvature 0"):
        rod_film(Start.TWISTED, 1700.0, 0.05, 0.0, 0.5)


def test_it_is_told_how_far_a_film_has_been_followed():
    told = []
    rod_film(Start.DISK, 500.0, 0.75, 0.0, 0.5, told.append)
    values = [float(where.removeprefix("rest curvature ")) for where in told]
    assert values[0] == 0
    assert values == sorted(values)
    assert 0 < values[-1] < 0.5
