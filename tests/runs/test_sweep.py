"""The sweep: what is on disk and when, restarts, order, interruption, units."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from eulerplateau.errors import ConflictError, MeshError, OutputError, SpecError
from eulerplateau.mesh import write_mesh
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.files import read_triangles
from eulerplateau.runs.rows import Row
from eulerplateau.runs.spec import RunSpec
from eulerplateau.runs.start import start_shape
from eulerplateau.runs.sweep import run_sweep
from eulerplateau.runs.table import read_rows
from eulerplateau.settings import validate
from eulerplateau.solvers import Problem, Status, solve
from tests.helpers import equilibria
from tests.helpers.shapes import disk_points, mesh_of

Spec = Callable[..., RunSpec]


@pytest.fixture
def coarse(tmp_path: Path) -> dict[str, Any]:
    """A stored mesh of 61 vertices, for the paper's method, which takes its time."""
    file = tmp_path / "coarse.vtp"
    points, triangles = disk_points(4, jitter=0.2)
    write_mesh(mesh_of(points * [1.5, 1.0], triangles), file)
    return {"file": str(file)}


@pytest.fixture
def spec(tmp_path: Path, oval: Disk) -> Spec:
    """A run on a stored mesh; sections as keywords."""
    file = tmp_path / "oval.vtp"
    write_mesh(oval, file)

    def make(loads: list[float], **sections: dict[str, Any]) -> RunSpec:
        data: dict[str, Any] = {"mesh": {"file": str(file)}, **sections}
        data["sweep"] = {"loads": loads, **data.get("sweep", {})}
        return validate(data, RunSpec, "test")

    return make


def rows_on_disk(folder: Path) -> list[Row]:
    return read_rows(folder / "sweep.csv")


def summary(folder: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((folder / "run.json").read_text())
    return found


def without_time(rows: list[Row]) -> list[Row]:
    return [replace(row, seconds=0.0) for row in rows]


def test_every_row_and_its_shape_are_on_disk_when_they_are_announced(
    tmp_path: Path, spec: Spec
) -> None:
    folder, seen = tmp_path / "out", []

    def look(row: Row) -> None:
        seen.append(row)
        assert rows_on_disk(folder) == seen
        assert len(list(folder.glob("shapes/*.vtp"))) == len(seen)
        assert summary(folder)["status"] == "running"

    result = run_sweep(spec([1, 500, 900]), folder, look)
    assert list(result.rows) == seen == rows_on_disk(folder)
    assert result.folder == folder
    assert result.failures == []
    assert [row.step for row in seen] == [0, 1, 2]
    assert [row.kL3_alpha for row in seen] == [1, 500, 900]
    assert all(row.converged for row in seen)


def test_run_json_says_what_was_run_and_how_it_ended(
    tmp_path: Path, spec: Spec, oval: Disk
) -> None:
    run = spec([1, 500], start={"seed": 5})
    run_sweep(run, tmp_path / "out")
    found = summary(tmp_path / "out")
    assert found["status"] == "finished"
    assert validate(found["spec"], RunSpec, "run.json") == run
    assert found["mesh"]["vertices"] == oval.n_v
    assert found["mesh"]["loop_edges_B"] == oval.n_b
    assert found["mesh"]["edges_E"] == len(oval.edges)
    assert found["seed"] == 5
    assert found["totals"]["loads"] == 2
    assert found["totals"]["not_converged"] == []
    assert set(found["blas_threads"]) == {1}
    assert found["versions"]["numpy"] == np.__version__


def test_rows_carry_the_effective_tension_and_both_energies(
    tmp_path: Path, spec: Spec
) -> None:
    for row in run_sweep(spec([1, 900]), tmp_path / "out").rows:
        assert row.sigma_hat == pytest.approx(np.sqrt(12) * row.kL3_alpha)
        assert row.energy == pytest.approx(row.film_energy + row.bending_energy)
        assert row.residual < 1e-6
        assert row.length_error < 1e-8
        assert row.n_unstable == 0


def test_up_and_down_agree_where_there_is_one_equilibrium(
    tmp_path: Path, spec: Spec
) -> None:
    run = spec([100, 300, 500], sweep={"direction": "up-down"})
    rows = run_sweep(run, tmp_path / "out").rows
    assert [row.kL3_alpha for row in rows] == [100, 300, 500, 300, 100]
    assert rows[3].energy == pytest.approx(rows[1].energy, rel=1e-10)
    assert rows[4].energy == pytest.approx(rows[0].energy, rel=1e-10)


def test_start_is_the_flat_mesh_displaced_across_its_plane_by_the_seeds_noise(
    oval: Disk, spec: Spec
) -> None:
    run = spec([1], start={"displacement": 2e-3, "seed": 3})
    x = start_shape(run, oval).x
    offset = x - oval.x
    np.testing.assert_array_equal(offset[:, :2], 0)
    assert offset[:, 2].std() == pytest.approx(2e-3, rel=0.2)
    np.testing.assert_array_equal(x, start_shape(run, oval).x)
    other = start_shape(spec([1], start={"displacement": 2e-3, "seed": 4}), oval)
    assert np.abs(other.x - x).max() > 1e-3


def test_start_is_displaced_across_the_plane_wherever_the_plane_lies(
    oval: Disk, spec: Spec
) -> None:
    tilted = replace(oval, x=oval.x[:, [2, 0, 1]])
    offset = start_shape(spec([1]), tilted).x - tilted.x
    np.testing.assert_allclose(offset[:, 1:], 0, atol=1e-15)
    assert np.abs(offset[:, 0]).max() > 1e-3


@pytest.mark.parametrize("solver", ["newton", "cg"])
def test_two_runs_give_the_same_table_but_for_the_seconds(
    tmp_path: Path, spec: Spec, coarse: dict[str, Any], solver: str
) -> None:
    run = spec([500, 900], solver={"name": solver}, mesh=coarse)
    for name in ("one", "two"):
        run_sweep(run, tmp_path / name)
    one, two = (rows_on_disk(tmp_path / name) for name in ("one", "two"))
    assert without_time(one) == without_time(two)


def test_both_solvers_sweep_through_the_same_states(tmp_path: Path, spec: Spec) -> None:
    loads = [100.0, 600.0, 900.0, 1600.0]
    newton, cg = (
        run_sweep(spec(loads, solver={"name": name}), tmp_path / name).rows
        for name in ("newton", "cg")
    )
    for one, two in zip(newton, cg, strict=True):
        assert two.converged
        assert two.energy == pytest.approx(one.energy, rel=1e-8)
        assert two.abs_kappa_n == pytest.approx(one.abs_kappa_n, rel=1e-2, abs=1e-2)


def test_interruption_leaves_a_readable_folder_that_says_so(
    tmp_path: Path, spec: Spec
) -> None:
    folder = tmp_path / "out"

    def interrupt(row: Row) -> None:
        if row.step == 1:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_sweep(spec([1, 500, 900]), folder, interrupt)
    found = summary(folder)
    assert found["status"] == "interrupted"
    assert found["totals"]["loads"] == 2
    assert [row.kL3_alpha for row in rows_on_disk(folder)] == [1, 500]
    # And the folder can be used again, for another run if that is said.
    with pytest.raises(ConflictError, match=r"sweep\.loads"):
        run_sweep(spec([1]), folder)
    assert len(rows_on_disk(folder)) == 2
    assert len(run_sweep(spec([1]), folder, overwrite=True).rows) == 1
    assert summary(folder)["status"] == "finished"
    assert len(list(folder.glob("shapes/*.vtp"))) == 1


def test_load_that_does_not_converge_is_a_row_with_its_status(
    tmp_path: Path, spec: Spec
) -> None:
    run = spec([1, 900], solver={"name": "newton", "max_iterations": 1})
    result = run_sweep(run, tmp_path / "out")
    assert [row.status for row in result.failures] == 2 * [Status.ITERATION_LIMIT]
    assert rows_on_disk(tmp_path / "out") == list(result.rows)
    assert summary(tmp_path / "out")["totals"]["not_converged"] == [0, 1]


def test_rows_do_not_depend_on_the_units_of_spring_constant_and_length(
    tmp_path: Path, spec: Spec
) -> None:
    """k L^3 / alpha alone matters: alpha = 1/2, L = 2 and k = load / 16."""
    loads = [160.0, 960.0]
    plain = run_sweep(spec(loads), tmp_path / "plain").rows
    scaled = spec(
        [load / 16 for load in loads],
        sweep={"quantity": "k"},
        loop={"alpha": 0.5, "length": 2.0},
    )
    other = run_sweep(scaled, tmp_path / "scaled").rows
    assert without_time(list(other)) == without_time(list(plain))


def test_unit_of_the_mesh_file_does_not_matter(
    tmp_path: Path, spec: Spec, oval: Disk
) -> None:
    big = tmp_path / "big.vtp"
    write_mesh(replace(oval, length=1000 * oval.length), big)
    one = run_sweep(spec([900]), tmp_path / "one").rows[0]
    two = run_sweep(spec([900], mesh={"file": str(big)}), tmp_path / "two").rows[0]
    assert two.energy == pytest.approx(one.energy, rel=1e-9)
    assert two.abs_kappa_n == pytest.approx(one.abs_kappa_n, rel=1e-6)


def test_saved_shapes_are_the_equilibria_of_their_rows(
    tmp_path: Path, spec: Spec, oval: Disk
) -> None:
    row = run_sweep(spec([900]), tmp_path / "out").rows[0]
    points, _ = read_triangles(tmp_path / "out" / "shapes" / "shape_0000.vtp")
    problem = Problem(oval)
    shape = problem.shape(points)
    film = problem.film.energy_gradient(shape, 900.0)[0]
    energy = film + problem.bending_energy(shape)[0]
    assert energy == pytest.approx(row.energy, rel=1e-12)
    assert problem.length_error(shape) < 1e-12
    again = solve(problem, 900.0, shape)
    assert equilibria.distance_up_to_motion(again.shape.x, points) < 1e-6


def test_broken_mesh_missing_mesh_and_unwritable_folder_are_told_apart(
    tmp_path: Path, spec: Spec
) -> None:
    broken = tmp_path / "broken.off"
    broken.write_text("OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n")
    with pytest.raises(MeshError):
        run_sweep(spec([1], mesh={"file": str(broken)}), tmp_path / "a")
    with pytest.raises(SpecError):
        run_sweep(spec([1], mesh={"file": str(tmp_path / "none.vtp")}), tmp_path / "b")
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(OutputError):
        run_sweep(spec([1]), tmp_path / "file" / "out")
    assert not (tmp_path / "a").exists()
