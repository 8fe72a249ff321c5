"""scripts/stability_report: its references, and what the committed table holds."""

from __future__ import annotations

import csv
import functools
from pathlib import Path

import numpy as np
import pytest

from scripts.studies.stability import trials
from scripts.studies.stability.__main__ import MARK
from tests.helpers.extremes import TENSIONS, cases, oval

DOCS = Path(__file__).parents[2] / "docs"


def committed() -> list[dict[str, str]]:
    with (DOCS / "stability.csv").open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def trial(against: str, load: float, case: cases.DisplacedDisk) -> trials.Trial:
    return trials.Trial(
        "any", "any", "springs", load, case, against, twin=case, solver="newton"
    )


def test_refined_disk_has_four_triangles_for_one_and_the_same_rest_shape() -> None:
    coarse = oval(3)
    fine = trials.refined(coarse, coarse.mesh.x)
    assert len(fine.triangles) == 4 * len(coarse.triangles)
    assert fine.mesh.n_b == 2 * coarse.mesh.n_b
    assert fine.mesh.length == pytest.approx(1.0, rel=1e-14)
    np.testing.assert_allclose(fine.displacement, 0, atol=1e-15)


def test_case_that_is_its_own_twin_has_no_error() -> None:
    row = trials.row(trial(trials.TWIN, 300.0, oval(4)))
    assert row.happened == "converged"
    assert (row.energy_error, row.shape_error, row.eigenvalue_error) == (0, 0, 0)


def test_bare_loop_is_a_reference_of_first_order_in_the_load() -> None:
    rows = [trials.row(trial(trials.BARE, load, oval(4))) for load in (1.0, 2.0)]
    assert rows[1].energy_error / rows[0].energy_error == pytest.approx(4.0, rel=0.1)


def test_unresolved_case_is_held_against_a_mesh_that_resolves_it() -> None:
    row = trials.row(trial(trials.FINER, 300.0, cases.polygon(6)))
    assert row.happened == "unresolved"
    assert row.against.endswith("converged")
    assert 0 < row.energy_error < 1


def test_refused_case_is_a_row_with_the_reason_and_no_numbers() -> None:
    case = cases.short_edge(oval(4), 1e-6)
    row = trials.row(trial(trials.TWIN, TENSIONS[0], case))
    assert row.happened.startswith("refused: edge")
    assert np.isnan([row.energy_error, row.shape_error, row.condition]).all()


def test_committed_table_has_every_trial_of_every_film_and_the_page_shows_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # Every film has them on the same meshes.
    monkeypatch.setattr(trials, "hexagon", functools.cache(trials.hexagon))
    monkeypatch.setattr(cases, "polygon", functools.cache(cases.polygon))
    rows = committed()
    told = {(row["group"], row["name"], row["film"], row["solver"]) for row in rows}
    wanted = {
        (trial.group, trial.name, trial.film, trial.solver)
        for film in cases.FILMS
        for trial in trials.trials(film)
    }
    assert told == wanted
    page = (DOCS / "stability.md").read_text(encoding="utf-8")
    table = page.partition(MARK)[2]
    shown = [line for line in table.splitlines() if line.startswith("| ")]
    heads = 2 * len({row["group"] for row in rows})
    assert len(shown) == len(rows) + heads


def test_committed_rows_keep_what_the_page_promises() -> None:
    for row in committed():
        if row["happened"] != "converged" or row["solver"] != "newton":
            continue
        exact = row["group"] in ("stretched polygon", "start") or row["against"] != "twin"
        exact = exact or (row["group"] == "same film" and row["name"] in UNCHANGED)
        if exact:
            assert float(row["energy_error"]) < 1e-11, row
        if row["name"].startswith("2^"):
            assert float(row["energy_error"]) == float(row["shape_error"]) == 0


UNCHANGED = ("1e-9 m", "1e9 m", "2^-30 m", "rotated", "renumbered")
