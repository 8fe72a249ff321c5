"""Vector films: what is nearer hides what is farther, also where a film crosses itself."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.mesh import Shape
from eulerplateau.pictures.figure import new_figure
from eulerplateau.pictures.layers import cut_where_crossing, layers, overlaps
from eulerplateau.pictures.vector_film import draw_film
from tests.helpers.shapes import disk_points, mesh_of

EYE = np.array([0.0, -1e-3, 1.0]) / np.hypot(1.0, 1e-3)


def crossing_sheets(tilt: float) -> tuple[FloatArray, IntArray]:
    """Two square sheets, z = tilt x and z = -tilt x, which cross at x = 0.

    Their meshes have no line there, and each shows another side to a viewer above.
    """
    n = 8
    grid = np.linspace(-1.0, 1.0, n)
    x, y = np.meshgrid(grid, grid, indexing="ij")
    x = x + 0.4 * (grid[1] - grid[0]) * np.sin(3.0 * y)
    corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    a, b, c, d = corner, corner + n, corner + n + 1, corner + 1
    sheet = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    flat = np.stack([x.ravel(), y.ravel()], axis=1)
    up, down = (np.column_stack([flat, way * tilt * flat[:, 0]]) for way in (1, -1))
    return np.concatenate([up, down]), np.concatenate([sheet, sheet[:, ::-1] + n * n])


def area(corners: FloatArray) -> float:
    a, b, c = corners.transpose(1, 0, 2)
    return float(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())


@pytest.mark.parametrize("tilt", [0.1, 1.0])
def test_what_is_painted_last_is_the_upper_sheet_up_to_the_line(tilt: float) -> None:
    """To the right of x = 0 the rising sheet, to the left the other."""
    x, triangles = crossing_sheets(tilt)
    corners, parents = cut_where_crossing(x, triangles)
    assert area(corners) == pytest.approx(area(x[triangles]), rel=1e-12)
    layer = layers(overlaps(corners), corners[..., 2].mean(axis=1))
    rising = parents < len(triangles) // 2
    places = np.random.default_rng(1).uniform(-0.7, 0.7, (400, 2))
    for place in places[np.abs(places[:, 0]) > 1e-6]:
        inside = contain(corners, place)
        assert inside.sum() == 2
        (top,) = np.flatnonzero(inside & (layer == layer[inside].max()))
        assert rising[top] == (place[0] > 0)


def contain(corners: FloatArray, place: FloatArray) -> np.ndarray:
    """Whether triangles (n, 3, 3) contain a point in the picture."""
    edge = np.roll(corners, -1, axis=1)[..., :2] - corners[..., :2]
    to = place - corners[..., :2]
    side = edge[..., 0] * to[..., 1] - edge[..., 1] * to[..., 0]
    return np.asarray((side > 0).all(axis=1) | (side < 0).all(axis=1))


def test_a_ring_of_three_that_hide_each_other_is_painted_by_depth() -> None:
    ring = np.array([[0, 1], [1, 2], [2, 0], [2, 3]])
    layer = layers(ring, np.array([0.2, 0.1, 0.3, -1.0]))
    assert list(np.argsort(layer)) == [1, 0, 2, 3]


def test_the_seam_is_straight_in_the_picture(tmp_path: Path) -> None:
    """A disk folded along no edge of its mesh: two sheets that cross at x = 0."""
    from PIL import Image

    x, triangles = crossing_sheets(0.5)
    loop = np.array([0, 7, 63, 56])  # the corners of one sheet
    figure = new_figure(2.0, 2.0)
    figure.set_layout_engine(None)
    ax = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    draw_film(ax, Shape(x, triangles, loop), EYE, (1.0, 1.0))
    figure.savefig(tmp_path / "film.png", dpi=200)
    image = np.asarray(Image.open(tmp_path / "film.png").convert("RGB")).astype(int)
    blue = image[60:-60, :, 2] > image[60:-60, :, 0]
    rising_is_right = blue[:, 220:340].all() and not blue[:, 60:180].any()
    assert rising_is_right
    seam = [np.flatnonzero(row[100:300])[0] + 100 for row in blue]
    assert max(seam) - min(seam) <= 1
    assert abs(np.mean(seam) - 200) <= 1


def ink(path: Path, radius: float) -> tuple[int, int]:
    """Pixels across and up of a disk of radius 0.16, in a field of 400 for 0.4."""
    from PIL import Image

    disk = mesh_of(*disk_points(12))
    figure = new_figure(2.0, 2.0)
    figure.set_layout_engine(None)
    ax = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    shape = Shape(0.16 * disk.x / np.hypot(*disk.x.T[:2]).max(), disk.triangles, disk.loop)
    draw_film(ax, shape, EYE, (0.2, 0.2), radius)
    figure.savefig(path, dpi=200)
    dark = np.asarray(Image.open(path).convert("L")) < 200
    return int(dark.any(axis=0).sum()), int(dark.any(axis=1).sum())


def test_a_flat_disk_is_round_to_a_pixel(tmp_path: Path) -> None:
    across, up = ink(tmp_path / "disk.png", 0.0)
    assert abs(across - up) <= 1


def test_a_thick_wire_is_drawn_as_thick_as_it_is(tmp_path: Path) -> None:
    across, up = ink(tmp_path / "thick.png", 0.03)
    assert abs(across - 1000 * 2 * (0.16 + 0.03)) <= 2
    assert abs(up - across) <= 1
