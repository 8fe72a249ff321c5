"""scripts/contact_starts: laws that hold wherever a random start of a thick loop ends."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.loop import Loop, close_with_lengths, strands_of
from eulerplateau.solvers import separated
from scripts.studies.contact_starts.brute_force import least_distance
from scripts.studies.contact_starts.starts import (
    OVERLAP,
    End,
    case,
    disk_of,
    loop_of,
    run,
)


def check_laws(ends: list[End]) -> None:
    """Whatever the status."""
    assert any(end.converged for end in ends)
    for end in ends:
        assert not end.failures, end


@pytest.mark.parametrize(
    ("seed", "why"),
    [
        (40, "a vertex at which the loop turns back on itself"),
        (29, "a bend, and strands that lie along each other beside it"),
        (252, "strands wound so close that swelling does not part them"),
    ],
)
def test_parted_starts_overlap_nowhere_at_bends_either(seed: int, why: str) -> None:
    told = case(seed)
    mesh = disk_of(told.aspect)
    loop = Loop(mesh.rest_lengths, diameter=told.diameter)
    start = close_with_lengths(loop, loop_of(mesh, told))
    assert start is not None
    apart = 0.5 * np.pi * told.diameter
    assert least_distance(start, loop.rest_lengths, apart) < 0.5 * told.diameter, why
    parted = separated(strands_of(loop), start)
    assert parted is not None
    least = least_distance(parted, loop.rest_lengths, apart)
    assert least > (1 - OVERLAP) * told.diameter
    assert loop.length_error(parted) < 1e-12


def test_chords_that_pass_each_other_do_not_hold_up_curves_that_do_not() -> None:
    """A line much thinner than its edges: no step would be short enough else."""
    end = run(case(186))
    assert end.converged
    assert not end.failures


@pytest.mark.parametrize("gap", [1e-3, 0.02])
def test_brute_force_finds_where_an_eight_crosses_itself(gap: float) -> None:
    angle = 2 * np.pi * np.arange(48) / 48
    x = np.stack([np.sin(angle), np.sin(2 * angle), 0.5 * gap * np.cos(angle)], axis=1)
    lengths = np.linalg.norm(np.roll(x, -1, axis=0) - x, axis=1)
    # Its strands cross at two vertices, half of the loop from each other.
    assert least_distance(x, lengths, 0.1) == pytest.approx(gap, rel=1e-9)
    # Shifted by a part of an edge they cross between vertices, as far as the spline does.
    angle += 0.3 * angle[1]
    x = np.stack([np.sin(angle), np.sin(2 * angle), 0.5 * gap * np.cos(angle)], axis=1)
    lengths = np.linalg.norm(np.roll(x, -1, axis=0) - x, axis=1)
    assert least_distance(x, lengths, 0.1) == pytest.approx(gap, rel=1e-2)


@pytest.mark.slow
def test_brute_force_leaves_out_what_is_near_along_the_loop() -> None:
    n, apart = 96, 0.05
    angle = 2 * np.pi * np.arange(n) / n
    circle = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1) / (2 * np.pi)
    found = least_distance(circle, np.full(n, 1 / n), apart)
    # A chord over that much of its length.
    assert found == pytest.approx(np.sin(np.pi * apart) / np.pi, rel=1e-3)


@pytest.mark.slow
def test_random_starts_end_without_overlap_or_pull_below_where_they_began() -> None:
    # One of each film; strands of the second touch at the end. The last is a soap film
    # whose descent gets stuck, and that as a tied one comes to another, higher minimum.
    ends = [run(case(seed)) for seed in (3, 4, 5, 431)]
    assert ends[1].contacts > 0
    check_laws(ends)


@pytest.mark.slow
def test_many_random_starts_end_without_overlap_or_pull_below_where_they_began() -> None:
    check_laws([run(case(seed)) for seed in range(60)])
