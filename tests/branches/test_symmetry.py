"""Symmetries of loops and modes: known parities, however the loop lies and is numbered."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.symmetry import OPERATIONS, ROUND, loop_distance, mode_symmetry
from tests.helpers.shapes import rotation

N = 64
ALL = set(OPERATIONS)
MIRRORS = {name for name in ALL if name.startswith("mirror")}
TURNS = {name for name in ALL if name.startswith("half turn")}
ACROSS_Z = "mirror across short axis"
ABOUT_Z = "half turn about short axis"


def ellipse() -> FloatArray:
    """Semi-axes 0.2 along x and 0.1 along y, in the plane z = 0."""
    angle = 2 * np.pi * np.arange(N) / N
    return np.stack([0.2 * np.cos(angle), 0.1 * np.sin(angle), 0 * angle], axis=1)


def modes() -> dict[str, tuple[FloatArray, set[str]]]:
    """Displacements of the ellipse and the operations that keep them."""
    x, y, _ = ellipse().T
    o = np.zeros(N)
    columns = np.column_stack
    return {
        "stretch": (columns([x, -y, o]), ALL),
        "shear": (columns([y, x, o]), {ABOUT_Z, ACROSS_Z, "inversion"}),
        "twist": (columns([o, o, x * y]), TURNS),
        "bend": (columns([o, o, x * x]), (MIRRORS | {ABOUT_Z}) - {ACROSS_Z}),
        "tilt": (
            columns([o, o, x**3]),
            {"mirror across middle axis", "half turn about middle axis", "inversion"},
        ),
        "shift": (
            columns([x * x, o, o]),
            {"mirror across middle axis", ACROSS_Z, "half turn about long axis"},
        ),
    }


@pytest.mark.parametrize("name", modes())
@pytest.mark.parametrize("moved", [False, True])
def test_parities_of_an_ellipses_modes(name: str, moved: bool) -> None:
    """All seven operations belong to the ellipse, and each mode is even or odd."""
    loop, (mode, kept) = ellipse(), modes()[name]
    if moved:
        turn = rotation()
        loop, mode = (np.roll(a @ turn, 5, axis=0)[::-1] for a in (loop, mode))
        loop = loop + 3.0
    symmetry = mode_symmetry(loop, mode)
    assert set(symmetry.keeps) == kept
    assert set(symmetry.breaks) == ALL - kept


@pytest.mark.parametrize("n", [2, 3, 4, 5])
@pytest.mark.parametrize("raised", [False, True])
def test_a_disk_has_no_long_axis_to_tell_of(n: int, raised: bool) -> None:
    """Its mode cos n theta, in the plane or out of it, however the circle is turned."""
    angle = 2 * np.pi * np.arange(N) / N
    o, wave = np.zeros(N), np.cos(n * angle + 0.3)
    circle = np.column_stack([np.cos(angle), np.sin(angle), o]) / (2 * np.pi)
    mode = np.column_stack([o, o, wave]) if raised else wave[:, None] * circle
    turn = rotation()
    found = mode_symmetry(circle @ turn, mode @ turn)
    even = n % 2 == 0
    kept = {ACROSS_Z: not raised, ABOUT_Z: even, "inversion": even != raised}
    assert set(found.keeps) == {name for name, keeps in kept.items() if keeps}
    assert set(found.breaks) == {ROUND} | {
        name for name, keeps in kept.items() if not keeps
    }


def test_what_is_said_of_a_saddle_depends_on_no_choice_of_axes() -> None:
    """Of Enneper's, two of whose extents are equal: axes along it, or between."""
    angle = 2 * np.pi * np.arange(N) / N
    for phase in (0.0, 0.4, np.pi / 4):
        wave = 0.05 * np.cos(2 * (angle - phase))
        saddle = np.column_stack([np.cos(angle), np.sin(angle), wave]) / (2 * np.pi)
        mode = np.column_stack([0 * angle, 0 * angle, np.sin(2 * (angle - phase))])
        assert named(saddle, mode) == {ABOUT_Z}


@pytest.mark.parametrize(
    ("name", "part"), [("stretch", 0.0), ("shear", 0.0), ("twist", 1.0), ("bend", 1.0)]
)
def test_transverse_part_is_that_out_of_the_plane(name: str, part: float) -> None:
    mode = modes()[name][0]
    assert mode_symmetry(ellipse(), mode).transverse == pytest.approx(part, abs=1e-12)
    half = mode / np.linalg.norm(mode)
    other = modes()["twist" if part == 0.0 else "shear"][0]
    half = half + other / np.linalg.norm(other)
    assert mode_symmetry(ellipse(), half).transverse == pytest.approx(0.5)


def test_operations_a_loop_lacks_are_neither_kept_nor_broken() -> None:
    """A twisted ellipse has its half turns only, an egg the mirrors along it."""
    x, y, _ = ellipse().T
    mode = np.column_stack([x, -y, 0 * x])
    twisted = ellipse() + np.column_stack([0 * x, 0 * x, 8.0 * x * y])
    assert named(twisted, mode) == TURNS
    egg = ellipse() + np.column_stack([2.0 * y * y, 0 * x, 0 * x])
    assert named(egg, mode) == {
        "mirror across middle axis", ACROSS_Z, "half turn about long axis"
    }  # fmt: skip


def named(loop: FloatArray, mode: FloatArray) -> set[str]:
    symmetry = mode_symmetry(loop, mode)
    return {*symmetry.keeps, *symmetry.breaks}


def test_distance_ignores_rigid_motions_but_not_mirrors() -> None:
    x, y, _ = ellipse().T
    chiral = ellipse() + np.column_stack([0 * x, 0 * x, 8.0 * x * y])
    assert loop_distance(chiral, chiral @ rotation() + 1.0) < 1e-12
    image = chiral * [1.0, 1.0, -1.0]
    assert loop_distance(chiral, image) > 0.01
    # A half turn about an axis in its plane takes a planar loop to its mirror image.
    assert loop_distance(ellipse(), ellipse() * [1.0, -1.0, 1.0]) < 1e-12
    assert loop_distance(ellipse(), 1.1 * ellipse()) == pytest.approx(
        0.1 * np.sqrt(np.mean(np.sum(ellipse() ** 2, axis=1)))
    )


def test_a_loop_in_the_plane_is_flat_in_space() -> None:
    x = ellipse()[:, :2]
    for name in ("stretch", "shear"):
        mode, keeps = modes()[name]
        assert set(mode_symmetry(x, mode[:, :2]).keeps) == keeps
        assert mode_symmetry(x, mode[:, :2]).transverse == 0


def test_loops_in_the_plane_are_compared_up_to_a_rotation_but_no_mirror() -> None:
    rng = np.random.default_rng(2)
    x = ellipse()[:, :2] * (1 + 0.2 * rng.uniform(-1, 1, (N, 1)))
    turn = np.array([[0.6, 0.8], [-0.8, 0.6]])
    assert loop_distance(x, x @ turn + [1.0, 2.0]) < 1e-12
    assert loop_distance(x, x * [1.0, -1.0]) > 1e-3
