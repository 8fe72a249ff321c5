"""`eulerplateau branches`: what it leaves behind, how it ends, what it says."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

from eulerplateau.branches.special import BIFURCATION
from eulerplateau.errors import OutputError, SpecError
from eulerplateau.mesh import read_vtp, write_mesh
from eulerplateau.mesh.disk import Disk
from eulerplateau.runs.exploration import SPECIAL_COLUMNS, Exploration, run_branches
from eulerplateau.runs.rows import BranchRow
from eulerplateau.runs.series_file import shape_name
from eulerplateau.runs.shape_files import read_shape
from eulerplateau.runs.spec import RunSpec, load_run
from eulerplateau.runs.table import read_rows
from eulerplateau.settings import validate
from tests.helpers.command import Shell, run_here
from tests.helpers.shapes import disk_points, mesh_of

RUN = Path(__file__).parents[2] / "runs" / "elongated.toml"
# From below the onset to where the planar film is unstable: one special point.
WINDOW = {"branches.load_min": 620.0, "branches.load_max": 700.0}


def window(**more: Any) -> RunSpec:
    return load_run(RUN, {**WINDOW, **{f"branches.{key}": v for key, v in more.items()}})


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Exploration:
    return run_branches(window(special_points=1), tmp_path_factory.mktemp("run") / "out")


def test_every_point_has_its_row_and_its_shape(result: Exploration) -> None:
    rows = read_rows(result.folder / "branches.csv", BranchRow)
    assert tuple(rows) == result.rows
    assert [row.step for row in rows] == list(range(len(rows)))
    assert {row.branch for row in rows} == {0, 1, 2}
    for row in rows:
        assert row.converged
        read_shape(result.folder / shape_name(row.step))
        about = read_vtp(result.folder / shape_name(row.step)).field_data
        told = [about[name][0] for name in ("step", "kL3_alpha", "energy")]
        assert told == [row.step, row.kL3_alpha, row.energy]
    listed = listed_in(result.folder / "branches.pvd")
    assert [part for part, _ in listed] == ["0", "1"] * len(rows)


def listed_in(series: Path) -> list[tuple[str, Path]]:
    """The parts and files of a series, in their order."""
    found = ElementTree.parse(series).getroot().findall(".//DataSet")
    return [(at.attrib["part"], series.parent / at.attrib["file"]) for at in found]


def test_every_step_has_the_same_fields_and_a_loop_has_no_gaps(
    result: Exploration, elongated: Disk
) -> None:
    """ParaView lists the fields of the first step, and draws nothing where one is NaN."""
    import pyvista

    kinds: dict[str, set[tuple[str, ...]]] = {"0": set(), "1": set()}
    for part, file in listed_in(result.folder / "branches.pvd"):
        shape = pyvista.read(file)
        kinds[part].add((*shape.point_data.keys(), *shape.field_data.keys()))
        row = result.rows[int(shape.field_data["step"][0])]
        told = [shape.field_data[name][0] for name in ("branch", "n_unstable", "status")]
        assert told == [row.branch, row.n_unstable, row.status.value]
        if part == "1":
            assert (shape.n_points, shape.n_cells) == (elongated.n_b, 1)
            for name, values in shape.point_data.items():
                assert np.isfinite(values).all(), name
            film = read_vtp(result.folder / shape_name(row.step))
            np.testing.assert_array_equal(shape.points, film.points[elongated.loop])
            kappa_n = film.point_fields["kappa_n"][elongated.loop]
            np.testing.assert_array_equal(shape.point_data["kappa_n"], kappa_n)
    assert [len(found) for found in kinds.values()] == [1, 1]


def test_special_points_are_a_series_of_their_own(result: Exploration) -> None:
    (special,) = read_special(result.folder)
    listed = listed_in(result.folder / "special_points.pvd")
    shape = result.folder / shape_name(int(special["step"]))
    assert [file for part, file in listed if part == "0"] == [shape]


def test_special_points_are_rows_too(result: Exploration) -> None:
    (special,) = read_special(result.folder)
    assert tuple(special) == SPECIAL_COLUMNS
    row = result.rows[int(special["step"])]
    assert row.special == int(special["number"]) == 0
    assert row.kL3_alpha == float(special["kL3_alpha"])
    assert float(special["kL3_alpha_error"]) < 1e-8 * row.kL3_alpha
    assert row.sigma_hat == float(special["sigma_hat"])
    errors = float(special["sigma_hat_error"]), float(special["kL3_alpha_error"])
    assert errors[0] / errors[1] == pytest.approx(row.sigma_hat / row.kL3_alpha)
    assert row.branch == int(special["branch"]) == 0
    assert special["kind"] == BIFURCATION
    assert abs(float(special["eigenvalue"])) < 1e-6 * abs(result.rows[0].lowest_eigenvalue)
    assert {r.origin for r in result.rows if r.branch} == {0}


def read_special(folder: Path) -> list[dict[str, str]]:
    with (folder / "special_points.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def test_critical_mode_is_in_the_shape_of_its_special_point(
    result: Exploration, elongated: Disk
) -> None:
    """Through the whole film, and out of its plane."""
    import pyvista

    for row in result.rows:
        data = pyvista.read(result.folder / shape_name(row.step)).point_data
        mode = np.asarray(data["critical_mode"])
        assert mode.any() == (row.special is not None)
        if row.special is not None:
            assert mode.shape == (elongated.n_v, 3)
            assert np.square(mode[:, 2]).sum() > 0.999 * np.square(mode).sum()


@pytest.fixture(scope="module")
def soap(tmp_path_factory: pytest.TempPathFactory) -> Exploration:
    """A soap film's two lobes, thin triangles replaced on the way, and their twist."""
    folder = tmp_path_factory.mktemp("soap")
    points, triangles = disk_points(6)
    write_mesh(mesh_of(points * [1.3, 1.0], triangles), folder / "oval.vtp")
    data = {
        "mesh": {"file": str(folder / "oval.vtp")},
        "film": {"model": "area"},
        "sweep": {"loads": [1790.0, 2000.0]},
        "branches": {"special_points": 1},
    }
    return run_branches(validate(data, RunSpec, "test"), folder / "out")


@pytest.mark.slow
def test_film_energy_is_the_tension_times_the_area_on_disk_whatever_the_triangles(
    soap: Exploration,
) -> None:
    assert {row.branch for row in soap.rows} == {0, 1, 2}
    for branch in (0, 1, 2):
        tilings = []
        for row in (row for row in soap.rows if row.branch == branch):
            shape = read_shape(soap.folder / shape_name(row.step))
            a, b, c = (shape.x[shape.triangles[:, k]] for k in range(3))
            area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
            assert row.film_energy == pytest.approx(row.sigma_hat * area, rel=1e-12)
            assert row.area == pytest.approx(area, rel=1e-12)
            tilings.append(shape.triangles)
        if branch == 0:
            # The branch was repaired on the way.
            assert not np.array_equal(tilings[0], tilings[-1])


def test_special_point_of_a_soap_film_has_its_load_and_error_in_both_units(
    soap: Exploration,
) -> None:
    """sigma_hat = 2 sqrt(3) k L^3 / alpha, for the load and for what it is known to."""
    (special,) = read_special(soap.folder)
    for name in ("", "_error"):
        tension, springs = (
            float(special[f"{of}{name}"]) for of in ("sigma_hat", "kL3_alpha")
        )
        assert 0 < tension == pytest.approx(2 * np.sqrt(3) * springs, rel=1e-14)
    assert float(special["sigma_hat_error"]) < 1e-8 * float(special["sigma_hat"])


def test_summary_says_what_was_run(result: Exploration, elongated: Disk) -> None:
    summary = json.loads((result.folder / "run.json").read_text())
    assert summary["status"] == "finished"
    assert summary["totals"]["points"] == len(result.rows)
    assert summary["totals"]["special"] == len(result.special) == 1
    assert summary["mesh"]["sha256"] == elongated.digest
    assert summary["spec"]["branches"]["load_max"] == WINDOW["branches.load_max"]


def test_no_special_point_is_an_empty_table(tmp_path: Path) -> None:
    found = run_branches(window(load_max=650.0), tmp_path / "out")
    assert {row.branch for row in found.rows} == {0}
    assert read_special(found.folder) == []


@pytest.mark.parametrize("last", [0, 3])
def test_interrupt_leaves_what_was_found(tmp_path: Path, last: int) -> None:
    seen = []

    def stop(row: BranchRow) -> None:
        seen.append(row)
        if row.step == last:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_branches(window(), tmp_path / "out", stop)
    folder = tmp_path / "out"
    assert read_rows(folder / "branches.csv", BranchRow) == seen
    assert len(seen) == last + 1
    for row in seen:
        read_shape(folder / shape_name(row.step))
    assert json.loads((folder / "run.json").read_text())["status"] == "interrupted"
    # Another run takes the folder over if that is said.
    again = run_branches(window(special_points=0), folder, overwrite=True)
    assert tuple(read_rows(folder / "branches.csv", BranchRow)) == again.rows


def test_window_without_loads_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SpecError) as caught:
        run_branches(window(load_max=500.0), tmp_path / "out")
    assert caught.value.key == "branches.load_min"
    assert not (tmp_path / "out").exists()


def test_foreign_folder_is_refused(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("years of work")
    with pytest.raises(OutputError):
        run_branches(window(), tmp_path)
    assert {file.name for file in tmp_path.iterdir()} == {"thesis.tex"}


def command(*arguments: str, folder: Path) -> Shell:
    sets = [f"--set={key}={value}" for key, value in WINDOW.items()]
    return run_here("branches", RUN, *sets, "--out", folder, *arguments)


def test_quiet_command_draws_and_says_nothing(tmp_path: Path) -> None:
    folder = tmp_path / "out"
    done = command("--quiet", "--set=branches.special_points=1", folder=folder)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    names = {file.name for file in folder.iterdir()}
    assert names == {
        "run.json", "branches.csv", "branches.pvd", "branches.png",
        "special_points.csv", "special_points.pvd", "shapes", "loops",
    }  # fmt: skip


def test_command_reports_what_it_found_and_where(tmp_path: Path) -> None:
    folder = tmp_path / "out"
    more = "--set=branches.special_points=0"
    done = command("--no-pictures", more, folder=folder)
    assert done.returncode == 0
    assert str(folder) in done.stdout
    assert BIFURCATION in done.stdout
    assert not (folder / "branches.png").exists()


@pytest.mark.parametrize(
    "setting",
    [
        "branches.load_max=1",
        "branches.special_points=-1",
        "branches.no_such_key=1",
        "branches.load_min=[1",
        "mesh.file=no_such_file.vtp",
    ],
)
def test_bad_settings_end_with_exit_code_2_and_one_line(
    tmp_path: Path, setting: str
) -> None:
    done = command("--quiet", f"--set={setting}", folder=tmp_path / "out")
    assert done.returncode == 2
    assert len(done.stderr.strip().splitlines()) == 1
    assert not (tmp_path / "out").exists()
