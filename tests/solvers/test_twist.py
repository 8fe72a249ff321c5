"""A loop that resists twist: thresholds of the disk, work and mirror images, its limits."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from scipy.optimize import brentq

from eulerplateau.errors import SpecError
from eulerplateau.mesh import Disk
from eulerplateau.solvers import Equilibrium, Problem, Status, solve, tangent_model
from tests.helpers import shapes
from tests.helpers.marks import quick_with

# Poisson's ratio of a round rod is (B / C) - 1: 1/3 of nylon.
ROUND = 0.75
# k L^3 / alpha at which springs on an elongated disk leave their plane, one way or other.
LOAD = 1200.0


@cache
def disk(n_b: int) -> Disk:
    return shapes.mesh_of(*shapes.disk_points(n_b // 6))


def critical_link(film: str, nu: float, ratio: float, n: int) -> float:
    """Phi_n / 2 pi of the flat disk: twist that it is lost at to mode n, in turns."""
    in_plane = {"area": n**2 - 1 - nu, "dirichlet": n**2 - 1 - nu * (n**2 - n - 1) / n**2}
    return float(np.sqrt(in_plane[film] * (1 - nu / (n * (n + 1)))) / ratio)


def lost_at(film: str, nu: float, ratio: float, n: int, n_b: int) -> float:
    """The link at which an eigenvalue of the polygon's flat film vanishes, for mode n."""
    mesh, load = disk(n_b), 16 * np.pi**3 * nu

    def lowest(link: float) -> float:
        problem = Problem(mesh, film, twist_ratio=ratio, link=link)
        energy = problem.film.of_loop(mesh.shape).energy(problem.loop, load)
        # Modes come in pairs, the lower n first.
        return float(tangent_model(energy, mesh.shape.x_loop).eigenvalues[2 * (n - 2)])

    near = critical_link(film, nu, ratio, n)
    return float(brentq(lowest, 0.75 * near, 1.1 * near, xtol=1e-10))


@pytest.mark.parametrize(
    ("film", "nu", "ratio", "n"),
    [
        ("area", 0.0, 1.0, 2),
        pytest.param("area", 1.0, 0.5, 2, marks=pytest.mark.slow),
        pytest.param("area", 2.0, 2 / 3, 2, marks=pytest.mark.slow),
        ("area", 2.5, 1.0, 3),
        pytest.param("area", 1.5, 2 / 3, 4, marks=pytest.mark.slow),
        ("dirichlet", 1.0, 0.5, 2),
        ("dirichlet", 2.0, 1.0, 3),
    ],
)
def test_the_flat_disk_is_lost_at_its_critical_link_with_order_2(
    film: str, nu: float, ratio: float, n: int
) -> None:
    exact = critical_link(film, nu, ratio, n)
    errors = [lost_at(film, nu, ratio, n, n_b) / exact - 1 for n_b in (36, 72)]
    assert abs(errors[1]) < 0.02
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.1)


@pytest.mark.slow
@pytest.mark.parametrize("film", ["area", "dirichlet"])
@pytest.mark.parametrize("n", [2, 3, 4])
@pytest.mark.parametrize("ratio", [0.5, 2 / 3, 1.0])
@pytest.mark.parametrize("nu", [0.2, 0.6, 1.0, 1.25, 2.2])
def test_at_all_loads_and_ratios(film: str, n: int, ratio: float, nu: float) -> None:
    """On finer meshes. Near nu = 1.7 the first term of the error of n = 3 vanishes."""
    exact = critical_link(film, nu, ratio, n)
    errors = [lost_at(film, nu, ratio, n, n_b) / exact - 1 for n_b in (54, 108)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.1)


def twisted(
    link: float, ratio: float = ROUND, flip: int = 1
) -> tuple[Problem, Equilibrium]:
    """A film out of its plane: springs on an elongated disk, from a twisted start."""
    points, triangles = shapes.disk_points(8)
    mesh = shapes.mesh_of(points * [2.0, 1.0], triangles)
    x = mesh.x.copy()
    x[:, 2] += 6 * flip * x[:, 0] * x[:, 1]
    problem = Problem(mesh, "springs", twist_ratio=ratio, link=link)
    return problem, solve(problem, LOAD, x)


def writhe(problem: Problem, found: Equilibrium) -> float:
    return problem.loop.terms["twist"].columns(found.shape.x_loop)["writhe"]


def test_the_work_of_a_turn_of_the_weld_is_2_pi_m() -> None:
    problem, found = twisted(0.2)
    assert found.converged
    assert abs(writhe(problem, found)) > 0.05
    moment = problem.loop.terms["twist"].columns(found.shape.x_loop)["twist_moment"]
    quotients = [
        (twisted(0.2 + h)[1].energy - twisted(0.2 - h)[1].energy) / (2 * h)
        for h in (0.02, 0.01)
    ]
    richardson = quotients[1] + (quotients[1] - quotients[0]) / 3
    assert richardson == pytest.approx(2 * np.pi * moment, rel=1e-6)


def test_energies_add_up_and_the_loop_balances() -> None:
    _, found = twisted(0.2)
    parts = found.film_energy + found.bending_energy + found.loop_energies["twist"]
    assert found.energy == pytest.approx(parts, rel=1e-14)
    assert found.residual < 1e-9
    assert found.n_unstable == 0


def test_films_of_opposite_link_are_mirror_images() -> None:
    (problem, found), (other, image) = twisted(0.2), twisted(-0.2, flip=-1)
    assert image.energy == pytest.approx(found.energy, rel=1e-10)
    assert writhe(other, image) == pytest.approx(-writhe(problem, found), abs=1e-7)
    # And one link has two films that differ, where there was one and its image.
    wrong = twisted(0.2, flip=-1)[1]
    assert abs(wrong.energy / found.energy - 1) > 1e-3


def test_twist_that_costs_next_to_nothing_costs_what_the_free_film_would_have() -> None:
    problem, near = twisted(0.0)
    mesh, load = problem.disk, 800.0  # at LOAD the free film has become a flat eight
    free = solve(Problem(mesh, "springs"), load, near.shape)
    turned = 2 * np.pi * writhe(problem, free)
    assert free.is_minimum
    assert abs(turned) > 0.1
    spared = []
    for ratio in (1e-3, 1e-4):
        rod = Problem(mesh, "springs", twist_ratio=ratio)
        cost = solve(rod, load, free.shape).energy - free.energy
        spared.append(1 - cost / (ratio * turned**2))
    # By what the film does about it, which is proportional to the ratio.
    assert 0 < spared[1] < 0.01
    assert spared[0] / spared[1] == pytest.approx(10, rel=0.02)


def test_conjugate_gradients_come_to_newtons_film() -> None:
    problem, found = twisted(0.2)
    by_cg = solve(problem, LOAD, found.shape.moved(1.01 * found.shape.x), solver="cg")
    assert by_cg.converged
    assert by_cg.energy == pytest.approx(found.energy, rel=1e-8)


@pytest.mark.parametrize("film", quick_with(["area"], ["springs", "dirichlet", "area"]))
def test_many_turns_end_where_strands_meet_and_never_beyond(film: str) -> None:
    mesh = disk(48)
    x = mesh.x + 1e-3 * np.random.default_rng(1).standard_normal(mesh.x.shape)
    problem = Problem(mesh, film, twist_ratio=ROUND, link=3.0)
    found = solve(problem, 300.0, x)
    assert found.status is Status.PINCHED
    # A strand that had passed through another would have taken two turns along.
    assert 0 < writhe(problem, found) < 1.2


@pytest.mark.slow
def test_a_large_loop_under_a_soap_film_is_lost_at_its_critical_link_too() -> None:
    mesh, nu = disk(72), 1.0
    x = mesh.x + 1e-3 * np.random.default_rng(1).standard_normal(mesh.x.shape)
    for part in (0.93, 1.03):
        link = part * critical_link("area", nu, ROUND, 2)
        problem = Problem(mesh, "area", twist_ratio=ROUND, link=link)
        found = solve(problem, 16 * np.pi**3 * nu, x)
        if part < 1:
            assert found.is_minimum
            assert abs(writhe(problem, found)) < 1e-9
        else:
            assert abs(writhe(problem, found)) > 0.5


def test_in_its_plane_a_loop_keeps_the_twist_it_was_given() -> None:
    mesh = disk(48)
    bare = solve(Problem(mesh, "area", in_plane=True), 500.0)
    held = Problem(mesh, "area", in_plane=True, twist_ratio=ROUND, link=1.5)
    found = solve(held, 500.0)
    assert found.status is bare.status
    assert found.n_unstable == bare.n_unstable
    twist = 0.5 * (2 * ROUND) * (2 * np.pi * 1.5) ** 2
    assert found.loop_energies["twist"] == pytest.approx(twist, rel=1e-14)
    assert found.energy - twist == pytest.approx(bare.energy, rel=1e-12)


@pytest.mark.parametrize(
    ("numbers", "culprit"),
    [
        ({"link": 1.0}, "link needs twist_ratio"),
        ({"twist_ratio": 0.0}, "twist_ratio"),
        ({"twist_ratio": float("nan")}, "twist_ratio"),
        ({"twist_ratio": 1.0, "link": float("inf")}, "link"),
    ],
)
def test_numbers_that_no_rod_has_are_refused(
    numbers: dict[str, float], culprit: str
) -> None:
    with pytest.raises(SpecError, match=culprit.split()[0]):
        Problem(disk(36), **numbers)  # type: ignore[arg-type]
