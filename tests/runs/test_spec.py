"""Run specifications: every mistake names its key, and the loads come out in order."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from eulerplateau.errors import EulerPlateauError, OutputError, SpecError
from eulerplateau.runs.cell_spec import load_cell_run
from eulerplateau.runs.ensembles import load_ensemble
from eulerplateau.runs.spec import RunSpec, StoredMesh, load_run
from eulerplateau.solvers.equilibrium import Status

GOOD = """
[mesh]
file = "mesh.vtp"

[sweep]
loads = [1, 2.5]
"""


def read(tmp_path: Path, text: str, **overrides: Any) -> RunSpec:
    path = tmp_path / "run.toml"
    path.write_text(text)
    return load_run(path, {key.replace("__", "."): v for key, v in overrides.items()})


def sweep(tmp_path: Path, text: str) -> RunSpec:
    return read(tmp_path, f'[mesh]\nfile = "mesh.vtp"\n[sweep]\n{text}\n')


def key_of_mistake(tmp_path: Path, text: str, **overrides: Any) -> str:
    with pytest.raises(SpecError) as caught:
        read(tmp_path, text, **overrides)
    assert caught.value.exit_code == 2
    assert "\n" not in str(caught.value)
    assert str(caught.value).startswith(caught.value.key)
    return caught.value.key


@pytest.mark.parametrize(
    ("wrong", "key"),
    [
        ("[solvers]\nname = 'cg'", "solvers"),
        ("[solver]\nnmae = 'cg'", "solver.nmae"),
        ("[solver]\nname = 'simplex'", "solver.name"),
        ("[solver]\nname = 3", "solver.name"),
        ("[solver]\nmax_iterations = 0", "solver.max_iterations"),
        ("[solver]\nmax_iterations = 2.5", "solver.max_iterations"),
        ("[solver]\nmax_iterations = '9'", "solver.max_iterations"),
        ("[loop]\nalpha = 0", "loop.alpha"),
        ("[loop]\nalpha = -1.0", "loop.alpha"),
        ("[loop]\nalpha = nan", "loop.alpha"),
        ("[loop]\nalpha = inf", "loop.alpha"),
        ("[loop]\nalpha = '1'", "loop.alpha"),
        ("[loop]\nalpha = true", "loop.alpha"),
        ("[loop]\nlength = 0", "loop.length"),
        ("[loop]\nlength = -2", "loop.length"),
        ("[film]\nmodel = 'rubber'", "film.model"),
        ("[start]\ndisplacement = -1e-3", "start.displacement"),
        ("[start]\ndisplacement = nan", "start.displacement"),
        ("[start]\nseed = -1", "start.seed"),
        ("[start]\nseed = 1.5", "start.seed"),
        ("solver = 'cg'", "solver"),
    ],
)
def test_mistake_in_a_section_names_its_key(tmp_path: Path, wrong: str, key: str) -> None:
    text = f"{wrong}\n{GOOD}" if "[" not in wrong else f"{GOOD}\n{wrong}"
    assert key_of_mistake(tmp_path, text) == key


@pytest.mark.parametrize(
    ("wrong", "key"),
    [
        ("loads = []", "sweep.loads"),
        ("loads = 3", "sweep.loads"),
        ("loads = [1, -2.0]", "sweep.loads"),
        ("loads = [1, nan]", "sweep.loads[1]"),
        ("loads = [1, inf]", "sweep.loads[1]"),
        ("loads = [1, 'two']", "sweep.loads[1]"),
        ("loads = [1, true]", "sweep.loads[1]"),
        ("loads = [{start = 5, stop = 1, step = 1}]", "sweep.loads[0].stop"),
        ("loads = [{start = 1, stop = 5, step = 0}]", "sweep.loads[0].step"),
        ("loads = [{start = 1, stop = 5, step = -1}]", "sweep.loads[0].step"),
        ("loads = [{start = -1, stop = 5, step = 1}]", "sweep.loads[0].start"),
        ("loads = [{start = 1, stop = nan, step = 1}]", "sweep.loads[0].stop"),
        (
            "loads = [7, {onset = 0, nearest = 1e-3, farthest = 1, count = 3}]",
            "sweep.loads[1].onset",
        ),
        (
            "loads = [{onset = 5, nearest = 1e-3, farthest = 1, count = 1}]",
            "sweep.loads[0].count",
        ),
        (
            "loads = [{onset = 5, nearest = 0, farthest = 1, count = 5}]",
            "sweep.loads[0].nearest",
        ),
        ("loads = [1]\ndirection = 'sideways'", "sweep.direction"),
        ("loads = [1]\nquantity = 'sigma'", "sweep.quantity"),
        ("loads = [1]\nload = [2]", "sweep.load"),
        ("load = [2]", "sweep.load"),
        ("", "sweep.loads"),
    ],
)
def test_mistake_in_the_sweep_names_its_key(tmp_path: Path, wrong: str, key: str) -> None:
    text = f'[mesh]\nfile = "mesh.vtp"\n[sweep]\n{wrong}\n'
    assert key_of_mistake(tmp_path, text) == key


@pytest.mark.parametrize(
    ("mesh", "key"),
    [
        ("", "mesh"),
        ("[mesh]\nfile = 3", "mesh.file"),
        ("[mesh]\nfile = 'a.vtp'\nvertices = 9", "mesh.vertices"),
        (
            "[mesh]\nvertices = -4\n[mesh.polygon]\nkind = 'regular'\nsides = 6",
            "mesh.vertices",
        ),
        ("[mesh.polygon]\nkind = 'regular'\nsides = 2", "mesh.polygon.sides"),
        ("[mesh.polygon]\nkind = 'circel'", "mesh.polygon.kind"),
        (
            "[mesh.polygon]\nkind = 'corners'\npoints = [[0, 0], [1, 1], [1, 0], [0, 1]]",
            "mesh.polygon.points",
        ),
    ],
)
def test_mistake_in_the_mesh_names_its_key(tmp_path: Path, mesh: str, key: str) -> None:
    assert key_of_mistake(tmp_path, f"{mesh}\n[sweep]\nloads = [1]\n") == key


def test_loads_that_overflow_in_units_of_the_loop_are_refused(tmp_path: Path) -> None:
    text = f"{GOOD}quantity = 'k'\n[loop]\nlength = 1e150\n"
    assert key_of_mistake(tmp_path, text) == str(tmp_path / "run.toml")


def test_file_that_is_missing_or_no_toml_is_named(tmp_path: Path) -> None:
    for name, content in (("none.toml", None), ("bad.toml", "loads = [1,, 2]")):
        path = tmp_path / name
        if content is not None:
            path.write_text(content)
        with pytest.raises(SpecError) as caught:
            load_run(path, {})
        assert caught.value.key == str(path)
    with pytest.raises(SpecError) as caught:
        load_run(tmp_path, {})
    assert caught.value.key == str(tmp_path)


def test_defaults_are_the_papers_film_on_newtons_solver(tmp_path: Path) -> None:
    spec = read(tmp_path, GOOD)
    assert spec.solver.name == "newton"
    assert spec.solver.max_iterations is None
    assert spec.film.model == "springs"
    assert (spec.loop.alpha, spec.loop.length) == (1.0, 1.0)
    assert spec.start.displacement == 1e-3
    assert spec.sweep.direction == "up"


def test_mesh_file_is_looked_for_beside_the_specification(tmp_path: Path) -> None:
    spec = read(tmp_path, GOOD)
    assert isinstance(spec.mesh, StoredMesh)
    assert Path(spec.mesh.file) == tmp_path / "mesh.vtp"
    spec = read(tmp_path, GOOD, mesh__file="/elsewhere/mesh.vtp")
    assert isinstance(spec.mesh, StoredMesh)
    assert Path(spec.mesh.file) == Path("/elsewhere/mesh.vtp")


def test_overrides_replace_keys_and_make_sections(tmp_path: Path) -> None:
    spec = read(tmp_path, GOOD, solver__name="cg", start__seed=7, sweep__loads=[3])
    assert (spec.solver.name, spec.start.seed, spec.loads()) == ("cg", 7, [3.0])


@pytest.mark.parametrize(
    ("key", "value", "named"),
    [
        ("seed", 1, "seed"),
        ("start.sede", 1, "start.sede"),
        ("start.seed", "one", "start.seed"),
        ("mesh.file.name", 1, "mesh.file.name"),
        ("sweep.loads", 3, "sweep.loads"),
    ],
)
def test_mistake_in_an_override_names_its_key(
    tmp_path: Path, key: str, value: Any, named: str
) -> None:
    path = tmp_path / "run.toml"
    path.write_text(GOOD)
    with pytest.raises(SpecError) as caught:
        load_run(path, {key: value})
    assert caught.value.key == named


def test_loads_are_sorted_and_each_is_taken_once(tmp_path: Path) -> None:
    spec = sweep(tmp_path, "loads = [5, {start = 1, stop = 3, step = 1}, 2, 0.5]")
    assert spec.loads() == [0.5, 1, 2, 3, 5]


@pytest.mark.parametrize(
    ("direction", "expected"),
    [("up", [1, 2, 3]), ("down", [3, 2, 1]), ("up-down", [1, 2, 3, 2, 1])],
)
def test_direction_orders_the_loads(
    tmp_path: Path, direction: str, expected: list[float]
) -> None:
    spec = sweep(tmp_path, f"loads = [2, 3, 1]\ndirection = '{direction}'")
    assert spec.loads() == expected


@pytest.mark.parametrize(
    ("start", "stop", "step", "count"),
    [(0, 0.3, 0.1, 4), (0, 1, 0.1, 11), (1, 1, 5, 1), (50, 650, 50, 13), (0, 1, 0.3, 4)],
)
def test_range_includes_both_ends_whatever_rounding_says(
    tmp_path: Path, start: float, stop: float, step: float, count: int
) -> None:
    spec = sweep(tmp_path, f"loads = [{{start = {start}, stop = {stop}, step = {step}}}]")
    loads = spec.loads()
    assert len(loads) == count
    assert loads[0] == start
    assert stop - step < loads[-1] <= stop * (1 + 1e-12)
    np.testing.assert_allclose(np.diff(loads), step)


def test_refinement_approaches_the_onset_geometrically(tmp_path: Path) -> None:
    text = "loads = [{onset = 600, nearest = 1e-4, farthest = 1e-2, count = 5}]"
    distances = np.array(sweep(tmp_path, text).loads()) / 600 - 1
    np.testing.assert_allclose(distances, np.geomspace(1e-4, 1e-2, 5), rtol=1e-9)


def test_spring_constants_become_loads_k_length_cubed_over_alpha(tmp_path: Path) -> None:
    text = "loads = [3, 1]\nquantity = 'k'\n[loop]\nalpha = 0.5\nlength = 2"
    assert sweep(tmp_path, text).loads() == [16.0, 48.0]
    assert sweep(tmp_path, text.replace("'k'", "'kL3_alpha'")).loads() == [1.0, 3.0]


@pytest.mark.parametrize("film", ["dirichlet", "area"])
def test_tensions_become_loads_sigma_length_cubed_over_alpha(
    tmp_path: Path, film: str
) -> None:
    text = "loads = [3, 1]\nquantity = 'sigma'\n[loop]\nalpha = 0.5\nlength = 2\n[film]\n"
    text += f"model = '{film}'"
    assert sweep(tmp_path, text).loads() == [16.0, 48.0]
    for own in ("quantity = 'sigma_hat'", ""):
        assert sweep(tmp_path, text.replace("quantity = 'sigma'", own)).loads() == [1, 3]


@pytest.mark.parametrize(
    ("film", "own", "others"),
    [
        ("springs", ("k", "kL3_alpha"), ("sigma", "sigma_hat")),
        ("dirichlet", ("sigma", "sigma_hat"), ("k", "kL3_alpha")),
        ("area", ("sigma", "sigma_hat"), ("k", "kL3_alpha")),
    ],
)
def test_quantity_has_to_be_one_of_the_film(
    tmp_path: Path, film: str, own: tuple[str, ...], others: tuple[str, ...]
) -> None:
    text = f"{GOOD}\n[film]\nmodel = '{film}'\n"
    for quantity in own:
        assert read(tmp_path, text, sweep__quantity=quantity).loads() == [1, 2.5]
    for quantity in others:
        named = key_of_mistake(tmp_path, text, sweep__quantity=quantity)
        assert named == "sweep.quantity"


def test_a_run_without_a_sweep_is_told_why_branches_need_it(tmp_path: Path) -> None:
    path = tmp_path / "run.toml"
    path.write_text('mesh.file = "x.vtp"\nbranches = { load_min = 1.0, load_max = 2.0 }')
    with pytest.raises(SpecError, match="along branches too") as caught:
        load_run(path, {})
    assert caught.value.key == "sweep"


def test_shipped_runs_are_valid_and_their_meshes_exist() -> None:
    shipped = sorted((Path(__file__).parents[2] / "runs").glob("*.toml"))
    cells = [path for path in shipped if path.stem.startswith("cell")]
    assert len(cells) == 2
    for path in cells:
        assert load_cell_run(path, {}).cell.made().size > 10
    (ensemble,) = (path for path in shipped if path.stem == "ensemble")
    for case in load_ensemble(ensemble).cases:
        assert Path(case.spec.mesh.file).exists()
    for path in set(shipped) - {*cells, ensemble}:
        spec = load_run(path, {})
        assert len(spec.loads()) > 5
        assert not isinstance(spec.mesh, StoredMesh) or Path(spec.mesh.file).exists()


def test_every_error_has_the_exit_code_it_promises() -> None:
    assert SpecError("a.b", "is wrong").exit_code == 2
    assert OutputError("a", "is full").exit_code == 5
    assert issubclass(SpecError, EulerPlateauError)
    assert all(status.advice for status in Status)
