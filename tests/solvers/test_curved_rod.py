"""Films on a loop that is curved by nature: thresholds, work, mirror images, limits."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import root_scalar

from eulerplateau.errors import SpecError
from eulerplateau.loop import CurvedRod, differences
from eulerplateau.loop.writhe_kernels import tangent_area, writhe
from eulerplateau.mesh import Disk
from eulerplateau.solvers import Equilibrium, Problem, Status, solve, tangent_model
from tests.helpers import shapes
from tests.helpers.marks import quick_with

RATIO = 0.75
# k L^3 / alpha at which springs on an elongated disk are out of their plane.
LOAD = 1200.0


@cache
def disk(n_b: int) -> Disk:
    return shapes.mesh_of(*shapes.disk_points(n_b // 6))


def softening(n: int, q: float, g: float) -> float:
    """What is left of the disk's transverse threshold 16 pi^3 n (n + 1)."""
    return 1 - q * (q + g) / (q + g * n**2)


def transverse(film: str, load: float, q: float, g: float, n: int, n_b: int) -> float:
    """The eigenvalue of the flat film's transverse mode n."""
    mesh = disk(n_b)
    problem = Problem(mesh, film, twist_ratio=g, rest_curvature=q)
    energy = problem.film.of_loop(mesh.shape).energy(problem.loop, load)
    model = tangent_model(energy, mesh.shape.x_loop)
    values, vectors = model.eigen
    heights = model.modes(vectors).reshape(n_b, 3, -1)[:, 2]
    waves = np.abs(np.fft.fft(heights, axis=0)) ** 2
    return float(values[np.argmax(waves[n] + waves[-n])])


@pytest.mark.parametrize(
    ("film", "q", "g", "n"),
    [
        ("area", 0.5, 0.75, 2),
        ("dirichlet", 0.5, 1.0, 2),
        ("dirichlet", 1.5, 0.75, 2),
        ("dirichlet", 0.8, 0.5, 3),
        ("dirichlet", 2.0, 0.9, 3),
    ],
)
def test_the_disk_s_transverse_thresholds_are_lowered_with_order_2(
    film: str, q: float, g: float, n: int
) -> None:
    exact = 16 * np.pi**3 * n * (n + 1) * softening(n, q, g)
    errors = []
    for n_b in (36, 72):
        found = root_scalar(
            lambda load, n_b=n_b: transverse(film, load, q, g, n, n_b),
            x0=exact,
            x1=0.98 * exact,
            rtol=1e-7,
        )
        errors.append(found.root / exact - 1)
    assert abs(errors[1]) < 0.02
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.1)


def test_a_bare_ring_is_lost_at_its_classical_natural_curvature_with_order_2() -> None:
    """Without a film, where softening(2, q, g) is 0."""
    g = RATIO
    exact = 0.5 * (1 - g + np.sqrt((1 - g) ** 2 + 16 * g))
    assert softening(2, exact, g) == pytest.approx(0, abs=1e-14)
    errors = []
    for n_b in (36, 72):
        found = root_scalar(
            lambda q, n_b=n_b: transverse("dirichlet", 0.0, q, g, 2, n_b),
            x0=exact,
            x1=0.98 * exact,
            rtol=1e-8,
        )
        errors.append(found.root / exact - 1)
    assert abs(errors[1]) < 0.02
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.1)


def test_the_disk_s_energy_is_shifted() -> None:
    mesh, q = disk(48), 0.6
    bare = solve(Problem(mesh, "area"), 500.0)
    found = solve(Problem(mesh, "area", twist_ratio=RATIO, rest_curvature=q), 500.0)
    assert found.is_minimum
    k0 = 2 * np.pi * q
    assert found.energy - bare.energy == pytest.approx(k0**2 - 4 * np.pi * k0, rel=1e-10)


def test_a_soap_film_is_stable_out_of_its_plane_on_a_rod_that_is_curved_enough() -> None:
    """Beyond the disk's threshold, where a rod without twist leads to no stable film."""
    mesh, q, nu = disk(48), 1.6, 1.5
    assert 6 * softening(2, q, RATIO) < nu < 3
    x = mesh.x.copy()
    x[:, 2] += 2 * x[:, 0] * x[:, 1]
    problem = Problem(mesh, "area", twist_ratio=RATIO, rest_curvature=q)
    load = 16 * np.pi**3 * nu
    found = solve(problem, load, x)
    assert found.is_minimum
    assert np.ptp(found.shape.x[:, 2]) > 0.1
    flat = problem.equilibrium(mesh.shape, found.tensions, load, Status.CONVERGED)
    assert found.energy < flat.energy - 1


def bent(
    link: float, q: float = 0.3, flip: int = 1, ratio: float = RATIO
) -> tuple[Problem, Equilibrium]:
    """A film out of its plane: springs on an elongated disk, from a twisted start."""
    points, triangles = shapes.disk_points(8)
    mesh = shapes.mesh_of(points * [2.0, 1.0], triangles)
    x = mesh.x.copy()
    x[:, 2] += 6 * flip * x[:, 0] * x[:, 1]
    problem = Problem(mesh, "springs", twist_ratio=ratio, link=link, rest_curvature=q)
    return problem, solve(problem, LOAD, x)


def rod(problem: Problem) -> CurvedRod:
    found = problem.loop.terms["rod"]
    assert isinstance(found, CurvedRod)
    return found


def slope(of: list[float], steps: tuple[float, float]) -> float:
    """The derivative of an energy by Richardson, from differences over two steps."""
    quotients = [difference / (2 * h) for difference, h in zip(of, steps, strict=True)]
    return quotients[1] + (quotients[1] - quotients[0]) / 3


@pytest.mark.slow
def test_the_work_of_a_turn_of_the_weld_is_2_pi_times_the_moment_there() -> None:
    problem, found = bent(0.2)
    assert found.is_minimum
    columns = problem.said_of_loop(found.shape)[0]
    assert abs(columns["writhe"]) > 0.1
    moments = rod(problem).moments(found.shape.x_loop)
    assert np.ptp(moments) > 0.1 * np.abs(moments).max()
    steps = 0.004, 0.002
    gained = [bent(0.2 + h)[1].energy - bent(0.2 - h)[1].energy for h in steps]
    work = 2 * np.pi * columns["twist_moment"]
    assert slope(gained, steps) == pytest.approx(work, rel=1e-6)


@pytest.mark.slow
def test_the_work_of_natural_curvature_and_rigidity_is_that_of_their_parts() -> None:
    problem, found = bent(0.2)
    x, own = found.shape.x_loop, rod(problem)
    k0, twist = own.framed.natural, own.twist_energy(x)
    # At the weld the mean of two directions, 2 pi Lk apart, is what the rod is bent in.
    at_weld = problem.loop.mean_lengths[0] * np.sin(0.2 * np.pi) ** 2
    k0_squared = k0**2 * (1 - at_weld)
    bent_to = k0_squared - (own.energy(x) - twist)  # 2 k0 oint k1 ds
    steps = 0.008, 0.004
    gained = [bent(0.2, 0.3 + h)[1].energy - bent(0.2, 0.3 - h)[1].energy for h in steps]
    expected = (2 * k0_squared - bent_to) / 0.3
    assert slope(gained, steps) == pytest.approx(expected, rel=1e-6)
    gained = [
        bent(0.2, ratio=RATIO + h)[1].energy - bent(0.2, ratio=RATIO - h)[1].energy
        for h in steps
    ]
    assert slope(gained, steps) == pytest.approx(twist / RATIO, rel=1e-6)


def test_films_of_opposite_link_are_mirror_images() -> None:
    found, image = bent(0.2)[1], bent(-0.2, flip=-1)[1]
    assert found.residual < 1e-9
    assert image.energy == pytest.approx(found.energy, rel=1e-10)
    expected = pytest.approx(-writhe(found.shape.x_loop), abs=1e-7)
    assert writhe(image.shape.x_loop) == expected


@pytest.mark.slow
def test_conjugate_gradients_come_to_newtons_film() -> None:
    problem, found = bent(0.2)
    start = found.shape.moved(1.01 * found.shape.x)
    by_cg = solve(problem, LOAD, start, solver="cg")
    assert by_cg.converged
    assert by_cg.energy == pytest.approx(found.energy, rel=1e-8)


@pytest.mark.parametrize("film", quick_with(["area"], ["springs", "dirichlet", "area"]))
def test_many_turns_end_where_strands_meet_and_never_beyond(film: str) -> None:
    mesh = disk(48)
    x = mesh.x + 1e-3 * np.random.default_rng(1).standard_normal(mesh.x.shape)
    problem = Problem(mesh, film, twist_ratio=RATIO, link=3.0, rest_curvature=0.5)
    loops = [problem.disk.shape.x_loop]
    found = solve(problem, 300.0, x, observe=lambda x_loop: loops.append(x_loop.copy()))
    assert found.status is Status.PINCHED
    # A strand that passes through another takes two turns along, the tangents none.
    for before, after in pairwise(loops):
        area = tangent_area(differences(before), differences(after)) / (2 * np.pi)
        assert abs(writhe(after) - writhe(before) - area) < 0.1
    assert writhe(loops[-1]) > 0.5


@pytest.mark.parametrize(
    ("numbers", "culprit"),
    [
        ({"rest_curvature": 0.5}, "rest_curvature"),
        ({"rest_curvature": -0.5, "twist_ratio": 1.0}, "rest_curvature"),
        ({"rest_curvature": float("nan"), "twist_ratio": 1.0}, "rest_curvature"),
        ({"rest_curvature": 0.5, "twist_ratio": 1.0, "in_plane": True}, "rest_curvature"),
    ],
)
def test_numbers_that_no_rod_has_are_refused(
    numbers: dict[str, float], culprit: str
) -> None:
    with pytest.raises(SpecError, match=culprit):
        Problem(disk(36), "area", **numbers)  # type: ignore[arg-type]
