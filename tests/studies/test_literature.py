"""scripts/literature: the committed table is what it prints, and its numbers hold."""

from __future__ import annotations

from pathlib import Path

import pytest

from scripts.studies.literature.__main__ import cells, table
from scripts.studies.literature.statements import (
    agreement,
    rackets,
    rings_under_pressure,
    threshold,
)

PAGE = (Path(__file__).parents[2] / "docs" / "literature.md").read_text(encoding="utf-8")


@pytest.mark.slow
def test_the_committed_table_is_the_one_that_is_printed() -> None:
    assert f"\n\n{table()}\n" in PAGE


def test_planar_films_are_on_the_page_as_printed() -> None:
    for said in (*rings_under_pressure(), *rackets()):
        assert f"| {' | '.join(cells(said))} |\n" in PAGE


def test_rings_under_pressure_touch_where_flaherty_keller_and_rubinow_found() -> None:
    point, line, _ = rings_under_pressure()
    assert (point.theirs, line.theirs) == ("ν = 5.247", "ν = 10.34")  # noqa: RUF001
    assert point.agree == line.agree == "yes, as printed"


def test_numbers_agree_if_they_are_one_or_ours_rounds_to_theirs() -> None:
    def agrees(theirs: str, here: float) -> str:
        return threshold("", "", theirs, here, 6).agree

    assert agrees("3", 3.0 + 1e-12) == "yes"
    assert agrees("3", 3.001).startswith("to 3e-04")
    assert agrees("5.247", 5.2469) == "yes, as printed"
    assert agrees("5.247", 5.2463).startswith("to ")
    assert agreement(4.0, 3.0) == "no: -25.0 %"
