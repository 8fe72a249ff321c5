"""Random cells from random starts, those of scripts/cell_campaign with another seed."""

from __future__ import annotations

import pytest

from eulerplateau.solvers import Status
from scripts.studies.cell_campaign.cases import outcome

CELLS, SEED = 40, 2
# What a cell may say of why it is no minimum.
REASONS = {Status.TOUCHING, Status.COLLAPSED, Status.UNRESOLVED}


@pytest.mark.slow
def test_every_random_cell_ends_as_a_minimum_or_says_why_not() -> None:
    for number in range(CELLS):
        found = outcome(SEED, number)
        assert not found.crossed, number
        if found.status == Status.CONVERGED.value:
            assert found.n_unstable == 0, number
            assert found.residual < 1e-6, number
        else:
            assert Status(found.status) in REASONS, number


@pytest.mark.slow
def test_a_random_cell_is_the_same_each_time() -> None:
    first, second = (outcome(SEED, 1) for _ in range(2))
    assert first.status == second.status
    assert first.residual == second.residual
