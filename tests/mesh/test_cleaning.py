"""Triangles made into a disk: each step keeps what its law says, and is done once."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

from eulerplateau.errors import MeshError
from eulerplateau.mesh import read_mesh
from eulerplateau.mesh.cleaning import merged, oriented, split
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.mending import as_disk
from eulerplateau.mesh.triangles import area_vectors, directed_edges
from tests.helpers.disk_files import POINTS, TRIANGLES
from tests.mesh.test_variants import KNOWN, assert_same

FAST = settings(deadline=None, max_examples=25, derandomize=True, database=None)
SEEDS = given(st.integers(0, 2**32 - 1))


def area(points: np.ndarray, triangles: np.ndarray) -> float:
    return float(np.linalg.norm(area_vectors(triangles, points), axis=1).sum())


def moebius(n: int = 12) -> tuple[np.ndarray, np.ndarray]:
    """A strip of 2 n triangles whose ends are joined with a half turn."""
    turn = np.linspace(0, 2 * np.pi, n, endpoint=False)
    pole = np.column_stack([np.cos(turn), np.sin(turn), 0 * turn])
    across = 0.3 * np.column_stack(
        [np.cos(turn / 2) * pole[:, 0], np.cos(turn / 2) * pole[:, 1], np.sin(turn / 2)]
    )
    left, right = np.arange(n), n + np.arange(n)
    after = np.append(left[1:], n), np.append(right[1:], 0)
    triangles = [
        np.stack(t, 1) for t in ((left, right, after[0]), (right, after[1], after[0]))
    ]
    return np.vstack([pole - across, pole + across]), np.concatenate(triangles)


@pytest.mark.slow
@FAST
@SEEDS
def test_turned_triangles_agree_again_and_the_fewer_are_turned(seed):
    draw = np.random.default_rng(seed)
    wrong = np.zeros(len(TRIANGLES), dtype=bool)
    wrong[draw.permutation(len(TRIANGLES))[: draw.integers(0, len(TRIANGLES) // 2)]] = True
    given_ = np.where(wrong[:, None], TRIANGLES[:, ::-1], TRIANGLES)
    found, turned = oriented(given_)
    assert (turned == wrong).all()
    assert (found == TRIANGLES).all()
    half = directed_edges(found)
    assert len(np.unique(half, axis=0)) == len(half)
    again, none = oriented(found)
    assert (again == found).all()
    assert not none.any()


@pytest.mark.parametrize("first", [0, 1])
def test_of_as_many_triangles_those_are_turned_that_disagree_with_the_first(first):
    """So that nothing else decides which side of a film is its front."""
    strip = np.array([[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5]])
    wrong = np.arange(4) % 2 == first
    found, turned = oriented(np.where(wrong[:, None], strip[:, ::-1], strip))
    assert (turned == (np.arange(4) % 2 == 1)).all()
    assert (found == (strip if first else strip[:, ::-1])).all()


def test_a_moebius_strip_is_refused_and_an_untwisted_one_is_no_disk():
    points, triangles = moebius()
    with pytest.raises(MeshError, match="only one side"):
        as_disk(points, triangles, "file")
    straight = np.where(triangles == 12, 0, triangles)
    with pytest.raises(MeshError):
        as_disk(points, straight, "file")


@FAST
@SEEDS
def test_any_numbering_direction_and_copies_of_vertices_are_the_same_disk(seed):
    draw = np.random.default_rng(seed)
    # Up to all corners have a vertex of their own, and some are wound the other way.
    triangles = TRIANGLES.copy()
    points = POINTS
    for corner in draw.permutation(triangles.size)[: draw.integers(0, triangles.size)]:
        points = np.vstack([points, points[triangles.flat[corner]]])
        triangles.flat[corner] = len(points) - 1
    wrong = draw.random(len(triangles)) < 0.3
    triangles = np.where(wrong[:, None], triangles[:, ::-1], triangles)
    triangles = np.roll(triangles, draw.integers(3), axis=1)[
        draw.permutation(len(triangles))
    ]
    number = draw.permutation(len(points))
    placed = np.empty_like(points)
    placed[number] = points
    joined, _ = merged(placed, number[triangles])
    assert len(np.unique(joined)) == len(POINTS)
    assert area(placed, joined) == pytest.approx(area(POINTS, TRIANGLES), rel=1e-14)
    again, _ = merged(placed, joined)
    assert (again == joined).all()
    # A slit from the loop inwards is a disk too, so that only soups come back surely.
    soup = np.arange(triangles.size).reshape(-1, 3)
    assert_same(as_disk(placed[number[triangles].ravel()], soup, "file")[0], digits=1e-14)


def test_vertices_that_coincide_nearly_are_merged_with_a_line_and_no_farther():
    noise = np.random.default_rng(1).standard_normal((TRIANGLES.size, 3))
    soup = np.arange(TRIANGLES.size).reshape(-1, 3)
    places = POINTS[TRIANGLES.ravel()]
    found, lines = as_disk(places + 1e-7 * noise / 3, soup, "file")
    assert_same(found, KNOWN, digits=1e-7)
    assert any("within 1e-06 of the size" in line for line in lines)
    with pytest.raises(MeshError, match="pieces"):
        as_disk(places + 1e-4 * noise, soup, "file")


@pytest.mark.parametrize("power", [-900, 0, 900])
def test_near_vertices_are_merged_in_any_unit_whatever_else_lies_about(power):
    """Squares of such distances overflow; a vertex that no triangle uses may be nowhere."""
    soup = np.arange(TRIANGLES.size).reshape(-1, 3)
    places = POINTS[TRIANGLES.ravel()]
    near = places + 1e-8 * np.random.default_rng(1).standard_normal(places.shape)
    given = np.vstack([np.ldexp(near, power), np.full(3, np.nan)])
    found, lines = as_disk(given, soup, "file")
    assert_same(found, replace(KNOWN, length=np.ldexp(KNOWN.length, power)), digits=1e-7)
    assert len(lines) == 1


def crossing_eight() -> tuple[np.ndarray, np.ndarray]:
    """Squares of a plane one after the other, the last of which meets the first again.

    A ribbon right, up, left and down across itself: square 12 lies on square 1.
    """
    path = [(x, 0) for x in range(5)] + [
        (4, 1),
        (4, 2),
        (3, 2),
        (2, 2),
        (2, 1),
        (2, 0),
        (2, -1),
    ]
    points, squares = [], []
    # Every square brings its corners; what it shares with the one before is found by place.
    before: dict[tuple[int, int], int] = {}
    for x, y in path:
        here = {}
        for place in ((x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)):
            if place in before:
                here[place] = before[place]
            else:
                here[place] = len(points)
                points.append((*map(float, place), 0.0))
        squares.append([*here.values()])
        before = here
    quads = np.array(squares)
    triangles = quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    return np.array(points), triangles


def test_a_flat_ribbon_that_crosses_itself_is_not_merged_where_it_does():
    points, triangles = crossing_eight()
    assert len(np.unique(points, axis=0)) < len(points)
    found, lines = as_disk(points, triangles, "file")
    assert (found.n_v, lines) == (len(points), [])


def test_a_soup_that_touches_itself_in_a_point_stays_apart_there():
    """A fan of nearly a whole turn, whose ends touch in a point beside the middle."""
    turn = np.linspace(0, 2 * np.pi, 9)
    inner, outer = np.column_stack([np.cos(turn), np.sin(turn)]), None
    outer = 2 * inner
    outer[0], outer[-1] = (2.0, 0.3), (2.0, -0.3)
    inner[-1] = (0.99, -0.1)
    points = np.column_stack([np.vstack([inner, outer]), np.zeros(18)])
    points[8 + 9] = points[9] = (2.0, 0.0, 0.0)
    i = np.arange(8)
    triangles = np.concatenate(
        [np.stack([i, 9 + i, i + 1], 1), np.stack([9 + i, 10 + i, i + 1], 1)]
    )
    soup = np.arange(triangles.size).reshape(-1, 3)
    found, _ = as_disk(points[triangles.ravel()], soup, "file", soup=True)
    assert found.n_v == 18


def test_a_triangle_without_a_side_is_lost_in_merging_with_a_line():
    points = np.vstack([POINTS, POINTS[TRIANGLES[0, 1]]])
    n = len(POINTS)
    a, b, c = TRIANGLES[0]
    split_ = np.vstack([TRIANGLES[1:], [[a, n, c], [a, b, n], [b, c, n]]])
    found, lines = as_disk(points, split_, "file")
    assert_same(found)
    assert any("without an area" in line for line in lines)


@FAST
@SEEDS
def test_splitting_keeps_the_area_of_plane_polygons(seed):
    draw = np.random.default_rng(seed)
    n = int(draw.integers(4, 14))
    turn = np.sort(draw.uniform(0, 2 * np.pi, n))
    if (np.diff(turn, append=turn[0] + 2 * np.pi) >= np.pi).any():
        return  # the middle is not inside
    radius = draw.uniform(0.3, 1.0, n)
    plane = np.column_stack([radius * np.cos(turn), radius * np.sin(turn)])
    after = np.roll(plane, -1, axis=0)
    true = 0.5 * abs((plane[:, 0] * after[:, 1] - plane[:, 1] * after[:, 0]).sum())
    points = plane @ np.linalg.qr(draw.standard_normal((3, 3)))[0][:2]
    triangles, owner = split(points, np.arange(n), np.array([n]))
    assert len(triangles) == n - 2
    assert (owner == 0).all()
    assert area(points, triangles) == pytest.approx(true, rel=1e-12)
    again, _ = split(points, triangles.ravel(), np.full(n - 2, 3))
    assert (again == triangles).all()


QUADS = {
    "longer than high": ([[0, 0], [4, 0], [5, 1], [1, 1]], (1, 3)),
    "leaning left": ([[1, 0], [5, 0], [4, 1], [0, 1]], (0, 2)),
    # Its shorter diagonal, 0 2, lies outside.
    "dart": ([[-1, 0], [0, 0.5], [1, 0], [0, 3]], (1, 3)),
}


@pytest.mark.parametrize("name", QUADS)
def test_the_shorter_diagonal_inside_is_taken(name):
    corners, diagonal = QUADS[name]
    points = np.column_stack([np.array(corners, dtype=float), np.zeros(4)])
    triangles, _ = split(points, np.arange(4), np.array([4]))
    assert all(set(diagonal) < {*t} for t in triangles.tolist())


def test_a_corner_in_the_middle_of_a_side_makes_no_flat_triangle():
    plane = [[0, 0], [1, 0], [2, 0], [3, 0], [1.5, 40]]
    points = np.column_stack([np.array(plane, dtype=float), np.zeros(5)])
    triangles, _ = split(points, np.arange(5), np.array([5]))
    assert np.linalg.norm(area_vectors(triangles, points), axis=1).min() > 1


def test_what_a_file_needs_is_said_once_each(tmp_path, caplog):
    path = tmp_path / "film.off"
    square = "0 0 0\n2 0 0\n2 1 0\n0 1 0\n1 .4 0\n9 9 9\n"
    path.write_text(f"OFF\n6 4 0\n{square}3 0 1 4\n3 2 1 4\n3 2 3 4\n3 3 0 4\n")
    found = read_mesh(path)
    assert found.n_v == 5
    assert [said.partition(": ")[2] for said in caplog.messages] == [
        "1 vertex that no triangle uses is left out",
        "1 of 4 triangles is turned over to agree with the others",
    ]


def test_a_disk_is_taken_as_it_is():
    found, lines = as_disk(POINTS, TRIANGLES, "file")
    known = Disk.from_triangles(POINTS, TRIANGLES)
    assert lines == []
    assert found.digest == known.digest
