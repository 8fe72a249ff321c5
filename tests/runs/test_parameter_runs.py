"""Runs in the link and in the rigidity to twist: keys, columns, going on, what is shown."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.integrate import simpson

from eulerplateau.errors import ConflictError, OutputError, SpecError
from eulerplateau.mesh import write_mesh
from eulerplateau.pictures import draw_branches, draw_diagram
from eulerplateau.pictures.gallery.collection import collect
from eulerplateau.pictures.gallery.document import page
from eulerplateau.runs import (
    BranchRow,
    read_run,
    read_runs,
    read_shape,
    run_branches,
    run_sweep,
)
from eulerplateau.runs.ensembles import joined, load_ensemble
from eulerplateau.runs.ensembles.cases import carry_out
from eulerplateau.runs.ensembles.folder import case_folder, case_places
from eulerplateau.runs.rows import COLUMNS, columns
from eulerplateau.runs.spec import RunSpec
from eulerplateau.settings import validate
from tests.helpers import shapes
from tests.helpers.command import run_here

TWIST = ("twist_energy", "writhe", "link", "twist_moment")
LINKS = {"parameter": "link", "values": [{"start": -0.2, "stop": 0.2, "step": 0.05}]}


@pytest.fixture(scope="module")
def mesh(tmp_path_factory: pytest.TempPathFactory) -> Path:
    points, triangles = shapes.disk_points(4)
    path = tmp_path_factory.mktemp("mesh") / "oval.vtp"
    write_mesh(shapes.mesh_of(points * [1.6, 1.0], triangles), path)
    return path


def said(mesh: Path, **sections: Any) -> dict[str, Any]:
    return {
        "mesh": {"file": str(mesh)},
        "film": {"load": 650.0},
        "loop": {"twist_ratio": 0.75},
        **sections,
    }


def spec(mesh: Path, **sections: Any) -> RunSpec:
    return validate(said(mesh, **sections), RunSpec, "run")


@pytest.fixture(scope="module")
def swept(mesh: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs") / "link"
    run_sweep(spec(mesh, sweep=LINKS), folder)
    return folder


@pytest.fixture(scope="module")
def explored(mesh: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs") / "branches"
    run_branches(branching(mesh), folder)
    return folder


def branching(mesh: Path) -> RunSpec:
    window = {"low": -0.02, "high": 0.1, "special_points": 0}
    return spec(
        mesh,
        loop={"twist_ratio": 0.75, "link": -0.02},
        sweep={"loads": [300.0]},
        branches={"parameter": "link", **window},
    )


def test_the_work_of_the_weld_along_a_sweep_is_2_pi_m(swept: Path) -> None:
    run = read_run(swept)
    assert run.kind.columns == (*COLUMNS, *TWIST)
    assert all(row.converged for row in run.rows)
    assert {row.kL3_alpha for row in run.rows} == {650.0}
    links = np.array([row.load for row in run.rows])
    np.testing.assert_allclose(links, np.linspace(-0.2, 0.2, 9), atol=1e-15)
    assert [row.link for row in run.rows] == links.tolist()
    rates = [row.energy_rate for row in run.rows]
    assert rates == pytest.approx([2 * np.pi * row.twist_moment for row in run.rows])
    # Through nine points a polynomial interpolates what is smooth to many digits.
    work = Polynomial.fit(links, rates, 8).integ()(links)
    energies = np.array([row.energy for row in run.rows])
    np.testing.assert_allclose(work - work[0], energies - energies[0], atol=1e-7)
    assert max(abs(row.writhe) for row in run.rows) > 0.01


def test_opposite_links_have_mirror_images(swept: Path) -> None:
    rows = read_run(swept).rows
    for row, image in zip(rows, rows[::-1], strict=True):
        assert image.link == pytest.approx(-row.link, abs=1e-15)
        assert image.energy == pytest.approx(row.energy, rel=1e-9)
        assert image.writhe == pytest.approx(-row.writhe, abs=1e-7)
        assert image.area == pytest.approx(row.area, rel=1e-7)


def test_a_sweep_in_link_goes_on_to_the_bit(
    mesh: Path, swept: Path, tmp_path: Path
) -> None:
    few = {"parameter": "link", "values": [{"start": -0.2, "stop": 0.0, "step": 0.05}]}
    run_sweep(spec(mesh, sweep=few), tmp_path / "part")
    with pytest.raises(ConflictError):
        run_sweep(spec(mesh, sweep=LINKS), tmp_path / "part")
    on = run_sweep(spec(mesh, sweep=LINKS), tmp_path / "part", resume=True)
    assert on.kept == 5
    whole = read_run(swept).rows
    assert [row.energy for row in on.rows] == [row.energy for row in whole]
    assert run_sweep(spec(mesh, sweep=LINKS), swept).finished
    with pytest.raises(ConflictError, match=r"sweep\.parameter"):
        run_sweep(spec(mesh, film={}, sweep={"loads": [650.0]}), swept, resume=True)


def test_a_sweep_in_the_rigidity_has_a_column_for_it(mesh: Path, tmp_path: Path) -> None:
    ratios = {"parameter": "twist_ratio", "values": [0.5, 0.75, 1.0]}
    loop = {"twist_ratio": 0.75, "link": 0.2}
    run_sweep(spec(mesh, loop=loop, sweep=ratios), tmp_path / "run")
    run = read_run(tmp_path / "run")
    assert run.kind.columns == (*COLUMNS, *TWIST, "twist_ratio")
    assert [row.twist_ratio for row in run.rows] == [row.load for row in run.rows]
    for row in run.rows:
        turned = 2 * np.pi * (row.link - row.writhe)
        assert row.twist_energy == pytest.approx(row.twist_ratio * turned**2, rel=1e-13)
    rates = [row.energy_rate for row in run.rows]
    gained = run.rows[-1].energy - run.rows[0].energy
    assert simpson(rates, x=[0.5, 0.75, 1.0]) == pytest.approx(gained, rel=1e-4)
    same = run_sweep(
        spec(mesh, loop=loop, film={}, sweep={"loads": [650.0]}), tmp_path / "a"
    )
    assert same.rows[0].energy == pytest.approx(run.rows[1].energy, rel=1e-9)


@pytest.mark.slow
def test_branches_in_link_say_so_wherever_they_are_shown(explored: Path) -> None:
    run = read_run(explored)
    assert (explored / "branches.csv").read_text().splitlines()[0].split(",") == [
        *columns(BranchRow),
        *TWIST,
    ]
    assert run.load.text == "link"
    assert "link -0.02 to" in repr(run)
    links = [row.link for row in run.rows]
    assert links[0] == -0.02
    assert min(links) < 0 < max(links)
    assert draw_branches(explored)
    assert "timestep is the load link" in (explored / "branches.pvd").read_text()
    text = page(collect([explored])).decode()
    assert '"load": "link"' in text
    with (explored / "special_points.csv").open(newline="") as file:
        names = csv.DictReader(file).fieldnames
    assert names is not None
    assert names[:6] == ["number", "kind", "link", "link_error", "kL3_alpha", "sigma_hat"]


def test_special_points_in_link_are_told_by_their_link(mesh: Path, tmp_path: Path) -> None:
    """The flat disk's, on the command line: its threshold is no load."""
    points, triangles = shapes.disk_points(4)
    write_mesh(shapes.mesh_of(points, triangles), tmp_path / "disk.vtp")
    (tmp_path / "run.toml").write_text(
        'mesh.file = "disk.vtp"\nfilm = { model = "dirichlet", load = 500.0 }\n'
        "loop = { twist_ratio = 0.75, link = 1.9 }\nsweep.loads = [500.0]\n"
        '[branches]\nparameter = "link"\nlow = 1.9\nhigh = 2.05\nspecial_points = 0\n'
    )
    ran = run_here("branches", str(tmp_path / "run.toml"), "--no-pictures")
    assert ran.returncode == 0
    run = read_run(tmp_path / "run-branches")
    (point,) = run.special.values()
    assert point["kind"] == "bifurcation"
    assert float(point["sigma_hat"]) == 500.0
    assert f"bifurcation 0 (double) at link = {float(point['link']):.8g} +- " in ran.stdout
    at = [row for row in run.rows if row.special == 0]
    assert {row.link for row in at} == {float(point["link"])}


class StopError(Exception):
    """What a test interrupts a run with."""


@pytest.mark.slow
def test_an_interrupted_branch_in_link_goes_on_to_the_bit(
    mesh: Path, explored: Path, tmp_path: Path
) -> None:
    whole = read_run(explored).rows

    def stop(row: BranchRow) -> None:
        if row.step == len(whole) // 2:
            raise StopError

    with pytest.raises(StopError):
        run_branches(branching(mesh), tmp_path / "run", stop)
    result = run_branches(branching(mesh), tmp_path / "run")
    assert result.kept > 0
    assert [row.link for row in result.rows] == [row.link for row in whole]
    for row in whole:
        name = f"shapes/shape_{row.step:04d}.vtp"
        assert (explored / name).read_bytes() == (tmp_path / "run" / name).read_bytes()


@pytest.mark.slow
def test_branches_start_from_a_stored_shape_at_its_own_link(
    mesh: Path, swept: Path, tmp_path: Path
) -> None:
    row = read_run(swept).rows[6]
    file = read_run(swept).shape_path(row)
    assert read_shape(file).parameters == {"link": row.link}
    window = {"low": 0.08, "high": 0.12, "special_points": 0}
    found = run_branches(
        spec(mesh, sweep=LINKS, branches=window, start={"file": str(file)}),
        tmp_path / "run",
    )
    first = found.rows[0]
    assert (first.link, first.kL3_alpha) == (row.link, 650.0)
    assert first.energy == pytest.approx(row.energy, rel=1e-10)
    with pytest.raises(SpecError, match=r"start\.file.*link 0\.1, outside"):
        run_branches(
            spec(
                mesh,
                sweep=LINKS,
                branches={**window, "high": 0.09},
                start={"file": str(file)},
            ),
            tmp_path / "other",
        )


@pytest.mark.slow
def test_runs_in_link_are_drawn_and_not_shown_over_the_load(
    mesh: Path, swept: Path, tmp_path: Path
) -> None:
    assert draw_diagram(swept)
    run_sweep(spec(mesh, film={}, sweep={"loads": [650.0]}), tmp_path / "load")
    with pytest.raises(OutputError, match=r"link.*show them apart"):
        read_runs([tmp_path / "load", swept])


def test_an_ensemble_in_link_joins_in_one_table(mesh: Path, tmp_path: Path) -> None:
    (tmp_path / "e.toml").write_text(
        f'mesh.file = "{mesh}"\nfilm.load = 650\nloop.twist_ratio = 0.75\n'
        'sweep.parameter = "link"\n'
        "[grid]\nsweep.values = [{ start = -0.1, stop = 0.1, step = 0.1 }]\n"
    )
    cases = load_ensemble(tmp_path / "e.toml").cases
    for case in cases:
        carry_out((case, case_folder(tmp_path, case.name)))
    table = joined(case_places(tmp_path, [case.name for case in cases]))
    assert [line["link"] for line in table.lines] == [-0.1, 0.0, 0.1]
    assert table.exit_code == 0


BARE = {"loop": {}}
LOADS = {"loads": [300.0]}
BY_RATIO = {"parameter": "twist_ratio", "values": [0.5]}


@pytest.mark.parametrize(
    ("sections", "culprit"),
    [
        ({**BARE, "sweep": LINKS}, r"sweep\.parameter.*needs loop\.twist_ratio"),
        (
            {**BARE, "sweep": LOADS, "branches": {"parameter": "link"}},
            r"branches\.parameter.*needs loop\.twist_ratio",
        ),
        ({"sweep": {**LINKS, **LOADS}}, r"sweep\.loads.*absent.*film\.load"),
        ({"sweep": {**LOADS, "values": [0.1]}}, r"sweep\.values.*sweep\.parameter"),
        ({"sweep": {"parameter": "link"}}, r"sweep\.values.*missing"),
        ({"sweep": {}}, r"sweep\.loads.*missing"),
        ({"sweep": {**BY_RATIO, "values": [0.5, -1.0]}}, r"sweep\.values.*-1.*above 0"),
        ({"sweep": {"parameter": "girth", "values": [1]}}, r"sweep\.parameter"),
        ({"sweep": {**LINKS, "quantity": "k"}}, r"sweep\.quantity.*absent"),
        ({"film": {}, "sweep": LINKS}, r"film\.load.*missing.*link"),
        ({"sweep": LOADS}, r"film\.load.*sweep\.loads"),
        (
            {"sweep": LINKS, "branches": {"load_min": 1.0}},
            r"branches\.load_min.*low to high",
        ),
        (
            {"film": {}, "sweep": LOADS, "branches": {"low": 1.0}},
            r"branches\.low.*load_min to load_max",
        ),
    ],
)
def test_slips_are_told_in_a_line(
    mesh: Path, sections: dict[str, Any], culprit: str
) -> None:
    with pytest.raises(SpecError, match=f"^{culprit}") as told:
        spec(mesh, **sections)
    assert "\n" not in str(told.value)


@pytest.mark.parametrize(
    ("sections", "culprit"),
    [
        ({"sweep": LOADS, "branches": {"parameter": "link"}}, r"branches\.low.*high"),
        ({"sweep": LINKS, "branches": {"low": 0.3}}, r"branches\.low.*below high, 0\.2"),
        (
            {"sweep": BY_RATIO, "branches": {"low": -1.0, "high": 1.0}},
            r"branches\.low.*above 0",
        ),
        ({"sweep": LINKS, "branches": {"parameter": "load"}}, r"branches\.load_min"),
    ],
)
def test_windows_that_are_none_are_told_where_branches_are_asked_for(
    mesh: Path, sections: dict[str, Any], culprit: str, tmp_path: Path
) -> None:
    with pytest.raises(SpecError, match=f"^{culprit}"):
        run_branches(spec(mesh, **sections), tmp_path / "run")
