"""Adhesion sites: regular ones, files of them, and every way a file can be wrong."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from eulerplateau.cells import Sites, read_sites, regular_sites
from eulerplateau.errors import SpecError


def read(folder: Path, text: str) -> Sites:
    path = folder / "sites.csv"
    path.write_text(text)
    return read_sites(path)


@pytest.mark.parametrize("n", [2, 3, 7])
def test_regular_sites_lie_on_the_unit_circle_counter_clockwise(n: int) -> None:
    z = regular_sites(n).points @ np.array([1, 1j])
    np.testing.assert_allclose(z, np.exp(2j * np.pi * np.arange(n) / n), atol=1e-15)
    assert (regular_sites(n).weights == 1).all()


@pytest.mark.parametrize("header", ["", "x,y\n", "x, y \n\n", "# µm\nx,y # no\n"])
def test_points_are_read_with_or_without_a_header(tmp_path: Path, header: str) -> None:
    sites = read(tmp_path, header + "0,0\n 2,0\n1,1.5\n\n")
    np.testing.assert_array_equal(sites.points, [[0, 0], [2, 0], [1, 1.5]])
    assert (sites.weights == 1).all()


def test_clockwise_points_are_reversed_with_their_stiffness(tmp_path: Path) -> None:
    sites = read(tmp_path, "x,y,stiffness\n0,0,1\n1,1.5,2\n2,0,3\n")
    np.testing.assert_array_equal(sites.points, [[2, 0], [1, 1.5], [0, 0]])
    np.testing.assert_array_equal(sites.weights, [3, 2, 1])


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", "has 0 points; should be 2 or more"),
        ("x,y\n1,2\n", "has 1 points; should be 2 or more"),
        ("x,y\n1,2\n3,a\n", "line 3: found 'a'; should be a number"),
        ("1,2\n3,\n", "line 2: found ''; should be a number"),
        ("1,2\n3,inf\n", "line 2: is not finite; should be numbers"),
        ("1,2\n3\n", "line 2: has 1 fields; should be 2 .* or 3"),
        ("1,2\n3,4,1\n", "line 2: has 3 fields; should be 2 .* or 3"),
        ("1,2,1\n3,4,0\n", "line 2: stiffness 0 should be positive"),
        ("1,2\n3,4\n3,4\n0,0\n", "line 3: is the same point as line 2: leave one out"),
        ("x,y\n1,2\n3,4\n1,2\n", "line 2: is the same point as line 4: leave one out"),
        ("0,0\n1,1\n1,0\n0,1\n", "crosses itself: give them in order"),
        ("0,0\n2,0\n1,0\n", "line 1|2: the polygon turns back on itself"),
    ],
)
def test_a_wrong_file_is_one_line_that_names_culprit_and_cure(
    tmp_path: Path, text: str, problem: str
) -> None:
    with pytest.raises(SpecError, match=problem) as caught:
        read(tmp_path, text)
    assert str(tmp_path / "sites.csv") in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_file_that_is_none_is_one_line_too(tmp_path: Path) -> None:
    with pytest.raises(SpecError, match="cannot be read"):
        read_sites(tmp_path / "none.csv")
    (tmp_path / "sites.csv").write_bytes(b"\xff\xfe\x00\x01")
    with pytest.raises(SpecError, match="is no text"):
        read_sites(tmp_path / "sites.csv")


def test_one_point_is_no_polygon() -> None:
    with pytest.raises(SpecError, match="2 or more"):
        regular_sites(1)
