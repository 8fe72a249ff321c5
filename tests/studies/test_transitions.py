"""scripts/transitions: limits under refinement, and how sure they are."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.special import stdtr

from scripts.studies.transitions.report import NAMES, limit


def points(noise: float, seed: int = 0) -> list[tuple[int, int, float]]:
    """Loads that tend to 2000, each algorithm's with an error of its own size."""
    rng = np.random.default_rng(seed)
    return [
        (algorithm, n_b, 2000.0 + size / n_b**2 + noise * rng.standard_normal())
        for algorithm, size in ((5, 1e4), (6, -3e4), (8, 2e3))
        for n_b in (78, 118, 168, 238)
    ]


def test_errors_of_second_order_are_taken_out_exactly() -> None:
    value, error = limit(points(0.0))
    assert value == pytest.approx(2000.0, rel=1e-12)
    assert error < 1e-8


def test_two_errors_cover_the_limit_as_often_as_students_t_says() -> None:
    """Twelve loads, four unknowns: two standard errors of eight degrees of freedom."""
    found = [limit(points(0.05, seed)) for seed in range(400)]
    covered = np.mean([abs(value - 2000.0) <= error for value, error in found])
    expected = 1 - 2 * stdtr(8, -2.0)
    assert covered == pytest.approx(
        expected, abs=4 * np.sqrt(expected * (1 - expected) / 400)
    )


def test_table_of_the_committed_page_is_that_of_the_committed_loads() -> None:
    """Every limit in docs/transitions.md, from docs/transitions_dirichlet.csv."""
    docs = Path(__file__).parents[2] / "docs"
    page = (docs / "transitions.md").read_text(encoding="utf-8")
    lines = (docs / "transitions_dirichlet.csv").read_text().splitlines()[1:]
    met: dict[tuple[str, str], list[tuple[int, int, float]]] = {}
    for line in lines:
        _, polygon, algorithm, _, n_b, before, after, last, first, _ = line.split(",")
        name = NAMES[before, after]
        middle = 0.5 * (float(last) + float(first))
        met.setdefault((polygon, name), []).append((int(algorithm), int(n_b), middle))
    assert len(met) == 13
    for (polygon, _), loads in met.items():
        rows = [text for text in page.splitlines() if text.startswith(f"| {polygon} |")]
        assert any(f" {limit(loads)[0]:.2f} ±" in row for row in rows)
