"""Runs of a real line in a real film: loads, lengths and tensions with units, slips."""

from __future__ import annotations

import csv
import json
import pickle
import shutil
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import simpson

from eulerplateau.errors import SpecError
from eulerplateau.mesh import write_mesh
from eulerplateau.pictures import draw_branches, draw_comparison, draw_diagram
from eulerplateau.pictures.gallery.collection import collect
from eulerplateau.pictures.gallery.document import page
from eulerplateau.runs import read_run, read_runs, run_branches, run_sweep
from eulerplateau.runs.bench_spec import RodSettings
from eulerplateau.runs.ensembles import joined, load_ensemble
from eulerplateau.runs.ensembles.cases import carry_out
from eulerplateau.runs.ensembles.folder import case_folder, case_places
from eulerplateau.runs.film_spec import FilmSettings
from eulerplateau.runs.loop_spec import LoopSettings
from eulerplateau.runs.rows import COLUMNS
from eulerplateau.runs.spec import RunSpec
from eulerplateau.runs.start import make_problem
from eulerplateau.runs.sweep_spec import SweepSettings
from eulerplateau.settings import validate
from tests.helpers import shapes
from tests.helpers.command import run_here

NYLON = {"young_modulus": "2 GPa", "diameter": "0.2 mm"}
EI = 2e9 * pi * 0.2e-3**4 / 64
LENGTHS = {
    "parameter": "length",
    "values": [{"start": "9 cm", "stop": "0.13 m", "step": "1 cm"}],
}
SOAP = {"surface_tension": "25 mN/m"}


@pytest.fixture(scope="module")
def mesh(tmp_path_factory: pytest.TempPathFactory) -> Path:
    points, triangles = shapes.disk_points(4)
    path = tmp_path_factory.mktemp("mesh") / "oval.vtp"
    write_mesh(shapes.mesh_of(points * [1.6, 1.0], triangles), path)
    return path


def spec(mesh: Path, **sections: Any) -> RunSpec:
    said = {"mesh": {"file": str(mesh)}, "rod": NYLON, "film": SOAP, **sections}
    return validate(said, RunSpec, "run")


@pytest.fixture(scope="module")
def swept(mesh: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs") / "lengths"
    run_sweep(spec(mesh, sweep=LENGTHS), folder)
    return folder


@pytest.mark.parametrize(
    ("model", "per_load"), [("springs", 2 * 3**0.5), ("dirichlet", 1.0), ("area", 1.0)]
)
def test_a_length_and_a_liquid_set_the_load(model: str, per_load: float) -> None:
    film = {"model": model, **SOAP}
    run = spec(Path("x.vtp"), film=film, sweep={"parameter": "length", "values": ["20 cm"]})
    (load,) = run.loads()
    assert load * per_load == pytest.approx(0.05 * 0.2**3 / (EI / 2), rel=1e-12)
    assert load * per_load == pytest.approx(5093, abs=1)
    liquids = {"parameter": "surface_tension", "values": ["25 mN/m"]}
    other = spec(Path("x.vtp"), film={"model": model}, loop={"length": 0.2}, sweep=liquids)
    assert other.loads() == pytest.approx([load], rel=1e-14)
    turned = {"parameter": "link", "values": [0.1]}
    loop = {"length": "200 mm", "twist_ratio": 0.7}
    held = spec(Path("x.vtp"), film=film, loop=loop, sweep=turned)
    assert held.held == pytest.approx(load, rel=1e-14)
    rigid = {"bending_rigidity": f"{EI!r} N m^2"}
    alike = spec(Path("x.vtp"), film=film, rod=rigid, sweep=LENGTHS)
    assert alike.loads() == pytest.approx(
        spec(Path("x.vtp"), film=film, sweep=LENGTHS).loads()
    )


def test_a_run_made_in_python_says_what_it_was_given() -> None:
    made = RunSpec(
        mesh={"file": "x.vtp"},
        rod=RodSettings(**NYLON),
        film=FilmSettings(**SOAP),
        loop=LoopSettings(link=0.1, twist_ratio=0.7),
        sweep=SweepSettings(parameter="length", values=["20 cm"]),
    )
    assert made.loads() == pytest.approx([5093 / (2 * 3**0.5)], rel=1e-4)
    assert pickle.loads(pickle.dumps(made)) == made


def test_units_make_no_other_run(mesh: Path, swept: Path, tmp_path: Path) -> None:
    shutil.copytree(swept, tmp_path / "run")
    plain = {"start": 0.09, "stop": 0.13, "step": 0.01}
    same = spec(
        mesh,
        rod={"young_modulus": 2e9, "diameter": 0.2e-3},
        film={"surface_tension": 0.025},
        sweep={"parameter": "length", "values": [plain]},
    )
    assert run_sweep(same, tmp_path / "run").finished


@pytest.mark.slow
def test_a_sweep_in_length_is_one_in_the_load(
    mesh: Path, swept: Path, tmp_path: Path
) -> None:
    run = read_run(swept)
    assert run.kind.columns == (*COLUMNS, "length_m")
    lengths = np.array([row.length_m for row in run.rows])
    np.testing.assert_allclose(lengths, [0.09, 0.1, 0.11, 0.12, 0.13], rtol=1e-14)
    for row in run.rows:
        assert row.sigma_hat == pytest.approx(0.05 * row.length_m**3 / (EI / 2), rel=1e-12)
    loads = [row.kL3_alpha for row in run.rows]
    run_sweep(spec(mesh, rod=None, film={}, sweep={"loads": loads}), tmp_path / "loads")
    other = read_run(tmp_path / "loads").rows
    assert [row.energy for row in other] == [row.energy for row in run.rows]
    # In alpha / L, as all energies are: dE/dL is that by the load times 3 load / L.
    rates = [row.energy_rate for row in run.rows]
    gained = run.rows[-1].energy - run.rows[0].energy
    assert simpson(rates, x=[row.load for row in run.rows]) == pytest.approx(gained, 1e-4)
    draw_comparison(
        read_runs([swept, tmp_path / "loads"]), "diagram", tmp_path / "both.png"
    )
    assert {run.load.column for run in read_runs([swept, tmp_path / "loads"])} == {
        "sigma_hat"
    }


@pytest.mark.slow
def test_what_is_shown_speaks_the_unit_that_was_written(mesh: Path, swept: Path) -> None:
    run = read_run(swept)
    assert [row.load for row in run.rows] == pytest.approx([9, 10, 11, 12, 13], rel=1e-14)
    assert run.load.label == r"length $L/\mathrm{cm}$"
    assert [leg.name for leg in run.series] == ["length rising"]
    assert "length (cm) 9 to 13" in repr(run)
    assert draw_diagram(swept)
    assert "timestep is the load length (cm)" in (swept / "sweep.pvd").read_text()
    shown = page(collect([swept])).decode()
    data = json.loads(shown.partition('id="data"')[2].partition(">")[2].partition("<")[0])
    assert (data["load"], data["loadUnit"]) == ("length_m", "cm")
    place = data["columns"].index("length_m")
    cells = [row[place] for row in data["runs"][0]["rows"]]
    assert cells == pytest.approx([9, 10, 11, 12, 13])


def test_runs_in_several_units_are_shown_in_one(
    mesh: Path, swept: Path, tmp_path: Path
) -> None:
    few = {"parameter": "length", "values": ["95 mm", "105 mm"]}
    run_sweep(spec(mesh, sweep=few), tmp_path / "mm")
    first, second = read_runs([swept, tmp_path / "mm"])
    assert [row.load for row in second.rows] == pytest.approx([9.5, 10.5])
    assert second.load == first.load


def test_a_sweep_in_length_goes_on_to_the_bit(
    mesh: Path, swept: Path, tmp_path: Path
) -> None:
    few = {"parameter": "length", "values": ["9 cm", "10 cm"]}
    run_sweep(spec(mesh, sweep=few), tmp_path / "run")
    on = run_sweep(spec(mesh, sweep=LENGTHS), tmp_path / "run", resume=True)
    assert on.kept == 2
    assert [row.energy for row in on.rows] == [row.energy for row in read_run(swept).rows]


@pytest.mark.slow
def test_branches_in_surface_tension_find_the_bifurcation_of_the_load(
    mesh: Path, tmp_path: Path
) -> None:
    window = {"low": "20 mN/m", "high": "45 mN/m", "special_points": 0}
    liquids = {"parameter": "surface_tension", "values": [0.025]}
    run = spec(mesh, film={}, loop={"length": "14 cm"}, sweep=liquids, branches=window)
    run_branches(run, tmp_path / "gamma")
    low, high = run.window()
    plain = {"load_min": low, "load_max": high, "special_points": 0}
    loads = spec(mesh, rod=None, film={}, sweep={"loads": [low]}, branches=plain)
    run_branches(loads, tmp_path / "loads")
    points = []
    for name in ("gamma", "loads"):
        with (tmp_path / name / "special_points.csv").open(newline="") as file:
            points.append(list(csv.DictReader(file)))
    assert len(points[0]) == len(points[1]) > 0
    for own, other in zip(*points, strict=True):
        assert float(own["sigma_hat"]) == pytest.approx(float(other["sigma_hat"]), rel=1e-9)
        gamma = float(own["surface_tension_N_per_m"])
        assert float(own["sigma_hat"]) == pytest.approx(4 * gamma * 0.14**3 / EI, rel=1e-12)
        share = float(own["surface_tension_N_per_m_error"]) / gamma
        assert share == pytest.approx(
            float(own["sigma_hat_error"]) / float(own["sigma_hat"])
        )
    assert read_run(tmp_path / "gamma").load.unit == "mN/m"
    assert draw_branches(tmp_path / "gamma")


def test_the_rod_says_how_it_resists_twist(mesh: Path) -> None:
    rod = {**NYLON, "poisson_ratio": 0.4}
    run = spec(
        mesh, rod=rod, film={}, loop={"twist_ratio": "rod"}, sweep={"loads": [600.0]}
    )
    problem = make_problem(run, shapes.mesh_of(*shapes.disk_points(3)))
    assert problem.loop.parameters["twist_ratio"] == pytest.approx(1 / 1.4, rel=1e-14)


def test_the_rod_is_as_thick_as_it_is_over_its_length(mesh: Path) -> None:
    """0.2 mm in a loop of 20 cm; the load is as without thickness."""
    tensions = {"parameter": "surface_tension", "values": ["25 mN/m"]}
    loop = {"length": "20 cm", "diameter": "rod"}
    run = spec(mesh, film={}, loop=loop, sweep=tensions)
    problem = make_problem(run, shapes.mesh_of(*shapes.disk_points(3)))
    assert problem.loop.diameter == pytest.approx(1e-3, rel=1e-14)
    thin = spec(mesh, film={}, loop={"length": "20 cm"}, sweep=tensions)
    assert run.loads() == thin.loads()


def test_an_ensemble_varies_quantities_with_units(mesh: Path, tmp_path: Path) -> None:
    (tmp_path / "ensemble.toml").write_text(
        f'[mesh]\nfile = "{mesh}"\n[rod]\nyoung_modulus = "2 GPa"\ndiameter = "0.2 mm"\n'
        '[sweep]\nparameter = "length"\n'
        '[grid]\nfilm.surface_tension = ["25 mN/m", 0.03]\n'
        'sweep.values = ["9 cm", { start = "10 cm", stop = "12 cm", step = "20 mm" }]\n'
    )
    ensemble = load_ensemble(tmp_path / "ensemble.toml")
    assert len(ensemble.cases) == 2 * 3
    for case in ensemble.cases[:2]:
        assert carry_out((case, case_folder(tmp_path, case.name))).problem == ""
    table = joined(case_places(tmp_path, [case.name for case in ensemble.cases]))
    assert [line["length_m"] for line in table.lines] == pytest.approx([0.09, 0.1])


@pytest.mark.parametrize(
    ("sections", "key", "said"),
    [
        (
            {"sweep": {"loads": [1.0]}},
            "sweep.loads",
            ".rod., loop.length and film.surface_tension set already",
        ),
        ({"sweep": LENGTHS, "loop": {"length": 0.2}}, "loop.length", "leave it out"),
        ({"sweep": LENGTHS, "loop": {"alpha": 2.0}}, "loop.alpha", "leave it out"),
        ({"sweep": LENGTHS, "film": {**SOAP, "load": 3.0}}, "film.load", "leave it out"),
        ({"sweep": LENGTHS, "film": {}}, "film.surface_tension", "25 mN/m"),
        ({"sweep": LENGTHS, "rod": None}, "rod", "young_modulus"),
        (
            {"sweep": {**LENGTHS, "loads": [1.0]}},
            "sweep.loads",
            ".rod. and the length set the load",
        ),
        (
            {"sweep": {"parameter": "surface_tension", "values": ["20 mN/m"]}},
            "film.surface_tension",
            "leave it out",
        ),
        (
            {"sweep": {"parameter": "surface_tension", "values": [1.0]}, "film": {}},
            "loop.length",
            "20 cm",
        ),
        ({"sweep": {"parameter": "length", "values": ["20"]}}, "sweep.values", "20 cm"),
        ({"sweep": {"parameter": "length", "values": ["2 kg"]}}, "sweep.values", "20 cm"),
        ({"sweep": {"parameter": "length", "values": [-1.0]}}, "sweep.values", "above 0"),
        ({"sweep": {"parameter": "link", "values": ["2 m"]}}, "sweep.values", "2 m"),
        ({"sweep": LENGTHS, "rod": {**NYLON, "diameter": "2 s"}}, "rod.diameter", "0.2 mm"),
        ({"sweep": LENGTHS, "rod": {"young_modulus": "2 GPa"}}, "rod.diameter", "0.2 mm"),
        (
            {"sweep": LENGTHS, "rod": {**NYLON, "bending_rigidity": 1.0}},
            "rod.young_modulus",
            "leave one out",
        ),
        ({"sweep": LENGTHS, "loop": {"twist_ratio": "rod"}}, "rod.poisson_ratio", "0.4"),
        ({"sweep": LENGTHS, "loop": {"diameter": "rod"}}, "loop.diameter", "a number"),
        (
            {"loop": {"diameter": "rod", "length": "1 mm"}, "sweep": {"loads": [1.0]}},
            "rod.diameter",
            "at most 0.1",
        ),
        ({"sweep": LENGTHS, "loop": {"twist_ratio": "rob"}}, "loop.twist_ratio", "'rod'"),
        ({"sweep": LENGTHS, "branches": {"low": "2 mN/m"}}, "branches.low", "length"),
        ({"sweep": LENGTHS, "branches": {"low": "2 kg"}}, "branches.low", "20 cm"),
        ({"sweep": LENGTHS, "branches": {"parameter": "load"}}, "sweep.loads", "already"),
    ],
)  # fmt: skip
def test_slips_are_told_in_a_line(sections: dict[str, Any], key: str, said: str) -> None:
    with pytest.raises(SpecError, match=said) as caught:
        spec(Path("x.vtp"), **sections)
    assert caught.value.key.startswith(key)
    assert "\n" not in str(caught.value)


def test_the_command_says_where_it_is_in_the_unit_written(
    mesh: Path, tmp_path: Path
) -> None:
    (tmp_path / "run.toml").write_text(
        f'[mesh]\nfile = "{mesh}"\n[film]\nsurface_tension = "25 mN/m"\n'
        '[rod]\nyoung_modulus = "2 GPa"\ndiameter = "0.2 mm"\n'
        '[sweep]\nparameter = "length"\nvalues = ["9 cm", "10 cm"]\n'
        "[solver]\nmax_iterations = 1\n"
    )
    done = run_here("sweep", tmp_path / "run.toml", "--no-pictures")
    assert done.returncode == 4
    assert "length (cm) 10 " in done.stderr
