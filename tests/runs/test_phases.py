"""A phase diagram as data: where its lines reach, and what lies between them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from eulerplateau.runs.phases import REGIONS, Line, PhaseDiagram


def line(name: str, sigma_hat: list[float], ks_hat: list[float]) -> Line:
    return Line(name, np.array(sigma_hat), np.array(ks_hat))


def test_line_is_straight_in_logarithms_and_infinite_where_it_does_not_reach() -> None:
    fold = line("fold", [10.0, 1000.0], [400.0, 4.0])
    found = fold.at(np.array([1.0, 9.99, 10.0, 100.0, 1000.0, 1001.0]))
    assert found == pytest.approx([np.inf, np.inf, 400.0, 40.0, 4.0, np.inf])
    assert np.isinf(line("fold", [], []).at(np.ones(3))).all()


def test_regions_lie_between_the_lines() -> None:
    """From soft to stiff: each line is where the next region begins."""
    names = "inflection", "symmetry lost", "symmetry regained", "fold"
    heights = 10.0, 20.0, 40.0, 80.0
    lines = {
        name: line(name, [10.0, 100.0], [height, height])
        for name, height in zip(names, heights, strict=True)
    }
    diagram = PhaseDiagram(
        Path(), (1.0, 1e3), (1.0, 1e3), lines, {}, None, {}, {}, seconds=0.0
    )
    ks = np.array([5.0, 15.0, 30.0, 60.0, 90.0])
    within = diagram.regions(np.full(5, 30.0), ks)
    assert [REGIONS[k] for k in within] == [
        "convex", "inflected", "unlike sides", "inflected", "collapsed"
    ]  # fmt: skip
    # Where no line reaches nothing happens.
    assert (diagram.regions(np.full(5, 5.0), ks) == 0).all()
    assert (diagram.regions(np.full(5, 500.0), ks) == 0).all()
