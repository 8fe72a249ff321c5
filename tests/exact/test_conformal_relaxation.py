"""From a start to the true film: exact films, the energies' derivatives, refusals."""

from __future__ import annotations

from itertools import pairwise
from math import pi

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError
from eulerplateau.exact.conformal.energy import terms
from eulerplateau.exact.conformal.equilibrium import correct
from eulerplateau.exact.conformal.geometry import waist
from eulerplateau.exact.conformal.grading import Grading, dirichlet_form
from eulerplateau.exact.conformal.kernels import loop_derivatives, loop_energy
from eulerplateau.exact.conformal.relaxation import relax
from eulerplateau.exact.conformal.second_variation import morse_index
from eulerplateau.exact.conformal.sector import Sector, crowding_of, make_sector
from eulerplateau.exact.planar import planar_film

SECTORS = {"two lobes": 2, "three lobes": 3, "four lobes": 4}


def nome_of(crowding: float) -> float:
    """The nome of a grid of this crowding: the disk is a cylinder of its height."""
    return float(np.exp(-2 * Grading(crowding).height))


def ellipse(aspect: float, points: int, height: float = 0.1) -> FloatArray:
    """A start, equidistant in the angle and not in arc length, and of no special size."""
    angle = 2 * pi * np.arange(points) / points
    x, y = aspect * np.cos(angle), np.sin(angle)
    return np.stack([x, y, height * x * y], axis=1)


def lobed(n: int, points: int) -> FloatArray:
    angle = 2 * pi * np.arange(points) / points
    radius = 1 + 0.2 * np.cos(n * angle)
    x, y, z = radius * np.cos(angle), radius * np.sin(angle), 0.1 * np.sin(n * angle)
    return np.stack([x, y, z], axis=1)


@pytest.mark.parametrize("load", [1600.0, 1800.0])
def test_an_ellipse_relaxes_to_the_exact_two_lobes(load: float) -> None:
    exact, errors = planar_film(2, load), []
    for harmonics in (8, 16, 32):
        film = relax(ellipse(2.0, 6 * harmonics), load, harmonics)
        assert film is not None
        errors.append(abs(film.energy / exact.energy - 1))
    assert all(after < max(before / 50, 1e-13) for before, after in pairwise(errors))
    # Energies at their minimum err by the square of what shapes err by.
    shape = max(errors[-1] ** 0.5, 1e-7)
    assert film.area == pytest.approx(exact.area, rel=shape)
    assert film.beta == pytest.approx(exact.beta_hat, rel=10 * shape)
    assert film.residual < 1e-9
    assert morse_index(film) == 0


def test_an_ellipse_below_48_pi_cubed_relaxes_to_the_disk() -> None:
    film = relax(ellipse(1.5, 96), 1400.0, 16)
    assert film is not None
    assert film.energy == pytest.approx(1400 / (4 * pi) + 4 * pi**2, rel=1e-10)


def test_three_lobes_relax_to_the_exact_film() -> None:
    exact, errors = planar_film(3, 4500.0), []
    for harmonics in (24, 48, 96):
        film = relax(lobed(3, 6 * harmonics), 4500.0, harmonics, lobes=3)
        assert film is not None
        errors.append(abs(film.energy / exact.energy - 1))
    assert all(after < before / 20 for before, after in pairwise(errors))
    assert errors[-1] < 1e-9


@pytest.mark.parametrize(("lobes", "load"), [(2, 1700.0), (3, 4500.0)])
def test_newtons_method_on_the_whole_loop_confirms_the_film(
    lobes: int, load: float
) -> None:
    start = ellipse(2.0, 384) if lobes == 2 else lobed(3, 384)
    film = relax(start, load, 64, lobes)
    assert film is not None
    again = correct(film.basis, film.coefficients, film.beta, load)
    assert again is not None
    assert again.energy == pytest.approx(film.energy, rel=1e-9)
    whole = terms(film.basis, film.coefficients)
    assert whole.length == pytest.approx(1, abs=1e-9)
    assert whole.bending + load * whole.area == pytest.approx(film.energy, rel=1e-9)


def test_a_film_does_not_depend_on_the_size_of_its_start_nor_which_way_it_is_long() -> None:
    small, large = (relax(s * ellipse(2.0, 96), 1600.0, 16) for s in (1, 1024))
    across = relax(ellipse(0.5, 96), 1600.0, 16)
    assert small is not None
    assert large is not None
    assert across is not None
    assert large.energy == small.energy
    assert across.energy == pytest.approx(small.energy, rel=1e-9)
    for film in (small, across):
        extent = np.abs(film.curve.x).max(axis=0)
        assert extent[0] > 1.5 * extent[1]


def test_a_round_start_beyond_the_threshold_leaves_the_disk() -> None:
    film = relax(ellipse(1.0, 96), 1600.0, 16)
    assert film is not None
    assert film.energy == pytest.approx(planar_film(2, 1600.0).energy, rel=1e-8)


@pytest.mark.parametrize(("aspect", "load"), [(2.0, 1900.0), (3.0, 2000.0), (2.0, 2500.0)])
@pytest.mark.parametrize("harmonics", [16, 32])
def test_a_film_that_pinches_on_its_way_down_is_none(
    aspect: float, load: float, harmonics: int
) -> None:
    """Beyond the twist, 1855.68, what lies lower has no width left in its waist."""
    assert relax(ellipse(aspect, 6 * harmonics, 0.4), load, harmonics) is None


def test_waist_is_the_width_of_the_film_in_its_middle() -> None:
    film = relax(ellipse(2.0, 192), 1800.0, 32)
    assert film is not None
    sector = make_sector(32, 2)
    assert sector.waist(film.coefficients) == pytest.approx(waist(film), rel=1e-12)
    ahead, behind = planar_film(2, 1800.0).positions(np.array([0.25, 0.75]))
    assert waist(film) == pytest.approx(float(np.linalg.norm(ahead - behind)), rel=1e-7)


def test_a_start_with_corners_relaxes_too() -> None:
    side = np.linspace(-1, 1, 48, endpoint=False)
    rectangle = np.concatenate(
        [
            np.stack([2 + 0 * side, side], axis=1),
            np.stack([-2 * side, 1 + 0 * side], axis=1),
            np.stack([-2 + 0 * side, -side], axis=1),
            np.stack([2 * side, -1 + 0 * side], axis=1),
        ]
    )
    x, y = np.roll(rectangle, -24, axis=0).T
    film = relax(np.stack([x, y, 0.1 * x * y], axis=1), 1600.0, 48)
    assert film is not None
    assert film.energy == pytest.approx(planar_film(2, 1600.0).energy, rel=1e-9)


@pytest.fixture(params=SECTORS)
def sector(request: pytest.FixtureRequest) -> Sector:
    return make_sector(12, SECTORS[request.param])


def deformed(sector: Sector) -> FloatArray:
    """A wavy loop with the sector's symmetry."""
    noise = np.random.default_rng(3).normal(size=sector.size) / sector.k**3
    round_loop = 1.0 * ((sector.k == 1) & (sector.part != 2))
    found: FloatArray = round_loop + 0.05 * noise
    return found


def test_derivatives_have_taylor_slopes_of_two_and_three(sector: Sector) -> None:
    load, nome = 1700.0, 0.2
    c = deformed(sector)
    c = c / loop_energy(*sector.columns, load, c, nome)[1]
    energy, length, bending, area = loop_energy(*sector.columns, load, c, nome)
    assert length == pytest.approx(1, abs=1e-14)
    m = sector.size
    gradient, hessian = np.empty(m + 1), np.empty((m + 1, m + 1))
    beta = bending - 2 * load * area
    loop_derivatives(*sector.columns, load, c, nome, beta, area, gradient, hessian)
    assert np.array_equal(hessian, hessian.T)
    step = 0.01 * np.append(deformed(sector) / sector.k, 1.0)
    sizes = 0.1 * 0.5 ** np.arange(5)
    first, second = [], []
    for t in sizes:
        there = loop_energy(*sector.columns, load, c + t * step[:-1], nome + t * step[-1])
        linear = there[0] - energy - t * gradient @ step
        first.append(abs(linear))
        second.append(abs(linear - t**2 / 2 * step @ hessian @ step))
    assert np.polyfit(np.log(sizes), np.log(first), 1)[0] == pytest.approx(2, abs=0.05)
    assert np.polyfit(np.log(sizes), np.log(second), 1)[0] == pytest.approx(3, abs=0.1)


@pytest.mark.parametrize("crowding", [1.0, 0.5, 0.1, 1e-3, 1e-6])
def test_harmonics_are_orthogonal_in_the_energy_for_any_crowding(crowding: float) -> None:
    sector, points = make_sector(6, 2), 512
    phi = 2 * pi * np.arange(points) / points
    form = dirichlet_form(Grading(crowding), points)
    angle = np.outer(phi, sector.k)
    values = np.where(sector.part == 0, np.cos(angle), np.sin(angle))
    energies = values.T @ form @ values
    exact = sector.stiffness(nome_of(crowding))
    assert np.diag(energies) == pytest.approx(exact, rel=1e-9)
    assert np.abs(energies - np.diag(np.diag(energies))).max() < 1e-9 * exact.max()


@pytest.mark.parametrize("crowding", [1.0, 0.9, 0.3, 0.1, 1e-3, 1e-9])
def test_the_nome_gives_the_crowding_back(crowding: float) -> None:
    assert crowding_of(nome_of(crowding)) == pytest.approx(crowding, rel=1e-10)


def test_starts_that_lack_the_symmetry_are_refused() -> None:
    shifted = np.roll(ellipse(2.0, 96), 5, axis=0)
    for start, lobes in ((shifted, 2), (ellipse(2.0, 96), 3)):
        with pytest.raises(SpecError) as refused:
            relax(start, 1600.0, 16, lobes)
        assert refused.value.key == "start"


@pytest.mark.parametrize(
    ("harmonics", "lobes", "points"), [(3, 2, 96), (16, 1, 96), (16, 2, 32)]
)
def test_too_little_is_refused(harmonics: int, lobes: int, points: int) -> None:
    with pytest.raises(SpecError):
        relax(ellipse(2.0, points), 1600.0, harmonics, lobes)
