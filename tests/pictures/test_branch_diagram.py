"""The diagram of branches: read back as it was followed, drawn whole."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from eulerplateau.branches.special import BIFURCATION, FOLD
from eulerplateau.pictures.branch_diagram import draw_branches, plot_branches
from eulerplateau.pictures.film_pictures import signed_twists
from eulerplateau.runs.record import Run
from eulerplateau.runs.rows import BranchRow
from eulerplateau.runs.series import Branch, energy_above, read_branches
from eulerplateau.runs.table import RowWriter
from tests.helpers.shapes import fitted_order
from tests.pictures.test_pictures import read_png
from tests.runs.test_output import ROW

ONSET, END = 100.0, 110.0
KINDS = {0: BIFURCATION, 1: BIFURCATION}


def point(branch: int, load: float, n_unstable: int, **values: Any) -> BranchRow:
    """A row; by default planar, with an energy quadratic in the load."""
    defaults: dict[str, Any] = {
        "abs_kappa_n": 0.0,
        "waist_twist": 0.0,
        "energy": first_energy(load),
        "film_energy": load * (1.0 - load / 500.0),
    }
    row = replace(
        ROW, kL3_alpha=load, n_unstable=n_unstable, **{**defaults, **row_part(values)}
    )
    place = {"origin": None, "special": None, "arclength": load} | values
    keys = ("origin", "special", "arclength")
    return BranchRow(**asdict(row), branch=branch, **{key: place[key] for key in keys})


def row_part(values: dict[str, Any]) -> dict[str, Any]:
    return {k: v for k, v in values.items() if k not in ("origin", "special", "arclength")}


def first_energy(load: float) -> float:
    return 30.0 + load - load**2 / 1000.0


def diagram() -> list[BranchRow]:
    """Planar, both sides of a pitchfork to a twisted film, the planar eight it ends in."""
    rows = [point(0, load, int(load > ONSET)) for load in (1.0, 40.0, 80.0)]
    rows.append(point(0, ONSET, 1, special=0))
    rows += [point(0, load, 1) for load in (150.0, 300.0, 600.0)]
    for branch, sign in ((1, 1.0), (2, -1.0)):
        for s in (0.1, 0.4, 0.7, 0.9):
            load = ONSET + (END - ONSET) * s**2
            twist = sign * 180.0 * s
            rows.append(
                point(branch, load, 0, origin=0, arclength=s, waist_twist=twist,
                      abs_kappa_n=s, energy=first_energy(load) - s**4)
            )  # fmt: skip
        rows.append(
            point(branch, END, 1, origin=0, special=1, arclength=1.0, waist_twist=180.0)
        )
    rows += [
        point(3, load, 0, origin=1, arclength=load - END, waist_twist=turn)
        for load, turn in ((120.0, 180.0), (300.0, -180.0), (600.0, 180.0))
    ]
    rows += [
        point(4, load, 1, origin=1, arclength=END - load, waist_twist=-180.0)
        for load in (90.0, 30.0, 1.0)
    ]
    return [replace(row, step=step) for step, row in enumerate(rows)]


@pytest.fixture
def branches() -> list[Branch]:
    return read_branches(diagram())


def test_branches_start_at_the_special_point_they_leave(branches: list[Branch]) -> None:
    assert [branch.number for branch in branches] == [0, 1, 2, 3, 4]
    assert [branch.rows[0].special for branch in branches] == [None, 0, 0, 1, 1]
    assert [branch.rows[0].kL3_alpha for branch in branches[1:]] == [ONSET, ONSET, END, END]


def test_stability_changes_at_special_points(branches: list[Branch]) -> None:
    """Up to the onset stable, then not; the twisted branch stable from end to end."""
    assert branches[0].stable.tolist() == [True] * 3 + [False] * 3
    for branch in branches[1:4]:
        assert branch.stable.all()
    assert not branches[4].stable.any()
    assert [branch.bridges for branch in branches] == [False, True, True, False, False]


def test_mirror_images_have_opposite_twists(branches: list[Branch]) -> None:
    """Planar films lie on both sides at once; the ends of a side belong to that side."""
    planar, left, right, eight, _ = (signed_twists(branch) for branch in branches)
    assert len(planar) == len(eight) == 2
    assert np.array_equal(eight[0], [180.0] * 4)
    assert np.array_equal(eight[1], [-180.0] * 4)
    assert np.array_equal(left[0], -right[0])
    assert left[0][-1] == 180.0
    assert np.all(np.diff(left[0]) > 0)


def test_energies_are_compared_at_equal_loads(branches: list[Branch]) -> None:
    """Exact where the first branch's energy is a polynomial of the load; NaN beyond it."""
    above = energy_above(branches[0])
    assert np.abs(above(branches[0])).max() < 1e-12
    s = np.array([0.0, 0.1, 0.4, 0.7, 0.9])
    assert above(branches[1])[:-1] == pytest.approx(-(s**4), abs=1e-10)
    short = Branch(branches[0].rows[:3])
    assert np.isnan(energy_above(short)(branches[1])).all()
    single = Branch(branches[0].rows[:1])
    assert np.isnan(energy_above(single)(branches[1])).all()


def test_first_branch_counts_up_to_where_it_folds(branches: list[Branch]) -> None:
    rows = branches[0].rows
    folded = Branch((*rows[:4], *rows[2::-1]))
    assert np.isnan(energy_above(folded)(branches[3])).all()
    assert np.abs(energy_above(folded)(folded)).max() < 1e-12


def test_energy_is_interpolated_to_fourth_order() -> None:
    """E = log(load): the error at midpoints falls as the fourth power of the step."""
    sizes, errors = [], []
    for n in (8, 16, 32):
        loads = np.linspace(100.0, 200.0, n + 1)
        rows = [point(0, load, 0, energy=math.log(load), film_energy=1.0) for load in loads]
        middle = 0.5 * (loads[0] + loads[1])
        probe = Branch((point(1, middle, 0, energy=math.log(middle)),), number=1)
        sizes.append(1.0 / n)
        errors.append(float(energy_above(Branch(tuple(rows)))(probe)[0]))
    assert fitted_order(sizes, errors) == pytest.approx(4.0, abs=0.3)


def test_pitchforks_are_drawn_smooth(branches: list[Branch]) -> None:
    """Between points too the amplitude is the root of the distance to the onset."""
    branch = branches[1]
    part = slice(0, 5)
    load = branch.smooth(branch.loads, part)
    kappa = branch.smooth(branch.values(lambda row: row.abs_kappa_n), part)
    assert load[0] == ONSET
    assert set(branch.loads[part]) <= set(load)
    root = np.sqrt((load - ONSET) / (END - ONSET))
    assert np.abs(kappa - root).max() < 0.05


def test_what_is_a_size_is_drawn_nowhere_below_zero(branches: list[Branch]) -> None:
    """Where a branch meets a flat one the amplitude has a kink: a spline would swing."""
    branch = branches[1]
    amplitude = np.maximum(np.arange(len(branch.rows)) - 2.0, 0.0)
    for values in (amplitude, amplitude[::-1]):
        assert branch.smooth(values, slice(0, len(values))).min() >= 0.0


@pytest.mark.parametrize(
    "case", ["whole", "one point", "one branch", "all unstable", "folds", "no twist"]
)
def test_every_diagram_is_drawn_and_nothing_cut_off(tmp_path: Path, case: str) -> None:
    rows, kinds = diagram(), dict(KINDS)
    if case == "one point":
        rows = rows[:1]
    elif case == "one branch":
        rows = [row for row in rows if row.branch == 0]
    elif case == "all unstable":
        rows = [replace(row, n_unstable=2) for row in rows]
    elif case == "folds":
        kinds[1] = FOLD
    elif case == "no twist":
        rows = [replace(row, waist_twist=math.nan) for row in rows]
    check_picture(tmp_path, rows, kinds)


def test_many_special_points_find_room(tmp_path: Path) -> None:
    loads = [*np.linspace(300.0, 310.0, 8), *np.linspace(590.0, 600.0, 8)]
    rows = [row for row in diagram() if row.branch == 0][:4]
    rows += [point(0, load, 1, special=n) for n, load in enumerate(loads, start=1)]
    check_picture(tmp_path, rows, dict.fromkeys(range(17), BIFURCATION))


def check_picture(folder: Path, rows: Sequence[BranchRow], kinds: dict[int, str]) -> None:
    special = {number: {"kind": kind} for number, kind in kinds.items()}
    run = Run(folder, tuple(rows), explored=True, special=special)
    plot_branches(run, folder / "branches.png")
    image = read_png(folder / "branches.png")
    assert image.std() > 0.05
    frame = np.concatenate([image[0], image[-1], image[:, 0], image[:, -1]])
    assert (frame == 1.0).all()


def test_folder_is_drawn(tmp_path: Path) -> None:
    with RowWriter(tmp_path / "branches.csv", BranchRow) as table:
        for row in diagram():
            table.append(row)
    with (tmp_path / "special_points.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerows([("number", "kind"), *KINDS.items()])
    assert draw_branches(tmp_path)
    assert read_png(tmp_path / "branches.png").std() > 0.05


def test_missing_table_is_reported_not_raised(tmp_path: Path) -> None:
    assert not draw_branches(tmp_path)
