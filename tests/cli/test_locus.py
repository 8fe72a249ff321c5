"""What `eulerplateau locus` says of a curve."""

from __future__ import annotations

from pathlib import Path

import pytest

from eulerplateau.cli.locus import _report
from eulerplateau.film import FILM_LOADS
from eulerplateau.runs import Locus
from eulerplateau.runs.parameters import LOOP_PARAMETERS

NAMES = FILM_LOADS["area"], LOOP_PARAMETERS["link"]


def said(
    kind: str, special: str, end: str, capsys: pytest.CaptureFixture[str]
) -> list[str]:
    """The lines about a curve of two points."""
    at = {NAMES[0].column: 1900.0, NAMES[1].column: 0.0, "kind": kind}
    start = {**at, "arclength": 0.0, "special": special, "end": ""}
    last = {**at, "arclength": 0.1, "special": "", "end": end}
    _report(Locus(Path("f"), NAMES, (start, last), 1.0, ("inversion",)), ["locus.csv"])
    return capsys.readouterr().out.splitlines()


def test_a_fold_that_is_followed_names_what_the_second_parameter_broke(
    capsys: pytest.CaptureFixture[str],
) -> None:
    first, *_ = said("fold", "cusp", "leaves the window", capsys)
    assert "breaks what the bifurcation needs (inversion)" in first
    assert first.startswith(NAMES[1].text)
    assert "followed is the fold" in first


def test_where_a_mesh_breaks_it_the_end_names_it(
    capsys: pytest.CaptureFixture[str],
) -> None:
    lines = said("bifurcation", "start", "symmetry is lost", capsys)
    (line,) = (line for line in lines if "lost" in line)
    assert "the mesh breaks what the bifurcation needs (inversion)" in line


def test_a_curve_that_keeps_its_symmetry_says_nothing_of_it(
    capsys: pytest.CaptureFixture[str],
) -> None:
    lines = said("bifurcation", "start", "leaves the window", capsys)
    assert not any("inversion" in line for line in lines)
