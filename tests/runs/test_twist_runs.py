"""Runs of a loop that resists twist: keys, columns that appear with them, going on."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from eulerplateau.errors import SpecError
from eulerplateau.loop import CurvedRod, Loop, directors
from eulerplateau.mesh import Shape, read_disk, read_vtp, write_mesh
from eulerplateau.pictures.wire import read_wire
from eulerplateau.runs import read_run, run_branches, run_sweep
from eulerplateau.runs.ensembles import load_ensemble, run_ensemble, running
from eulerplateau.runs.rows import COLUMNS
from eulerplateau.runs.spec import RunSpec
from eulerplateau.settings import validate
from tests.helpers import shapes
from tests.helpers.tasks import in_turn

TWIST = ("twist_energy", "writhe", "link", "twist_moment")


@pytest.fixture(scope="module")
def mesh(tmp_path_factory: pytest.TempPathFactory) -> Path:
    points, triangles = shapes.disk_points(5)
    path = tmp_path_factory.mktemp("mesh") / "disk.vtp"
    write_mesh(shapes.mesh_of(points * [1.6, 1.0], triangles), path)
    return path


def spec(mesh: Path, loads: list[float], **loop: float) -> RunSpec:
    said = {"mesh": {"file": str(mesh)}, "loop": loop, "sweep": {"loads": loads}}
    return validate(said, RunSpec, "run")


def test_columns_of_twist_appear_with_its_keys_only(mesh: Path, tmp_path: Path) -> None:
    run_sweep(spec(mesh, [300.0]), tmp_path / "bare")
    result = run_sweep(
        spec(mesh, [300.0, 320.0], twist_ratio=0.75, link=0.3), tmp_path / "rod"
    )
    assert (tmp_path / "bare/sweep.csv").read_text().splitlines()[0] == ",".join(COLUMNS)
    run = read_run(tmp_path / "rod")
    assert run.kind.columns == (*COLUMNS, *TWIST)
    assert run.rows == result.rows
    for row in run.rows:
        assert row.link == 0.3
        turned = 2 * np.pi * (row.link - row.writhe)
        assert row.twist_moment == pytest.approx(1.5 * turned, rel=1e-14)
        assert row.twist_energy == pytest.approx(0.75 * turned**2, rel=1e-14)
        parts = row.film_energy + row.bending_energy + row.twist_energy
        assert row.energy == pytest.approx(parts, rel=1e-14)


def test_a_sweep_with_twist_goes_on_to_the_bit(mesh: Path, tmp_path: Path) -> None:
    loop = {"twist_ratio": 0.75, "link": 0.3}
    whole = run_sweep(spec(mesh, [300.0, 320.0, 340.0], **loop), tmp_path / "whole")
    run_sweep(spec(mesh, [300.0, 320.0], **loop), tmp_path / "part")
    on = run_sweep(
        spec(mesh, [300.0, 320.0, 340.0], **loop), tmp_path / "part", resume=True
    )
    assert on.kept == 2
    assert [row.energy for row in on.rows] == [row.energy for row in whole.rows]
    assert on.rows[-1].writhe == whole.rows[-1].writhe


@pytest.mark.slow
def test_branches_of_a_turned_loop_say_nothing_of_mirrors(
    mesh: Path, tmp_path: Path
) -> None:
    window = {"branches": {"load_min": 300.0, "load_max": 1500.0, "special_points": 0}}
    said = {
        "mesh": {"file": str(mesh)},
        "loop": {"twist_ratio": 0.75, "link": 0.0},
        "sweep": {"loads": [300.0]},
        **window,
    }
    flat = run_branches(validate(said, RunSpec, "run"), tmp_path / "flat")
    assert any("mirror" in point["breaks"] for point in flat.special)
    said["loop"] = {"twist_ratio": 0.75, "link": 0.3}
    turned = run_branches(validate(said, RunSpec, "run"), tmp_path / "turned")
    assert {row.link for row in turned.rows} == {0.3}
    told = "".join(point["breaks"] + point["keeps"] for point in turned.special)
    assert "mirror" not in told
    assert "inversion" not in told


def test_an_ensemble_over_link_joins_in_one_table(
    mesh: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By this process; tests/runs/test_contact_runs.py has one carried out by workers."""
    monkeypatch.setattr(running, "in_workers", in_turn)
    (tmp_path / "e.toml").write_text(
        f'[mesh]\nfile = "{mesh}"\n[loop]\ntwist_ratio = 0.75\n'
        "[sweep]\nloads = [300]\n[grid]\nloop.link = [0.0, 0.2]\n"
    )
    result = run_ensemble(load_ensemble(tmp_path / "e.toml"), tmp_path / "out")
    assert {"loop.link", *TWIST} <= set(result.table.columns)
    assert [line["link"] for line in result.table.lines] == [0.0, 0.2]


def test_turns_without_a_rigidity_are_refused(mesh: Path) -> None:
    with pytest.raises(SpecError, match=r"loop\.link.*twist_ratio"):
        spec(mesh, [300.0], link=1.0)
    with pytest.raises(SpecError, match="twist_ratio"):
        spec(mesh, [300.0], twist_ratio=-1.0)


def test_shapes_say_which_way_the_rod_points_and_renders_mark_it(
    mesh: Path, tmp_path: Path
) -> None:
    run_sweep(spec(mesh, [300.0], twist_ratio=0.75, link=0.3), tmp_path / "rod")
    run = read_run(tmp_path / "rod")
    stored = read_vtp(run.shape_path(run.rows[0]))
    loop = stored.lines[0][:-1]
    director = stored.point_fields["director"]
    assert np.isnan(np.delete(director, loop, axis=0)).all()
    expected = directors(stored.points[loop], 0.3 - run.rows[0].writhe)
    np.testing.assert_allclose(director[loop], expected, atol=1e-12)
    turn = Rotation.from_rotvec([0.3, -0.4, 1.1])
    shape = Shape(2 * turn.apply(stored.points) + [1, 2, 3], stored.triangles, loop)
    marks = read_wire(run.shape_path(run.rows[0]), shape).marks
    assert marks is not None
    np.testing.assert_allclose(marks, turn.apply(director[loop]), atol=1e-9)
    run_sweep(spec(mesh, [300.0]), tmp_path / "bare")
    bare = read_run(tmp_path / "bare")
    assert read_wire(bare.shape_path(bare.rows[0]), shape).marks is None


CURVED = {"twist_ratio": 0.75, "link": 0.3, "rest_curvature": 0.5}


def test_a_rod_that_is_curved_by_nature_says_so_in_rows_and_shapes(
    mesh: Path, tmp_path: Path
) -> None:
    run_sweep(spec(mesh, [300.0, 320.0], **CURVED), tmp_path / "rod")
    run = read_run(tmp_path / "rod")
    assert run.kind.columns == (*COLUMNS, *TWIST, "rest_curvature")
    lengths = read_disk(mesh).rest_lengths
    for row in run.rows:
        assert row.rest_curvature == 0.5
        stored = read_vtp(run.shape_path(row))
        x = stored.points[stored.lines[0][:-1]]
        rod = CurvedRod(Loop(lengths), 0.75, 0.3, 0.5)
        assert row.writhe == pytest.approx(0.3 - rod.frame(x).turns, abs=1e-12)
        assert row.twist_energy == pytest.approx(rod.twist_energy(x), rel=1e-9)
        assert row.twist_moment == pytest.approx(rod.moment(x), rel=1e-9)
        own = row.energy - row.film_energy - row.bending_energy
        assert own == pytest.approx(rod.energy(x), rel=1e-9)
        director = stored.point_fields["director"][stored.lines[0][:-1]]
        np.testing.assert_allclose(director, rod.frame(x).directors, atol=1e-9)


def test_such_sweeps_go_on_to_the_bit(mesh: Path, tmp_path: Path) -> None:
    loads = [300.0, 320.0, 340.0]
    whole = run_sweep(spec(mesh, loads, **CURVED), tmp_path / "whole")
    run_sweep(spec(mesh, loads[:2], **CURVED), tmp_path / "part")
    on = run_sweep(spec(mesh, loads, **CURVED), tmp_path / "part", resume=True)
    assert on.kept == 2
    assert [row.energy for row in on.rows] == [row.energy for row in whole.rows]
    assert on.rows[-1].twist_moment == whole.rows[-1].twist_moment


def test_a_natural_curvature_of_nought_is_none(mesh: Path, tmp_path: Path) -> None:
    loop = {"twist_ratio": 0.75, "link": 0.3}
    run_sweep(spec(mesh, [300.0], **loop), tmp_path / "none")
    run_sweep(spec(mesh, [300.0], **loop, rest_curvature=0.0), tmp_path / "nought")
    none, nought = (read_run(tmp_path / name) for name in ("none", "nought"))
    assert nought.kind is none.kind
    assert nought.rows[0].energy == none.rows[0].energy


@pytest.mark.slow
def test_branches_of_a_curved_rod_find_where_its_film_leaves_the_plane(
    mesh: Path, tmp_path: Path
) -> None:
    said = {
        "mesh": {"file": str(mesh)},
        "loop": {"twist_ratio": 0.75, "rest_curvature": 0.5},
        "sweep": {"loads": [300.0]},
        "branches": {"load_min": 300.0, "load_max": 1200.0, "special_points": 0},
    }
    result = run_branches(validate(said, RunSpec, "run"), tmp_path / "curved")
    assert {row.rest_curvature for row in result.rows} == {0.5}
    assert any("mirror" in point["breaks"] for point in result.special)


def test_natural_curvature_without_a_rigidity_or_in_a_plane_is_refused(mesh: Path) -> None:
    with pytest.raises(SpecError, match=r"loop\.rest_curvature.*twist_ratio"):
        spec(mesh, [300.0], rest_curvature=1.0)
    with pytest.raises(SpecError, match="rest_curvature"):
        spec(mesh, [300.0], twist_ratio=1.0, rest_curvature=-1.0)
    said = {
        "mesh": {"file": str(mesh)},
        "film": {"model": "area", "plane": True},
        "loop": {"twist_ratio": 0.75, "rest_curvature": 0.5},
        "sweep": {"loads": [300.0]},
    }
    with pytest.raises(SpecError, match=r"film\.plane.*rest_curvature"):
        validate(said, RunSpec, "run")
