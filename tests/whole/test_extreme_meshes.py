"""Bad meshes: slivers, needles, stretched and tiny polygons, loop edges of all lengths."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.errors import MeshError
from eulerplateau.solvers import Equilibrium, Problem, Status, solve
from tests.helpers.extremes import FIXED, TENSIONS, assert_same, cases, hexagon, oval
from tests.helpers.marks import quick_with

RATIOS = (1e-2, 1e-4, 1e-8)


def found(
    case: cases.DisplacedDisk, film: str, load: float, solver: str = "newton"
) -> Equilibrium:
    result = cases.run(case, film, load, solver).found
    assert result is not None
    return result


@pytest.mark.parametrize("factor", quick_with([5.0, 50.0], [5.0, 20.0, 50.0]))
@pytest.mark.parametrize("film", FIXED)
@pytest.mark.parametrize("tension", TENSIONS)
def test_stretched_polygon_and_its_turned_renumbered_twin_agree_or_both_are_refused(
    film: str, tension: float, factor: float
) -> None:
    load = cases.own_load(film, tension)
    case = cases.stretched(hexagon(), factor)
    one = cases.run(case, film, load)
    two = cases.run(cases.renumbered(cases.rotated(case)), film, load)
    words = {one.word, two.word}
    if film == "springs" and tension < 5000:
        assert words == {"converged"}
    on_a_line = all(o.measures and o.measures["max_turning"] > 170 for o in (one, two))
    if words == {"unresolved"} and on_a_line:
        # Which vertices turn back there is left open, and eigenvalues with them.
        assert one.found is not None
        assert two.found is not None
        assert two.found.energy == pytest.approx(one.found.energy, rel=1e-9)
    elif words <= {"converged", "unresolved"}:
        assert_same(one, two)
        assert len(words) == 1
    else:
        # A loop that has folded flat onto a line ends at a saddle or in a minimum that its
        # mesh cannot carry, as rounding will have it; but is not said to have converged.
        assert "converged" not in words


@pytest.mark.parametrize("sides", [3, 4, 5, 6])
@pytest.mark.parametrize("film", FIXED)
@pytest.mark.parametrize("tension", [0.0, 1.0, 3000.0])
def test_loop_of_three_to_six_vertices_is_in_balance_and_unresolved(
    film: str, tension: float, sides: int
) -> None:
    result = found(cases.polygon(sides), film, cases.own_load(film, tension))
    assert result.status is Status.UNRESOLVED
    assert result.residual < 1e-12
    assert result.n_unstable == 0


@pytest.mark.parametrize("sides", [3, 4, 5, 6])
def test_bare_loop_of_three_to_six_vertices_has_the_regular_polygons_energy(
    sides: int,
) -> None:
    """n turns of 2 sin(pi / n) in the unit vectors, on edges of 1 / n."""
    result = found(cases.polygon(sides), "springs", 0.0)
    exact = 4 * sides**2 * np.sin(np.pi / sides) ** 2
    assert result.energy == pytest.approx(exact, rel=1e-13)


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize("tension", TENSIONS)
def test_springs_do_not_feel_a_needle_by_one_bit(tension: float, ratio: float) -> None:
    """Their energy has no rest shape but the loop's."""
    load = cases.own_load("springs", tension)
    plain = found(oval(), "springs", load)
    pricked = found(cases.needle(oval(), ratio), "springs", load)
    assert pricked.energy == plain.energy
    np.testing.assert_array_equal(pricked.shape.x, plain.shape.x)


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize("tension", TENSIONS)
def test_dirichlet_film_with_a_sliver_has_the_energy_of_the_film_without_it(
    tension: float, ratio: float
) -> None:
    """Up to the sliver's own share, no more than its width over its length."""
    plain = found(oval(), "dirichlet", tension)
    split = found(cases.sliver(oval(), ratio), "dirichlet", tension)
    assert split.status is plain.status is Status.CONVERGED
    assert split.energy == pytest.approx(plain.energy, rel=ratio)
    assert split.iterations <= 3 * plain.iterations


@pytest.mark.parametrize("make", [cases.needle, cases.sliver])
@pytest.mark.parametrize("film", FIXED)
@pytest.mark.parametrize("tension", TENSIONS)
def test_sliver_of_1e8_is_solved_to_the_digits_that_its_width_leaves(
    film: str, tension: float, make: cases.Spoiler
) -> None:
    """Its corners are known to eps of L, so its width of 1e-8 edges to some 1e-7 of it."""
    load = cases.own_load(film, tension)
    case = make(oval(), 1e-8)
    one = cases.run(case, film, load)
    assert one.word == "converged"
    twin = cases.run(cases.renumbered(cases.rotated(case)), film, load)
    assert_same(one, twin, loss=1e-7)


@pytest.mark.parametrize("film", FIXED)
@pytest.mark.parametrize("tension", TENSIONS)
def test_shorter_and_shorter_loop_edge_converges_at_first_order(
    film: str, tension: float
) -> None:
    """To the loop in which it is a point."""
    load = cases.own_load(film, tension)
    energies = []
    for ratio in (1e-1, 1e-2, 1e-3):
        result = found(cases.short_edge(oval(), ratio), film, load)
        assert result.status is Status.CONVERGED
        energies.append(result.energy)
    far, near = np.diff(energies)
    assert np.log10(far / near) == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize("ratio", [1e-1, 1e-2, 1e-3])
@pytest.mark.parametrize("film", FIXED)
@pytest.mark.parametrize("tension", TENSIONS)
def test_short_loop_edge_leaves_the_energy_its_digits(
    film: str, tension: float, ratio: float
) -> None:
    load = cases.own_load(film, tension)
    case = cases.short_edge(oval(), ratio)
    one, twin = (
        found(given, film, load) for given in (case, cases.renumbered(cases.rotated(case)))
    )
    assert one.status is twin.status is Status.CONVERGED
    assert one.energy == pytest.approx(twin.energy, rel=1e-11)


@pytest.mark.parametrize(("ratio", "rings"), [(0.5, 4), (1e-2, 3), (1e-3, 3)])
def test_cg_with_a_short_loop_edge_is_right_or_not_called_converged(
    ratio: float, rings: int
) -> None:
    """Right where the edge is half as long as the others."""
    case = cases.short_edge(oval(rings), ratio)
    problem, start = Problem(case.mesh), case.mesh.x + case.displacement
    result = solve(problem, 300.0, start, solver="cg", max_iterations=5000)
    assert result.status is not Status.NOT_FINITE
    assert result.status is Status.CONVERGED or ratio < 0.5
    if result.status is Status.CONVERGED:
        reference = found(case, "springs", 300.0)
        assert result.energy == pytest.approx(reference.energy, rel=1e-6)


@pytest.mark.parametrize("ratio", [1e-4, 1e-5, 1e-6, 1e-7])
def test_loop_edge_ten_thousand_times_shorter_and_more_is_refused_by_its_ends(
    ratio: float,
) -> None:
    case = cases.short_edge(oval(), ratio)
    ends = set(oval().mesh.loop[2:4].tolist())
    with pytest.raises(MeshError) as caught:
        _ = case.mesh
    assert caught.value.kind == "edge"
    assert isinstance(caught.value.index, tuple)
    assert set(caught.value.index) == ends
