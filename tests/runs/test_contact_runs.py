"""Runs of a loop with a diameter: keys, columns, contacts in the shapes, going on."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from eulerplateau.errors import SpecError
from eulerplateau.loop import strands_of
from eulerplateau.mesh import Shape, read_disk, read_vtp, write_mesh
from eulerplateau.pictures import draw_branches, draw_catalogue
from eulerplateau.pictures.gallery.collection import collect
from eulerplateau.pictures.gallery.document import page
from eulerplateau.pictures.wire import read_wire
from eulerplateau.runs import (
    Asked,
    read_catalogue,
    read_run,
    run_branches,
    run_catalogue,
    run_locus,
    run_sweep,
    shape_name,
)
from eulerplateau.runs.ensembles import load_ensemble, run_ensemble
from eulerplateau.runs.rows import COLUMNS
from eulerplateau.runs.series_file import loop_name
from eulerplateau.runs.spec import RunSpec
from eulerplateau.settings import validate
from eulerplateau.solvers import Problem
from tests.helpers import shapes
from tests.helpers.command import run_here

CONTACT = (
    "contacts", "contact_force", "smallest_gap", "crossing_angle", "film_vertices",
)  # fmt: skip
THICK = 0.06
# Two lobes without contact, and the twisted eight that they snap to, in contact.
LOADS = [2600.0, 3600.0]


@pytest.fixture(scope="module")
def mesh(tmp_path_factory: pytest.TempPathFactory) -> Path:
    points, triangles = shapes.disk_points(6)
    path = tmp_path_factory.mktemp("mesh") / "oval.vtp"
    write_mesh(shapes.mesh_of(points * [1.6, 1.0], triangles), path)
    return path


def spec(mesh: Path, **sections: Any) -> RunSpec:
    said = {
        "mesh": {"file": str(mesh)},
        "film": {"model": "dirichlet"},
        "loop": {"diameter": THICK},
        "sweep": {"loads": LOADS},
        **sections,
    }
    return validate(said, RunSpec, "run")


@pytest.fixture(scope="module")
def swept(mesh: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs") / "thick"
    run_sweep(spec(mesh), folder)
    return folder


def test_columns_of_contact_appear_with_their_key_only(
    mesh: Path, swept: Path, tmp_path: Path
) -> None:
    run_sweep(spec(mesh, loop={}, sweep={"loads": [100.0]}), tmp_path / "line")
    assert (tmp_path / "line/sweep.csv").read_text().splitlines()[0] == ",".join(COLUMNS)
    run = read_run(swept)
    assert run.kind.columns == (*COLUMNS, *CONTACT)
    free, touching = run.rows
    assert all(row.converged and row.n_unstable == 0 for row in run.rows)
    assert (free.contacts, free.contact_force) == (0, 0.0)
    assert (free.crossing_angle, free.smallest_gap) == (None, None)
    assert touching.contacts >= 1
    assert touching.contact_force > 0.0
    assert abs(touching.smallest_gap) < 1e-10
    assert 0.0 < touching.crossing_angle <= 90.0


def test_shapes_hold_contacts_with_their_forces(swept: Path) -> None:
    run = read_run(swept)
    free, touching = (read_vtp(run.shape_path(row)).field_data for row in run.rows)
    assert free["contact_forces"].size == free["contact_points"].size == 0
    assert touching["diameter"].tolist() == free["diameter"].tolist() == [THICK]
    points = touching["contact_points"].reshape(-1, 2, 3)
    forces = touching["contact_forces"]
    assert len(points) == len(forces) == run.rows[1].contacts
    apart = np.linalg.norm(points[:, 0] - points[:, 1], axis=1)
    np.testing.assert_allclose(apart, THICK, rtol=1e-9)
    assert forces.sum() == pytest.approx(run.rows[1].contact_force, rel=1e-12)


def test_pushes_stand_at_the_nearest_vertices_and_cancel(swept: Path) -> None:
    run = read_run(swept)
    row = run.rows[1]
    stored = read_vtp(run.shape_path(row))
    loop, pushed = stored.lines[0][:-1], stored.point_fields["contact_force"]
    assert np.isnan(np.delete(pushed, loop, axis=0)).all()
    on_loop = pushed[loop]
    np.testing.assert_allclose(on_loop.sum(axis=0), 0.0, atol=1e-10 * row.contact_force)
    places = stored.field_data["contact_points"].reshape(-1, 2, 3)
    forces = stored.field_data["contact_forces"]
    for (one, other), force in zip(places, forces, strict=True):
        nearest = np.argmin(np.linalg.norm(stored.points[loop] - one, axis=1))
        # The strand is pushed away from the other.
        np.testing.assert_allclose(on_loop[nearest], force * (one - other) / THICK)
    alone = read_vtp(swept / loop_name(row.step))
    assert np.array_equal(alone.point_fields["contact_force"], on_loop)


def test_energy_rises_with_the_diameter_by_the_force(
    mesh: Path, swept: Path, tmp_path: Path
) -> None:
    start = {"file": str(read_run(swept).shape_path(read_run(swept).rows[1]))}
    values = [THICK - 2e-4, THICK - 1e-4, THICK, THICK + 1e-4, THICK + 2e-4]
    varied = spec(
        mesh,
        film={"model": "dirichlet", "load": LOADS[1]},
        start=start,
        sweep={"parameter": "diameter", "values": values},
    )
    run_sweep(varied, tmp_path / "d")
    run = read_run(tmp_path / "d")
    assert run.kind.columns == (*COLUMNS, *CONTACT, "diameter")
    assert run.load.text == "diameter"
    assert [row.diameter for row in run.rows] == [row.load for row in run.rows] == values
    widths = [read_vtp(run.shape_path(row)).field_data["diameter"][0] for row in run.rows]
    assert widths == values
    energy = [row.energy for row in run.rows]
    slope = (8 * (energy[3] - energy[1]) - (energy[4] - energy[0])) / 1.2e-3
    assert run.rows[2].contact_force == pytest.approx(slope, rel=1e-6)
    assert run.rows[2].energy_rate == run.rows[2].contact_force
    assert energy[2] == pytest.approx(read_run(swept).rows[1].energy, rel=1e-12)


@pytest.mark.slow
def test_a_sweep_with_contact_goes_on_to_the_bit(
    mesh: Path, swept: Path, tmp_path: Path
) -> None:
    loads = {"loads": [*LOADS, 3650.0]}
    whole = run_sweep(spec(mesh, sweep=loads), tmp_path / "whole")
    run_sweep(spec(mesh), tmp_path / "part")
    on = run_sweep(spec(mesh, sweep=loads), tmp_path / "part", resume=True)
    assert on.kept == 2
    for name in CONTACT, ("energy", "residual"):
        for column in name:
            assert getattr(on.rows[2], column) == getattr(whole.rows[2], column)
    with pytest.raises(Exception, match=r"loop\.diameter"):
        run_sweep(spec(mesh, loop={"diameter": 0.05}), swept)


@pytest.mark.slow
def test_an_ensemble_over_the_diameter_joins_in_one_table(
    mesh: Path, tmp_path: Path
) -> None:
    (tmp_path / "e.toml").write_text(
        f'[mesh]\nfile = "{mesh}"\n[film]\nmodel = "dirichlet"\n'
        "[sweep]\nloads = [100]\n[grid]\nloop.diameter = [0.01, 0.02]\n"
    )
    result = run_ensemble(load_ensemble(tmp_path / "e.toml"), tmp_path / "out")
    assert {"loop.diameter", *CONTACT} <= set(result.table.columns)
    assert [line["contacts"] for line in result.table.lines] == [0, 0]


@pytest.mark.slow
def test_a_loop_that_is_too_thick_for_its_bends_says_so(mesh: Path, tmp_path: Path) -> None:
    (tmp_path / "run.toml").write_text(
        f'[mesh]\nfile = "{mesh}"\n[film]\nmodel = "area"\nplane = true\n'
        "[loop]\ndiameter = 0.1\n[sweep]\nloads = [2400, 4000]\n"
    )
    done = run_here("sweep", tmp_path / "run.toml", "--no-pictures")
    assert done.returncode == 4
    assert "too_thick" in done.stderr
    assert "a thinner one" in done.stderr
    kept, thick = read_run(tmp_path / "run").rows
    assert kept.converged
    # The curvature on its loop is beyond 2/d there, and not before.
    for row, beyond in (kept, False), (thick, True):
        kappa = read_vtp(read_run(tmp_path / "run").shape_path(row)).point_fields["kappa"]
        assert (np.nanmax(kappa) > 2 / 0.1) == beyond


@pytest.mark.parametrize(
    ("sections", "message"),
    [
        ({"loop": {"diameter": 0.2}}, r"loop\.diameter.*0\.1"),
        ({"loop": {"diameter": 0.0}}, r"loop\.diameter"),
        ({"solver": {"name": "cg"}}, r"solver\.name.*newton.*loop\.diameter"),
        (
            {"loop": {}, "sweep": {"parameter": "diameter", "values": [0.01]}},
            r"sweep\.parameter.*needs loop\.diameter",
        ),
        (
            {"sweep": {"parameter": "diameter", "values": [0.2]}},
            r"sweep\.values.*at most 0\.1",
        ),
    ],
)
def test_what_no_thick_loop_has_is_refused(
    mesh: Path, sections: dict[str, Any], message: str
) -> None:
    with pytest.raises(SpecError, match=message):
        spec(mesh, **sections)


def test_loci_are_refused_before_a_mesh_is_read(tmp_path: Path) -> None:
    thick = spec(tmp_path / "no such mesh.vtp")
    asked = Asked(tmp_path, 0, "load", None, None)
    with pytest.raises(SpecError, match=r"loop\.diameter: should be absent"):
        run_locus(thick, asked, tmp_path / "l")


@pytest.mark.slow
def test_a_catalogue_has_the_columns_and_the_shapes_their_contacts(
    mesh: Path, swept: Path, tmp_path: Path
) -> None:
    settings = {"loads": [LOADS[1]], "starts": 2, "index": 1}
    listed = run_catalogue(spec(mesh, catalogue=settings), tmp_path / "c")
    assert read_catalogue(listed.folder).rows == listed.rows
    header = (listed.folder / "catalogue.csv").read_text().splitlines()[0].split(",")
    assert tuple(header[-len(CONTACT) :]) == CONTACT
    lowest, known = listed.rows[0], read_run(swept).rows[1]
    assert lowest.first_guess == 0
    for name in "energy", "contact_force", "crossing_angle":
        assert getattr(lowest, name) == pytest.approx(getattr(known, name), rel=1e-9)
    stored = read_vtp(listed.folder / shape_name(lowest.step))
    one, other = stored.field_data["contact_points"].reshape(-1, 2, 3)[0]
    assert np.linalg.norm(one - other) == pytest.approx(THICK, rel=1e-9)
    assert stored.field_data["contact_forces"].sum() == lowest.contact_force
    assert draw_catalogue(listed.folder)


@pytest.mark.slow
def test_branches_have_the_columns_and_say_where_strands_touch(
    mesh: Path, tmp_path: Path
) -> None:
    window = {"load_min": 2880.0, "load_max": 2930.0, "special_points": 0}
    near = spec(mesh, sweep={"loads": [2600.0, 2890.0]})
    run_sweep(near, tmp_path / "free")
    free = read_run(tmp_path / "free")
    start = {"file": str(free.shape_path(free.rows[1]))}
    folder = tmp_path / "branches"
    explored = run_branches(spec(mesh, start=start, branches=window), folder)
    run = read_run(folder)
    assert list(run.rows) == list(explored.rows)
    ((number, told),) = run.special.items()
    assert (told["kind"], told["contact"]) == ("contact", "touches")
    at = next(k for k, row in enumerate(run.rows) if row.special == number)
    before, special, touching, after = run.rows[at - 1 : at + 3]
    assert [row.contacts for row in (before, special, touching, after)] == [0, 0, 1, 1]
    assert before.smallest_gap > 0 < after.contact_force
    assert abs(special.smallest_gap) < 1e-11 > abs(touching.contact_force)
    assert float(told["sigma_hat"]) == special.sigma_hat == touching.sigma_hat
    assert special.energy == pytest.approx(touching.energy, rel=1e-12)
    assert all(row.converged for row in run.rows)
    assert draw_branches(folder)


def test_modes_keep_strands_together_that_touch(
    mesh: Path, swept: Path, tmp_path: Path
) -> None:
    start = {"file": str(read_run(swept).shape_path(read_run(swept).rows[1]))}
    asked = spec(mesh, start=start, sweep={"loads": LOADS[1:]}, output={"modes": 2})
    run_sweep(asked, tmp_path / "modes")
    run = read_run(tmp_path / "modes")
    stored = read_vtp(run.shape_path(run.rows[0]))
    loop = stored.lines[0][:-1]
    strands = strands_of(Problem(read_disk(mesh), diameter=THICK).loop)
    touching, _ = strands.near(stored.points[loop], 1e-10)
    assert len(touching) == 1
    row = strands.between(stored.points[loop], touching).jacobian()[0]
    for number in range(2):
        mode = stored.point_fields[f"mode_{number}"][loop]
        assert np.linalg.norm(mode, axis=1).max() > 0.3
        assert abs(row @ mode.ravel()) < 1e-9


def test_wires_are_drawn_as_thick_as_they_are(mesh: Path, swept: Path) -> None:
    run = read_run(swept)
    path = run.shape_path(run.rows[0])
    stored = read_vtp(path)
    shape = Shape(stored.points, stored.triangles, stored.lines[0][:-1])
    assert read_wire(path, shape).radius == THICK / 2
    assert b'"radius": 0.03' in page(collect([swept]))


def test_contact_is_plotted_where_there_is_some(swept: Path, tmp_path: Path) -> None:
    out = tmp_path / "contact.svg"
    assert run_here("plot", swept, "--what", "contact", "-o", out).returncode == 0
    assert "contact force" in out.read_text()
