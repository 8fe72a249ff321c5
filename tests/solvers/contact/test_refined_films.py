"""Films that are finer where strands of a thick loop cross."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from scipy.spatial import Delaunay

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.conformal.contact_eight import refined, touching
from eulerplateau.mesh import Disk, mesh_polygon
from eulerplateau.solvers import Equilibrium, Problem, Status, solve, sweep
from scripts.studies.contact_eight.refinement import DIAMETER, LOADS, WAY
from tests.helpers import shapes

# Edges of the loop, 1/48, are more than twice as long as the line is thick.
LOAD, THICK = 1700.0, 0.008
# Rings of so many vertices: coarser inside, as graded meshes are.
RINGS = {48: 1.0, 24: 0.8, 12: 0.5, 6: 0.2}


def graded() -> Disk:
    parts = [
        radius * np.exp(2j * np.pi * (np.arange(n) / n + 0.3 * (n < 48)))
        for n, radius in RINGS.items()
    ]
    places = np.concatenate([*parts, [0.0]])
    points = np.column_stack([places.real, places.imag])
    return shapes.mesh_of(points, Delaunay(points).simplices)


MESH = graded()


def eight(mesh: Disk, thick: float) -> FloatArray:
    """A loop (n_b, 3) whose strands cross once, farther apart than the line is thick."""
    t = 2 * np.pi * np.cumsum(mesh.rest_lengths)
    x = np.column_stack([0.2 * np.sin(t), 0.1 * np.sin(2 * t), thick * np.cos(t)])
    return x / float(np.linalg.norm(np.roll(x, -1, axis=0) - x, axis=1).sum())


def problem_of(diameter: float = THICK, *, refine: bool = True, **rod: float) -> Problem:
    return Problem(MESH, "area", diameter=diameter, refine=refine, **rod)


def from_eight(problem: Problem, load: float) -> Equilibrium:
    tied, diameter = problem.tied_film(), problem.loop.diameter
    assert tied is not None
    assert diameter is not None
    return solve(problem, load, tied.shape(eight(problem.disk, diameter)))


@cache
def found(refine: bool) -> Equilibrium:
    return from_eight(problem_of(refine=refine), LOAD)


def test_vertices_are_added_near_the_contact_and_the_state_is_kept() -> None:
    plain, finer = found(False), found(True)
    assert plain.is_minimum
    assert finer.is_minimum
    assert len(plain.shape.x) == MESH.n_v < len(finer.shape.x)
    loop = problem_of().loop_of(finer.shape)
    assert finer.shape.loop[finer.shape.loop < MESH.n_v].tolist() == MESH.loop.tolist()
    assert len(finer.tensions) == len(finer.shape.loop) == len(loop.rest_lengths)
    assert finer.length_error < 1e-13
    assert finer.contacts is not None
    assert len(finer.contacts) == 1
    assert finer.contacts.smallest_gap > -1e-11
    place = finer.contacts.points.mean(axis=(0, 1))
    away = np.linalg.norm(finer.shape.x - place, axis=1)
    assert np.median(away[MESH.n_v :]) < np.median(away[: MESH.n_v])


def test_a_finer_film_has_less_area_and_so_less_energy() -> None:
    """It may be bent wherever the coarse one may, and elsewhere too."""
    plain, finer = found(False), found(True)
    assert finer.film_energy < plain.film_energy
    assert finer.energy < plain.energy


ROD = {"twist_ratio": 2 / 3, "link": 0.25}


@pytest.mark.parametrize(
    "rod",
    [
        {},
        pytest.param(ROD, marks=pytest.mark.slow),
        pytest.param({**ROD, "rest_curvature": 0.5}, marks=pytest.mark.slow),
    ],
)
def test_strands_push_with_the_slope_of_the_refined_film_s_energy(
    rod: dict[str, float],
) -> None:
    """Whatever the rod resists beside bending."""
    finer, h = from_eight(problem_of(**rod), LOAD), 1e-4
    assert finer.contacts is not None
    wide, narrow = (
        solve(problem_of(THICK + way * h, **rod), LOAD, finer) for way in (1, -1)
    )
    assert len(wide.shape.x) == len(narrow.shape.x) == len(finer.shape.x)
    slope = (wide.energy - narrow.energy) / (2 * h)
    assert finer.contacts.force == pytest.approx(slope, rel=1e-4)


def test_edges_of_the_loop_are_parts_of_the_mesh_s_and_short_where_strands_cross() -> None:
    finer, rest = found(True), MESH.rest_lengths
    loop, parts = problem_of().loop_of(finer.shape), MESH.parts(finer.shape.loop)
    assert loop.rest_lengths.tolist() == np.repeat(rest / parts, parts).tolist()
    assert set(parts) == {1, 2}
    assert finer.contacts is not None
    knots = np.cumsum(loop.rest_lengths)
    for place in (finer.contacts.s, finer.contacts.t):
        edge = np.searchsorted(knots, place % 1.0)
        assert (loop.rest_lengths[edge] <= 1.5 * THICK).all()


def test_a_film_that_is_fine_enough_is_left_alone() -> None:
    finer = found(True)
    again = solve(problem_of(), LOAD, finer)
    assert again.shape.triangles.tolist() == finer.shape.triangles.tolist()
    assert again.energy == pytest.approx(finer.energy, rel=1e-13)
    assert problem_of(0.05).refines
    wide = from_eight(problem_of(0.05), LOAD)
    assert wide.contacts is not None
    assert len(wide.contacts) == 1
    assert len(wide.shape.x) == MESH.n_v


@pytest.mark.slow
def test_numbers_of_vertices_do_not_matter() -> None:
    order = np.random.default_rng(5).permutation(MESH.n_v)
    number = np.argsort(order)
    mesh = Disk.from_triangles(MESH.x[order], number[MESH.triangles])
    problem = Problem(mesh, "area", diameter=THICK)
    tied = problem.tied_film()
    assert tied is not None
    places = np.empty((MESH.n_v, 3))
    places[MESH.loop] = eight(MESH, THICK)
    other, finer = solve(problem, LOAD, tied.shape(places[order][mesh.loop])), found(True)
    assert other.contacts is not None
    assert finer.contacts is not None
    assert len(other.shape.loop) == len(finer.shape.loop)
    # Where vertices inside lie, and so how many there are, is no part of the state.
    assert other.energy == pytest.approx(finer.energy, rel=1e-5)
    assert other.contacts.force == pytest.approx(finer.contacts.force, rel=1e-2)


def test_where_strands_have_parted_the_film_is_its_mesh_s_again() -> None:
    opened = solve(problem_of(), 300.0, found(True))
    assert opened.contacts is not None
    assert len(opened.contacts) == 0
    assert len(opened.shape.x) == MESH.n_v
    assert opened.energy == pytest.approx(solve(problem_of(), 300.0).energy, rel=1e-12)


@pytest.mark.parametrize(
    ("film", "diameter"),
    [
        ("area", None),
        ("springs", None),
        pytest.param("springs", THICK, marks=pytest.mark.slow),
    ],
)
def test_a_problem_that_does_not_refine_takes_of_a_refined_shape_its_loop(
    film: str, diameter: float | None
) -> None:
    """One that has no contact, or whose film is tied to its mesh."""
    problem = Problem(MESH, film, diameter=diameter)
    tied = problem.tied_film()
    assert tied is not None
    taken = solve(problem, LOAD, found(True).shape)
    assert len(taken.shape.x) == MESH.n_v
    alike = solve(problem, LOAD, tied.shape(found(True).shape.x[MESH.loop]))
    assert taken.energy == pytest.approx(alike.energy, rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("vertices", [700, 960])
def test_a_finer_film_halves_the_error_of_the_force_of_a_thin_line(vertices: int) -> None:
    """Or more, and is a film where the mesh's own lies in folds.

    The loop's edges are four to six times as long as the line is thick, as they were. The
    eight is what two lobes snap to, unloaded: one drawn on the finer mesh has by chance
    triangles in its waist that are short enough, and is left alone.
    """
    load = 600.0
    values = {"load": load, "diameter": DIAMETER, "twist_ratio": 0.0, "link": 0.0}
    exact = refined(touching(values))[1].force
    mesh = mesh_polygon("ellipse", aspect=2.0, vertices=vertices, grading=5.0)
    loads = [*WAY, *(each for each in LOADS if each >= load)]
    errors = []
    for refine in (False, True):
        *_, last = sweep(Problem(mesh, "area", diameter=DIAMETER, refine=refine), loads)
        assert last.contacts is not None
        assert len(last.contacts) == 1
        assert (len(last.shape.x) > mesh.n_v) == refine
        errors.append(abs(last.contacts.force - exact))
    assert last.is_minimum
    assert errors[1] < 0.5 * errors[0]


@pytest.mark.slow
def test_there_is_a_film_on_a_mesh_whose_own_lies_in_folds() -> None:
    """Edges of the loop are fifteen times as long as the line is thick."""
    load = 1200.0
    values = {"load": load, "diameter": DIAMETER, "twist_ratio": 0.0, "link": 0.0}
    exact = refined(touching(values))[1].force
    mesh = mesh_polygon("ellipse", aspect=2.0, vertices=200, grading=5.0)
    plain, finer = (
        [*sweep(Problem(mesh, "area", diameter=DIAMETER, refine=refine), [*WAY, load])][-1]
        for refine in (False, True)
    )
    assert plain.status is Status.FOLDED
    assert finer.is_minimum
    assert plain.contacts is not None
    assert finer.contacts is not None
    errors = [abs(film.contacts.force - exact) for film in (plain, finer)]
    assert errors[1] < 0.5 * errors[0]
