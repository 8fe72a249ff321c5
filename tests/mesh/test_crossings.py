"""Self-intersections: cases made by hand, and a surface that is known to cut itself."""

from __future__ import annotations

import time

import numpy as np
import pytest

from eulerplateau.errors import MeshError
from eulerplateau.mesh.crossings import self_intersections
from tests.helpers import shapes

PAIR = np.array([[0, 1, 2], [3, 4, 5]])
FLOOR = [[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]


def count(upper: list[list[float]]) -> int:
    """Crossings of FLOOR with a second triangle, the same in any position and order."""
    x = np.array([*FLOOR, *upper], dtype=float)
    answers = {
        self_intersections(scale * x @ q.T + shift, triangles)
        for scale in (1.0, 1e-6)
        for q in (np.eye(3), shapes.rotation())
        for shift in (0.0, scale)
        for triangles in (PAIR, PAIR[::-1], PAIR[:, ::-1])
    }
    assert len(answers) == 1
    return answers.pop()


def test_triangle_through_another_is_one_crossing() -> None:
    assert count([[0.2, 0.2, -1], [0.3, 0.2, 1], [0.2, 0.3, 1]]) == 1


def test_edges_that_pierce_each_others_triangles_are_one_crossing() -> None:
    assert count([[0.2, 0.2, -1], [0.2, 0.2, 1], [3.0, 3.0, 0.1]]) == 1


@pytest.mark.parametrize(
    "upper",
    [
        pytest.param([[0.2, 0.2, 0.5], [0.3, 0.2, 1], [0.2, 0.3, 1]], id="apart"),
        pytest.param([[2.0, 2, -1], [2.3, 2, 1], [2, 2.3, 1]], id="through plane outside"),
        pytest.param([[0.2, 0.2, 0], [0.3, 0.2, 1], [0.2, 0.3, 1]], id="corner on face"),
        pytest.param([[0.2, 0.2, 0], [0.4, 0.2, 0], [0.2, 0.3, 1]], id="edge on face"),
        pytest.param([[0.0, 0, 0], [0.3, 0.2, 1], [0.2, 0.3, 1]], id="corner on corner"),
        pytest.param([[0.5, 0.5, 0], [2, 2, 1], [2, 2, -1]], id="corner on edge"),
        pytest.param([[0.5, 0.5, -1], [0.5, 0.5, 1], [2, 2, 0]], id="edge on edge"),
        pytest.param(
            [[0.1, 0.1, 0], [0.8, 0.1, 0], [0.1, 2, 0]], id="overlap in one plane"
        ),
        pytest.param(FLOOR, id="the same triangle twice"),
    ],
)
def test_contact_is_no_crossing(upper: list[list[float]]) -> None:
    assert count(upper) == 0


def test_crossing_through_an_edge_counts_both_triangles_at_that_edge() -> None:
    x = np.array(
        [
            [0.0, 0, 0],
            [1, 0, 0],
            [0.5, 1, 0],
            [0.5, -1, 0],
            [0.5, 0, -1],
            [0.5, 0, 1],
            [0.5, 3, 0],
        ]
    )
    # The blade's upright edge passes exactly through edge 0-1; the blade lies behind it.
    assert self_intersections(x, np.array([[0, 1, 2], [1, 0, 3], [4, 5, 6]])) == 1
    wider = x.copy()
    wider[[4, 5], 1] = -0.1
    assert self_intersections(wider, np.array([[0, 1, 2], [1, 0, 3], [4, 5, 6]])) == 2


def strip(n: int, loops: bool) -> tuple[np.ndarray, np.ndarray]:
    """A strip of 2 n triangles whose centre line is an alpha, crossing itself, or not."""
    s = np.linspace(-1.6, 1.6, n + 1)
    height = s**3 - s if loops else s**3 + s
    centre = np.column_stack([s**2, height])
    x = np.concatenate([np.column_stack([centre, np.full(n + 1, w)]) for w in (0.0, 0.3)])
    i = np.arange(n)
    lower = np.stack([i, i + 1, i + n + 1], axis=1)
    upper = np.stack([i + 1, i + n + 2, i + n + 1], axis=1)
    return x, np.concatenate([lower, upper])


def test_strip_folded_through_itself_crosses_and_an_open_one_does_not() -> None:
    # The alpha meets itself at s = ±1, in two quads that mirror one another: the diagonal
    # divides the common line at a height h in one and 1 - h in the other, so that three
    # of the four pairs of triangles share a piece of it.
    x, triangles = strip(31, loops=True)
    assert self_intersections(x, triangles) == 3
    x, triangles = strip(31, loops=False)
    assert self_intersections(x, triangles) == 0


@pytest.mark.parametrize(("radius", "crosses"), [(1.6, False), (1.9, True)])
def test_enneper_surface_cuts_itself_beyond_radius_root_three(
    radius: float, crosses: bool
) -> None:
    points, triangles = shapes.disk_points(24, 0.2)
    assert (self_intersections(shapes.enneper(points, radius), triangles) > 0) is crosses


def test_flat_film_with_rounding_noise_has_none_even_folded_onto_itself() -> None:
    points, triangles = shapes.disk_points(12, 0.2)
    x = shapes.flat(points) / 6.3
    noise = 1e-16 * np.random.default_rng(1).standard_normal(len(x))
    x[:, 2] += noise
    assert self_intersections(x, triangles) == 0
    folded = shapes.flat(points) / 6.3
    folded[:, 0] = np.abs(folded[:, 0])
    folded[:, 2] += noise
    assert self_intersections(folded, triangles) == 0
    assert self_intersections(folded @ shapes.rotation().T, triangles) == 0


def test_number_does_not_change_under_rigid_motion_scaling_and_renumbering() -> None:
    points, triangles = shapes.disk_points(16, 0.2)
    x = shapes.enneper(points, 2.1)
    expected = self_intersections(x, triangles)
    assert expected > 0
    assert self_intersections(1e5 * x @ shapes.rotation().T + 3.0, triangles) == expected
    rng = np.random.default_rng(2)
    new = rng.permutation(len(x))
    renumbered = np.empty_like(x)
    renumbered[new] = x
    shuffled = new[triangles][rng.permutation(len(triangles))]
    assert self_intersections(renumbered, shuffled) == expected


def test_sweep_agrees_with_testing_every_pair() -> None:
    rng = np.random.default_rng(4)
    x = rng.uniform(size=(120, 3))
    triangles = np.arange(120).reshape(-1, 3)
    pairs = sum(
        self_intersections(x, triangles[[i, j]])
        for i in range(len(triangles))
        for j in range(i)
    )
    assert self_intersections(x, triangles) == pairs > 0


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_number_that_is_not_finite_is_refused_and_its_vertex_named(bad: float) -> None:
    x = np.array([*FLOOR, *FLOOR])
    x[4, 1] = bad
    with pytest.raises(MeshError) as caught:
        self_intersections(x, PAIR)
    assert (caught.value.kind, caught.value.index) == ("vertex", 4)


@pytest.mark.slow
def test_two_hundred_thousand_vertices_take_at_most_three_seconds() -> None:
    self_intersections(np.array([*FLOOR, *FLOOR]), PAIR)
    points, triangles = shapes.disk_points(258, 0.2)
    x = shapes.eight(points, 0.9)
    start = time.perf_counter()
    assert self_intersections(x, triangles) == 0
    assert time.perf_counter() - start <= 3.0
