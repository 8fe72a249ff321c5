"""From what is kept of an exploration it goes on as it would have, to the bit."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from eulerplateau.branches import Arrays, FilmFamily, StepControl, explore
from eulerplateau.branches.progress import KeptPoint, Lead, Progress, progress_from
from eulerplateau.cells import Cell, explore_cell, regular_sites
from eulerplateau.mesh import Shape, read_disk
from eulerplateau.solvers import Problem
from tests.helpers.diagram import stable_point
from tests.helpers.shapes import hexagon_points, mesh_of

ROOT = Path(__file__).parents[2]


def from_file(arrays: Arrays) -> Arrays:
    file = io.BytesIO()
    np.savez(file, **arrays)
    file.seek(0)
    with np.load(file, allow_pickle=False) as stored:
        return dict(stored)


def told(point: Any) -> tuple[object, ...]:
    """Return all that a row and its shape say of a point."""
    found = point.equilibrium
    x = found.shape.x if isinstance(getattr(found, "shape", None), Shape) else found.x
    mode = None if point.special is None else point.special.mode.tobytes()
    bits = x.tobytes(), found.stability.eigenvalues.tobytes(), mode
    numbers = found.energy, found.residual, point.point.value, point.point.arclength
    return point.branch, point.origin, point.number, point.known, *numbers, *bits


def springs() -> Callable[..., Iterator[Any]]:
    problem = Problem(read_disk(ROOT / "meshes" / "elongated.vtp"))
    return partial(explore, problem, (640.0, 670.0), special_points=1)


def cell() -> Callable[..., Iterator[Any]]:
    made = Cell(regular_sites(3), 8)
    return partial(explore_cell, made, "load", (50.0, 58.0), 100.0, special_points=1)


@pytest.mark.parametrize(
    "exploration",
    [
        pytest.param(springs, id="springs"),
        pytest.param(cell, id="cell", marks=pytest.mark.slow),
    ],
)
def test_exploration_goes_on_as_if_it_had_not_stopped(
    exploration: Callable[[], Callable[..., Iterator[Any]]],
) -> None:
    """From a step on a branch, and from the end of one with others still to be followed."""
    whole, kept = [], []
    for point in exploration()():
        whole.append(told(point))
        kept.append(None if point.then is None else from_file(point.then.arrays()))
    assert {point[0] for point in whole} == {0, 1, 2}
    ends = [k for k, (a, b) in enumerate(pairwise(whole)) if a[0] != b[0]]
    for k in {len(whole) // 3, *ends[:1], len(whole) - 1}:
        while kept[k] is None:
            k += 1
        rest = exploration()(progress=kept[k])
        assert [told(point) for point in rest] == whole[k + 1 :]


def test_last_point_beyond_doubt_is_kept_apart_from_the_last_one() -> None:
    """With all else that a step depends on."""
    mesh = mesh_of(*hexagon_points(4))
    problem = Problem(mesh)
    control = StepControl(window=(300.0, 700.0), unit=700.0)
    points = [stable_point(problem, load, control) for load in (300.0, 400.0, 500.0)]
    lead, before, here = (KeptPoint.of(point) for point in points)
    progress = Progress(
        leads=(Lead(1, 5, lead, 2),),
        met=((lead.point.x, 300.0),),
        order=6,
        branch=3,
        origin=1,
        here=here,
        before=before,
        step=0.02,
        left=17,
    )
    family = FilmFamily(problem, problem.film.of_loop(mesh.shape))
    again = progress_from(from_file(progress.arrays()), family)
    assert again.here is not None
    assert again.before is not None
    first = again.leads[0]
    pairs = (again.here, here), (again.before, before), (first.start, lead)
    for kept, point in pairs:
        assert kept.point.value == point.point.value
        np.testing.assert_array_equal(kept.point.x, point.point.x)
    assert (first.n_unstable, first.order, first.origin) == (1, 5, 2)
    assert again.met[0][1] == 300.0
    numbers = again.order, again.branch, again.origin, again.step, again.left
    assert numbers == (6, 3, 1, 0.02, 17)
    alone = progress_from(from_file(replace(progress, before=here).arrays()), family)
    assert alone.before is alone.here
