"""scripts/contact_starts: laws that hold wherever a random start of a thick loop ends."""

from __future__ import annotations

import numpy as np
import pytest

from scripts.studies.contact_starts.brute_force import least_distance
from scripts.studies.contact_starts.starts import End, case, run


def check_laws(ends: list[End]) -> None:
    converged = [end for end in ends if end.converged]
    assert converged
    for end in converged:
        assert not end.failures, end


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
    # One of each film; strands of the second touch at the end.
    ends = [run(case(seed)) for seed in (3, 4, 5)]
    assert ends[1].contacts > 0
    check_laws(ends)


@pytest.mark.slow
def test_many_random_starts_end_without_overlap_or_pull_below_where_they_began() -> None:
    check_laws([run(case(seed)) for seed in range(60)])
