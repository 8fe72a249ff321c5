"""Runs of cells: what a specification may say, what a folder holds, read back."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from eulerplateau.errors import OutputError, SpecError
from eulerplateau.exact.cell import folds, regular_cell, symmetry_breaking
from eulerplateau.mesh import polygon_area, read_vtp
from eulerplateau.runs import (
    CellBranchRow,
    CellRow,
    CellRunSpec,
    load_cell_run,
    read_run,
    read_runs,
    run_cell_branches,
    run_cell_sweep,
    run_phase_diagram,
)
from eulerplateau.solvers import Status

CELL = {"adhesions": 3, "edges_per_side": 16, "ks_hat": 100.0}


def spec(**sections) -> CellRunSpec:
    given = {"cell": CELL, "sweep": {"values": [10.0, 40.0]}, **sections}
    return CellRunSpec(**given)


def table(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


@pytest.fixture(scope="module")
def swept(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("cell") / "up"
    wide = {"values": [{"start": 20.0, "stop": 100.0, "step": 20.0}]}
    cell = {**CELL, "edges_per_side": 24}
    result = run_cell_sweep(spec(cell=cell, sweep=wide), folder)
    assert [row.step for row in result.rows] == list(range(len(result.rows)))
    return folder


def test_rows_are_read_back_bit_for_bit_and_hold_the_energy_together(swept):
    run = read_run(swept)
    for row in run.rows:
        assert isinstance(row, CellRow)
        parts = row.bending_energy + row.film_energy + row.adhesion_energy
        assert row.energy == pytest.approx(parts + row.line_energy, rel=1e-12)
        assert row.traction == pytest.approx(2 * row.ks_hat * row.extension, rel=1e-12)
        assert row.film_energy == pytest.approx(row.sigma_hat * row.area, rel=1e-12)
    assert run.kind.name == "cell"
    assert run.load.column == "sigma_hat"


def test_sweep_ends_where_the_edge_meets_itself_and_says_so(swept):
    """Beyond the loss of symmetry at 66.05 there is no smooth cell to go to."""
    rows = read_run(swept).rows
    assert [row.sigma_hat for row in rows] == [20.0, 40.0, 60.0, 80.0]
    assert [row.status for row in rows] == [Status.CONVERGED] * 3 + [Status.TOUCHING]
    totals = json.loads((swept / "run.json").read_text())["totals"]
    assert (totals["values"], totals["of"], totals["not_converged"]) == (4, 5, [3])


def test_shapes_hold_edge_film_and_forces_that_balance(swept):
    for row in read_run(swept).rows:
        shape = read_vtp(swept / f"shapes/shape_{row.step:04d}.vtp")
        x = shape.points[:, :2]
        assert polygon_area(x) == pytest.approx(row.area, rel=1e-12)
        corners = x[shape.triangles]
        sides = corners[:, 1:] - corners[:, :1]
        halves = sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]
        assert 0.5 * halves.sum() == pytest.approx(row.area, rel=1e-12)
        force = shape.point_fields["force"]
        largest = np.abs(force).max()
        if row.converged:
            np.testing.assert_allclose(force.sum(axis=0), 0, atol=1e-8 * largest)
        assert shape.point_fields["adhesion"].sum() == 3


def test_direction_is_up_down_or_both():
    values = {"values": [1.0, 3.0, 2.0]}
    order = {"up": [1, 2, 3], "down": [3, 2, 1], "up-down": [1, 2, 3, 2, 1]}
    for direction, wanted in order.items():
        swept = spec(sweep={**values, "direction": direction})
        assert [sigma for sigma, _ in swept.pairs()] == wanted


def test_stiffness_may_be_swept_instead(tmp_path):
    varied = {"parameter": "ks_hat", "values": [20.0, 50.0]}
    rows = run_cell_sweep(spec(sweep=varied), tmp_path / "run").rows
    assert [row.load for row in rows] == [20.0, 50.0]
    for row in rows:
        exact = regular_cell(3, 10.0, row.ks_hat)
        assert row.perimeter == pytest.approx(exact.perimeter, rel=5e-3)
    assert read_run(tmp_path / "run").load.column == "ks_hat"


@pytest.mark.slow
def test_branches_find_the_loss_of_symmetry_and_the_fold(tmp_path):
    """Both within the discretisation's error of the exact ones, which is second order."""
    exact = folds(3, 100.0)[0].sigma_hat
    off = []
    for edges in (16, 32):
        cell = {**CELL, "edges_per_side": edges, "sigma_hat": 55.0}
        window = {"low": 50.0, "high": 75.0, "special_points": 0, "unstable_modes": 2}
        folder = tmp_path / str(edges)
        result = run_cell_branches(spec(cell=cell, branches=window), folder)
        kinds = {point["kind"]: point["sigma_hat"] for point in result.special}
        off.append([kinds["fold"] - exact, kinds["bifurcation"] - 66.0454302841])
    np.testing.assert_allclose(np.log2(np.array(off[0]) / off[1]), 2.0, atol=0.25)
    run = read_run(folder)
    assert all(isinstance(row, CellBranchRow) for row in run.rows)
    assert {row.special for row in run.rows} >= {0, 1}
    written = table(folder / "special_points.csv")
    assert [line["kind"] for line in written] == ["bifurcation", "fold"]
    assert [int(line["multiplicity"]) for line in written] == [2, 1]


def test_exact_loss_of_symmetry_is_where_the_test_above_says():
    from scipy.optimize import brentq

    def lowest(sigma: float) -> float:
        return regular_cell(3, sigma, 100.0).waves.lowest(1)

    found = brentq(lowest, 64.0, 67.0, xtol=1e-9)
    assert found == pytest.approx(66.0454302841, abs=1e-6)
    at = symmetry_breaking(3, found)[0]
    assert at.ks_hat == pytest.approx(100.0, rel=1e-6)


@pytest.mark.slow
def test_phase_diagram_has_lines_points_and_a_shape_in_each_region(tmp_path):
    window = {"sigma_hat": [30.0, 200.0], "ks_hat": [40.0, 200.0], "columns": 8}
    diagram = run_phase_diagram(
        CellRunSpec(cell=CELL, phase_diagram=window), tmp_path / "phases"
    )
    assert set(diagram.shapes) == {"convex", "inflected", "unlike sides", "collapsed"}
    for region, wanted in (("convex", 1), ("inflected", -1)):
        cell = diagram.shapes[region]
        exact = regular_cell(3, cell.sigma_hat, cell.ks_hat)
        assert np.sign(exact.kappa_mid) == np.sign(cell.kappa_mid.mean()) == wanted
        assert exact.n_unstable == cell.n_unstable == 0
    unlike = diagram.shapes["unlike sides"]
    assert regular_cell(3, unlike.sigma_hat, unlike.ks_hat).n_unstable == 2
    lines = table(tmp_path / "phases/lines.csv")
    assert {line["line"] for line in lines} >= {"inflection", "symmetry lost", "fold"}
    for line in lines[::40]:
        if line["line"] == "inflection":
            assert float(line["kappa_mid"]) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("sections", "culprit"),
    [
        ({"cell": {}}, "cell.adhesions"),
        ({"cell": {"adhesions": 3, "points": "x.csv"}}, "cell.adhesions"),
        ({"cell": {"adhesions": 1}}, "cell.adhesions"),
        ({"cell": {**CELL, "edges_per_side": 7}}, "cell.edges_per_side"),
        ({"cell": {**CELL, "ks_hat": 0.0}}, "cell.ks_hat"),
        ({"sweep": {"values": []}}, "sweep.values"),
        ({"sweep": {"parameter": "ks_hat", "values": [0.0, 1.0]}}, "sweep.values"),
        ({"sweep": {"parameter": "k", "values": [1.0]}}, "sweep.parameter"),
        ({"phase_diagram": {"ks_hat": [3.0, 2.0]}}, "phase_diagram.ks_hat"),
        ({"mesh": {"file": "x"}}, "mesh"),
    ],
)
def test_wrong_key_is_named(sections, culprit):
    with pytest.raises(SpecError, match=culprit):
        spec(**sections)


def test_what_a_command_needs_is_asked_for(tmp_path):
    with pytest.raises(SpecError, match=r"sweep\.values"):
        run_cell_sweep(CellRunSpec(cell=CELL), tmp_path / "a")
    with pytest.raises(SpecError, match=r"cell\.beta_hat"):
        run_phase_diagram(CellRunSpec(cell={**CELL, "beta_hat": 1.0}), tmp_path / "b")
    assert list(tmp_path.iterdir()) == []


def test_points_are_looked_for_beside_the_specification(tmp_path):
    (tmp_path / "points.csv").write_text("1,0\n-0.5,0.9\n-0.5,-0.9\n")
    text = '[cell]\npoints = "points.csv"\n[sweep]\nvalues = [1.0]\n'
    (tmp_path / "run.toml").write_text(text)
    found = load_cell_run(tmp_path / "run.toml", {})
    np.testing.assert_array_equal(found.cell.sites().points[0], [1.0, 0.0])


def test_films_and_cells_are_not_shown_together(swept, tmp_path):
    other = tmp_path / "film"
    other.mkdir()
    (other / "sweep.csv").write_text((swept / "sweep.csv").read_text())
    with pytest.raises(OutputError):
        read_runs([swept, other])
