"""Films in their plane by the tangent angle: exact films, derivatives, limits, refusals."""

from __future__ import annotations

from itertools import pairwise
from math import inf, nan, pi

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError
from eulerplateau.exact.planar import planar_film, thresholds
from eulerplateau.exact.tangent_angle.kernels import (
    MORE_POINTS,
    differentiate,
    solve,
    tabulate,
    transform,
)
from eulerplateau.exact.tangent_angle.relaxation import PlaneLoop, relax_in_plane

FILMS = [(2, 1600.0), (2, 2000.0), (2, 2400.0), (3, 4500.0), (5, 30000.0)]
# Far more digits than rounding in sums of a few hundred terms costs.
ROUNDING = 1e-11


def lobed(n: int, points: int, depth: float = 0.2) -> FloatArray:
    """A start r = 1 + depth cos(n angle), not equidistant in arc length."""
    angle = 2 * pi * np.arange(points) / points
    radius = 1 + depth * np.cos(n * angle)
    return radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def ellipse(aspect: float, angle: FloatArray) -> FloatArray:
    return np.stack([aspect * np.cos(angle), np.sin(angle)], axis=1)


def film_of(n: int, load: float, harmonics: int, depth: float = 0.2) -> PlaneLoop:
    film = relax_in_plane(lobed(n, 6 * n * harmonics, depth), load, harmonics, n)
    assert film is not None
    return film


@pytest.mark.parametrize(("n", "load"), FILMS)
def test_energies_fall_to_the_exact_one_exponentially(n: int, load: float) -> None:
    """Ritz: more harmonics, less energy, and never less than the exact one."""
    exact = planar_film(n, load).energy
    errors = [film_of(n, load, m).energy / exact - 1 for m in (2, 4, 6, 8, 10, 12)]
    assert all(after < max(before / 10, ROUNDING) for before, after in pairwise(errors))
    assert min(errors) > -ROUNDING


@pytest.mark.parametrize(("n", "load"), FILMS)
def test_the_film_is_the_exact_one(n: int, load: float) -> None:
    film, exact = film_of(n, load, 20), planar_film(n, load)
    assert film.energy == pytest.approx(exact.energy, rel=ROUNDING)
    assert film.area == pytest.approx(exact.area, rel=ROUNDING)
    assert film.beta == pytest.approx(exact.beta_hat, abs=ROUNDING * exact.energy)
    assert film.energy == film.bending + load * film.area
    assert film.residual < ROUNDING
    s = np.linspace(0, 1, 400)
    assert np.abs(film.positions(s) - exact.positions(s)).max() < ROUNDING
    # By two orders more: derivatives of 20 n waves.
    off = np.abs(film.curvature(s) - exact.curvature(s)).max()
    assert off < 100 * ROUNDING * exact.kappa_max


@pytest.mark.parametrize(("n", "load"), FILMS)
def test_the_rod_balances_the_film_in_every_point(n: int, load: float) -> None:
    """2 kappa'' + kappa^3 - beta kappa - sigma = 0, eq. shape-equation-nodim corrected."""
    film = film_of(n, load, 20)
    s = np.linspace(0, 1 / n, 100)
    wave = 2 * pi * n * np.arange(1, 21)
    kappa = film.curvature(s)
    bend = -np.cos(np.outer(s, wave)) @ (wave**3 * film.coefficients)
    parts = np.stack([2 * bend, kappa**3, -film.beta * kappa, np.full_like(s, -load)])
    assert np.abs(parts.sum(axis=0)).max() < 1e-8 * np.abs(parts).max()


@pytest.mark.parametrize(("n", "load"), [(2, 0.0), (2, 1400.0), (3, 3900.0), (6, 17000.0)])
def test_below_its_threshold_a_lobed_start_relaxes_to_the_disk(n: int, load: float) -> None:
    film = film_of(n, load, 8)
    assert film.energy == pytest.approx(load / (4 * pi) + 4 * pi**2, rel=ROUNDING)
    assert film.area == pytest.approx(1 / (4 * pi), rel=ROUNDING)
    assert film.curvature(np.linspace(0, 1, 50)) == pytest.approx(2 * pi, rel=1e-6)


@pytest.mark.parametrize(("n", "load"), FILMS)
def test_a_round_start_beyond_the_threshold_leaves_the_disk(n: int, load: float) -> None:
    round_start, lobes = film_of(n, load, 12, depth=0.0), film_of(n, load, 12)
    assert round_start.energy == pytest.approx(lobes.energy, rel=ROUNDING)
    assert round_start.coefficients[0] > 0.1


@pytest.mark.parametrize("n", range(2, 7))
def test_every_load_from_nothing_to_contact_converges(n: int) -> None:
    """At the threshold the softest mode costs nothing: E ~ c^4, and the loads crowd it."""
    limits = thresholds(n)
    near = limits.sigma_buckling * (1 + np.array([-1e-6, 0, 1e-12, 1e-8, 1e-4]))
    up = np.linspace(0, 0.9999 * limits.sigma_contact, 30)
    for load in (*near, *up):
        film = film_of(n, float(load), 12)
        exact = planar_film(n, float(load))
        assert film.energy == pytest.approx(exact.energy, rel=1e-9), load
        # Lobes keep apart: a half lobe stays in its half of the sector.
        x, y = film.positions(np.linspace(0, 0.5 / n, 200)).T
        assert (y > -1e-15).all()
        assert (np.arctan2(y, x) < pi / n + 1e-12).all()


@pytest.mark.parametrize(("n", "load"), [*FILMS, (3, 10700.0), (5, 48000.0)])
def test_the_waist_is_the_exact_loops(n: int, load: float) -> None:
    """The neck's width, which a fine grid overrates by h^2; without a neck the end's."""
    y = planar_film(n, load).positions(np.linspace(0, 0.5 / n, 20001))[:, 1]
    necks = y[1:-1][(y[1:-1] < y[:-2]) & (y[1:-1] < y[2:])]
    width = 2 * (necks[0] if len(necks) else y[-1])
    assert film_of(n, load, 16).waist == pytest.approx(width, abs=1e-6)


@pytest.mark.parametrize("n", range(2, 7))
def test_strands_that_cross_are_no_film(n: int) -> None:
    contact, points = thresholds(n).sigma_contact, lobed(n, 200 * n)
    widths = [film_of(n, (1 - gap) * contact, 16).waist for gap in (1e-2, 1e-4, 1e-6)]
    assert all(0 < after < before / 30 for before, after in pairwise(widths))
    for load in ((1 + 1e-6) * contact, 1.1 * contact, 10 * contact, 1e8, 1e12, 1e300):
        assert relax_in_plane(points, load, 16, n) is None


def test_a_film_depends_neither_on_the_starts_size_nor_on_where_it_lies() -> None:
    start = lobed(2, 96)
    film = relax_in_plane(start, 1600.0, 8)
    assert film is not None
    for same in (1024 * start, np.pad(start, ((0, 0), (0, 1)))):
        again = relax_in_plane(same, 1600.0, 8)
        assert again is not None
        assert np.array_equal(again.coefficients, film.coefficients)
    for other in (1e-9 * start, 1e9 * start, start + np.array([3.0, -4.0])):
        again = relax_in_plane(other, 1600.0, 8)
        assert again is not None
        assert again.energy == pytest.approx(film.energy, rel=ROUNDING)


def test_spacing_shape_and_corners_of_a_start_make_no_difference() -> None:
    even = 2 * pi * np.arange(96) / 96
    noise = np.random.default_rng(5).uniform(-0.3, 0.3, 96) * 2 * pi / 96
    uneven = even + np.where(even > 0, noise, 0)
    side = np.linspace(-1, 1, 24, endpoint=False)
    one = np.ones_like(side)
    sides = ((2 * one, side), (-2 * side, one), (-2 * one, -side), (2 * side, -one))
    rectangle = np.concatenate([np.stack(xy, axis=1) for xy in sides])
    starts = [ellipse(aspect, even) for aspect in (0.1, 0.5, 1.1, 2.0, 10.0)]
    starts += [ellipse(2.0, uneven), np.roll(rectangle, -12, axis=0)]
    exact = planar_film(2, 1600.0).energy
    for start in starts:
        film = relax_in_plane(start, 1600.0, 8)
        assert film is not None
        assert film.energy == pytest.approx(exact, rel=ROUNDING)
        # Whichever way the start is long, the film lies along x.
        width, height = np.ptp(film.positions(np.arange(80) / 80), axis=0)
        assert width > 1.5 * height


def tables(c: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    count = len(c) + MORE_POINTS
    cosine, sine = np.empty((2, count, count + 1))
    tabulate(cosine, sine)
    return cosine, sine, np.empty(2 * count + 4 * len(c) - 1)


@pytest.fixture(params=[2, 3, 7])
def lobes(request: pytest.FixtureRequest) -> int:
    return int(request.param)


def wavy(lobes: int) -> FloatArray:
    return np.random.default_rng(lobes).normal(size=6) * 0.5 / np.arange(1, 7) ** 2


def test_bending_and_area_are_those_of_the_drawn_loop(lobes: int) -> None:
    """With twice the points: how many are few enough is another test's matter."""
    c = np.concatenate([wavy(lobes), np.zeros(20)])
    bending, area = transform(c, lobes, *tables(c))
    points = 2048
    s = np.arange(points) / points
    wave = 2 * pi * lobes * np.arange(1, len(c) + 1)
    theta = pi / 2 + 2 * pi * s + np.sin(np.outer(s, wave)) @ c
    kappa = 2 * pi + np.cos(np.outer(s, wave)) @ (wave * c)
    tangent = np.fft.fft(np.exp(1j * theta)) / points
    turns = np.fft.fftfreq(points, 1 / points)
    closed = turns != 0
    assert abs(tangent[0]) < 1e-14
    signed = np.abs(tangent[closed]) ** 2 / (4 * pi * turns[closed])
    assert bending == pytest.approx(np.mean(kappa**2), rel=ROUNDING)
    assert area == pytest.approx(signed.sum(), rel=ROUNDING)


def test_derivatives_have_taylor_slopes_of_two_and_three(lobes: int) -> None:
    c, load, sizes = wavy(lobes), 2000.0 * lobes**2, 0.1 * 0.5 ** np.arange(6)
    work, m = tables(c), len(c)
    wave = 2 * pi * lobes * np.arange(1, m + 1)

    def energy(at: FloatArray) -> float:
        bending, area = transform(at, lobes, *work)
        return float(bending + load * area)

    start = energy(c)
    gradient, upper = np.empty(m), np.empty((m, m))
    differentiate(c, lobes, load, work[2], gradient, upper)
    hessian = np.triu(upper) + np.triu(upper, 1).T
    step = np.random.default_rng(1).normal(size=m)
    first, second = [], []
    for t in sizes:
        linear = energy(c + t * step / wave) - start - t * gradient @ step
        first.append(abs(linear))
        second.append(abs(linear - t**2 / 2 * step @ hessian @ step))
    assert np.polyfit(np.log(sizes), np.log(first), 1)[0] == pytest.approx(2, abs=0.05)
    assert np.polyfit(np.log(sizes), np.log(second), 1)[0] == pytest.approx(3, abs=0.1)


def test_the_disks_hessian_is_zero_at_its_thresholds(lobes: int) -> None:
    """Mode k of a lobe is mode n k of the loop: 16 pi^3 (n^2 k^2 - 1)."""
    c = np.zeros(4)
    work = tables(c)
    transform(c, lobes, *work)
    load = 16 * pi**3
    gradient, hessian = np.empty(4), np.empty((4, 4))
    differentiate(c, lobes, load, work[2], gradient, hessian)
    assert np.abs(gradient).max() < 1e-14
    exact = 1 - 1 / ((lobes * np.arange(1, 5)) ** 2 - 1)
    assert np.triu(hessian) == pytest.approx(np.diag(exact), abs=1e-13)


def test_shifted_systems_are_solved_where_positive_definite() -> None:
    rng = np.random.default_rng(7)
    root, x = rng.normal(size=(9, 9)), rng.normal(size=9)
    matrix, room = root @ root.T, np.empty((9, 9))
    solved = x.copy()
    assert solve(matrix, 0.5, room, solved)
    assert (matrix + 0.5 * np.eye(9)) @ solved == pytest.approx(x, abs=1e-10)
    lowest = np.linalg.eigvalsh(matrix)[0]
    assert not solve(matrix, -1.01 * lowest, room, x.copy())
    assert not solve(np.full((9, 9), nan), 0.0, room, x.copy())


EVEN = 2 * pi * np.arange(96) / 96
GOOD = ellipse(2.0, EVEN)
EIGHT = np.stack([np.cos(EVEN), np.sin(2 * EVEN)], axis=1)
TURN = np.array([[np.cos(0.05), np.sin(0.05)], [-np.sin(0.05), np.cos(0.05)]])


@pytest.mark.parametrize(
    "start",
    [
        pytest.param(GOOD[:32], id="few points"),
        pytest.param(GOOD.ravel(), id="one dimension"),
        pytest.param(np.pad(GOOD, ((0, 0), (0, 2))), id="four dimensions"),
        pytest.param(np.where(EVEN[:, None] == EVEN[7], nan, GOOD), id="nan"),
        pytest.param(np.where(EVEN[:, None] == EVEN[7], inf, GOOD), id="infinite"),
        pytest.param(np.column_stack([GOOD, 0.01 * EVEN]), id="out of its plane"),
        pytest.param(np.concatenate([GOOD, GOOD[:1]]), id="vertex twice"),
        pytest.param(0 * GOOD, id="one point"),
        pytest.param(GOOD[::-1], id="clockwise"),
        pytest.param(EIGHT, id="eight"),
        pytest.param(np.concatenate([GOOD, 1.1 * GOOD]), id="twice round"),
        pytest.param(np.roll(GOOD, 5, axis=0), id="first vertex at no tip"),
        pytest.param(GOOD @ TURN, id="turned"),
        pytest.param(lobed(3, 96), id="other lobes"),
        pytest.param(GOOD + 0.1 * GOOD**2, id="lobes unlike"),
    ],
)
def test_what_is_no_start_is_refused(start: FloatArray) -> None:
    with pytest.raises(SpecError) as refused:
        relax_in_plane(start, 1600.0, 8)
    assert refused.value.key == "start"
    assert refused.value.exit_code == 2


@pytest.mark.parametrize(
    ("load", "harmonics", "lobes", "key"),
    [
        (1600.0, 0, 2, "harmonics"),
        (1600.0, 8, 1, "lobes"),
        (-1.0, 8, 2, "tension"),
        (nan, 8, 2, "tension"),
        (inf, 8, 2, "tension"),
    ],
)
def test_numbers_out_of_range_are_refused(
    load: float, harmonics: int, lobes: int, key: str
) -> None:
    with pytest.raises(SpecError) as refused:
        relax_in_plane(GOOD, load, harmonics, lobes)
    assert refused.value.key == key
    assert refused.value.exit_code == 2


@pytest.mark.parametrize("harmonics", [7, 8, 16, 17])
@pytest.mark.parametrize(("n", "load"), FILMS[:4])
def test_a_start_between_two_lobes_leads_to_the_same_film(
    n: int, load: float, harmonics: int
) -> None:
    """For odd numbers of harmonics as for even ones: energy, places and curvature agree."""
    start = lobed(n, 6 * n * harmonics)
    from_tip = relax_in_plane(start, load, harmonics, n)
    # Half a lobe on, and turned so that the first vertex lies on the axis x > 0.
    turned = pi / n
    rotation = np.array(
        [[np.cos(turned), -np.sin(turned)], [np.sin(turned), np.cos(turned)]]
    )
    between = np.roll(start, -3 * harmonics, axis=0) @ rotation
    from_between = relax_in_plane(between, load, harmonics, n)
    assert from_tip is not None
    assert from_between is not None
    assert from_between.energy == pytest.approx(from_tip.energy, rel=ROUNDING)
    assert from_between.area == pytest.approx(from_tip.area, rel=ROUNDING)
    assert from_between.waist == pytest.approx(from_tip.waist, abs=1e-7)
    s = np.linspace(0, 1, 300)
    assert np.abs(from_between.positions(s) - from_tip.positions(s)).max() < 1e-7
    exact = planar_film(n, load)
    closeness = 1e-4 if harmonics < 16 else 1e-6
    assert np.abs(from_between.positions(s) - exact.positions(s)).max() < closeness
    # What is drawn is what the tangent angle says: the curvature is its derivative.
    h = 1e-5
    ahead, behind = from_between.positions(s + h), from_between.positions(s - h)
    tangent = (ahead - behind) / (2 * h)
    assert np.linalg.norm(tangent, axis=1) == pytest.approx(1.0, abs=1e-6)
