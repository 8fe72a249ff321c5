"""The same film in other units, at other places, numbered otherwise: the same answer."""

from __future__ import annotations

import logging
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from eulerplateau.mesh import read_mesh
from eulerplateau.mesh.disk import Disk
from tests.helpers.equilibria import assert_same_bits
from tests.helpers.extremes import (
    EPS,
    FIXED,
    TENSIONS,
    as_made,
    assert_same,
    cases,
    hexagon,
    oval,
)
from tests.helpers.marks import quick_with

Change = Callable[[cases.DisplacedDisk], cases.DisplacedDisk]
UNITS: dict[str, Change] = {
    "nanometres": partial(cases.scaled, factor=1e-9),
    "gigametres": partial(cases.scaled, factor=1e9),
    "inches": partial(cases.scaled, factor=1 / 0.0254),
}
MOTIONS: dict[str, Change] = {
    "rotated": cases.rotated,
    "next to the origin": partial(cases.offset, sizes=3.0),
    "rotated, moved, renumbered": lambda case: cases.renumbered(
        cases.offset(cases.rotated(case), 2.0)
    ),
}


def assert_converged_alike(
    one: cases.Outcome, two: cases.Outcome, loss: float = 0.0
) -> None:
    """The same answer, and one that is an equilibrium: all of these cases have one."""
    assert one.word == "converged"
    assert_same(one, two, loss)


@pytest.mark.parametrize("change", UNITS)
@pytest.mark.parametrize("film", FIXED)
@pytest.mark.parametrize("tension", TENSIONS)
def test_in_other_units_all_agrees_to_rounding(
    film: str, tension: float, change: str
) -> None:
    load = cases.own_load(film, tension)
    assert_converged_alike(
        as_made(oval, film, load), cases.run(UNITS[change](oval()), film, load)
    )


@pytest.mark.parametrize("make", quick_with([hexagon], [oval, hexagon]))
@pytest.mark.parametrize("change", MOTIONS)
@pytest.mark.parametrize("film", FIXED)
@pytest.mark.parametrize("tension", TENSIONS)
def test_turned_moved_and_renumbered_all_agrees_to_rounding(
    make: Callable[[], cases.DisplacedDisk], film: str, tension: float, change: str
) -> None:
    load = cases.own_load(film, tension)
    assert_converged_alike(
        as_made(make, film, load), cases.run(MOTIONS[change](make()), film, load)
    )


@pytest.mark.parametrize("seed", quick_with([2], [2, 3, 4]))
@pytest.mark.parametrize("make", [oval, hexagon])
@pytest.mark.parametrize("film", FIXED)
@pytest.mark.parametrize("tension", TENSIONS)
def test_shuffled_vertices_triangles_and_corners_all_agrees_to_rounding(
    make: Callable[[], cases.DisplacedDisk], film: str, tension: float, seed: int
) -> None:
    load = cases.own_load(film, tension)
    shuffled = cases.renumbered(make(), seed)
    assert_converged_alike(as_made(make, film, load), cases.run(shuffled, film, load))


@pytest.mark.parametrize("power", [-900, -30, 30, 900])
@pytest.mark.parametrize("film", FIXED)
def test_powers_of_two_change_not_one_bit(film: str, power: int) -> None:
    load = cases.own_load(film, 2600.0)
    one = as_made(oval, film, load)
    two = cases.run(cases.scaled(oval(), 2.0**power), film, load)
    assert one.found is not None
    assert two.found is not None
    assert one.word == "converged"
    assert_same_bits(one.found, two.found)
    assert two.measures == one.measures
    assert cases.scaled(oval(), 2.0**power).mesh.length == oval().mesh.length * 2.0**power


@pytest.mark.parametrize("sizes", [1e1, 1e2, 1e4, 1e6, 1e8])
@pytest.mark.parametrize("film", FIXED)
@pytest.mark.parametrize("tension", TENSIONS)
def test_offset_by_d_sizes_costs_at_most_100_eps_d(
    film: str, tension: float, sizes: float
) -> None:
    load = cases.own_load(film, tension)
    loss = 100 * EPS * sizes
    assert_converged_alike(
        as_made(oval, film, load),
        cases.run(cases.offset(oval(), sizes), film, load),
        loss,
    )


@pytest.mark.parametrize(("sizes", "warned"), [(0.0, 0), (100.0, 0), (1e3, 1), (1e8, 1)])
def test_offset_that_costs_more_than_the_promised_digits_is_warned_of_once(
    sizes: float, warned: int, caplog: pytest.LogCaptureFixture
) -> None:
    """100 eps D passes 1e-11 at D = 450."""
    with caplog.at_level(logging.WARNING):
        case = cases.offset(oval(), sizes)
        Disk.from_triangles(case.points, case.triangles)
    assert len(caplog.records) == warned


@pytest.mark.parametrize("film", FIXED)
@pytest.mark.parametrize("tension", TENSIONS)
def test_single_precision_input_costs_no_more_than_its_own_rounding(
    film: str, tension: float
) -> None:
    """As an offset that leaves as many digits: eps of single precision is 2^29 eps."""
    load = cases.own_load(film, tension)
    two = cases.run(cases.single(oval()), film, load)
    loss = 100 * float(np.finfo(np.float32).eps)
    assert_converged_alike(as_made(oval, film, load), two, loss)


@pytest.mark.parametrize("factor", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize("suffix", [".vtp", ".vtu", ".ply", ".stl"])
def test_files_in_single_precision_are_read_as_they_are(
    suffix: str, factor: float, tmp_path: Path
) -> None:
    import pyvista

    case = cases.single(cases.scaled(oval(), factor))
    path = tmp_path / f"film{suffix}"
    surface = pyvista.PolyData.from_regular_faces(case.points, case.triangles)
    assert surface.points.dtype == np.float32
    (surface.cast_to_unstructured_grid() if suffix == ".vtu" else surface).save(path)
    read = read_mesh(path)
    assert read.n_v == len(case.points)
    given = case.mesh
    assert read.length == pytest.approx(given.length, rel=1e-14)
    np.testing.assert_allclose(
        np.sort(read.rest_lengths), np.sort(given.rest_lengths), rtol=1e-13
    )
