"""Arithmetic of scripts/error_vs_time, on data whose answer is known."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread

from scripts.studies.error_vs_time.arithmetic import (
    fitted_order,
    pareto,
    richardson,
    seconds_to,
)
from scripts.studies.error_vs_time.conformal import mesh_free, mesh_free_repeats
from scripts.studies.error_vs_time.equal_error import equal_error, pairs
from scripts.studies.error_vs_time.growth import growth
from scripts.studies.error_vs_time.ours import solvers
from scripts.studies.error_vs_time.picture import MARKERS, draw
from scripts.studies.error_vs_time.records import (
    HARMONICS,
    Measurement,
    Point,
    extrapolated,
    points,
    read_csv,
    with_errors,
    write_csv,
)
from scripts.studies.error_vs_time.report import Way, cheapest
from scripts.studies.error_vs_time.scenes import SCENES


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0, 4.0])
def test_order_of_a_power_law_is_found_exactly(order: float) -> None:
    h = np.array([0.3, 0.1, 0.05, 0.01])
    found, uncertainty = fitted_order(h, 7 * h**order)
    assert found == pytest.approx(order, rel=1e-12)
    assert uncertainty < 1e-10


def test_uncertainty_of_an_order_covers_the_scatter() -> None:
    """Of many noisy power laws, two thirds lie within one standard error."""
    rng = np.random.default_rng(0)
    h = np.geomspace(1, 1e-3, 12)
    found = [fitted_order(h, h**2 * np.exp(rng.normal(0, 0.2, 12))) for _ in range(2000)]
    order, uncertainty = np.array(found).T
    within = np.mean(np.abs(order - 2) < uncertainty)
    assert 0.60 < within < 0.74  # Student's t with 10 degrees of freedom: 0.66


def test_two_points_have_no_fitted_order() -> None:
    assert np.isnan(fitted_order([1.0, 0.5], [1.0, 0.25])).all()


@pytest.mark.parametrize("order", [1.0, 2.0, 3.3])
@pytest.mark.parametrize("count", [3, 4, 5])
def test_limit_of_a_power_law_is_found_exactly(order: float, count: int) -> None:
    h = 0.1 / 2.0 ** np.arange(count)
    limit = richardson(5 - 3 * h**order)
    assert limit.value == pytest.approx(5, rel=1e-13)
    assert limit.order == pytest.approx(order, rel=1e-8)


def test_uncertainty_of_a_limit_covers_the_next_term() -> None:
    h = 0.1 / 2.0 ** np.arange(5)
    limit = richardson(5 - 3 * h**2 + 2 * h**3)
    assert 0 < abs(limit.value - 5) < limit.uncertainty


@pytest.mark.parametrize("values", [[1.0, 2.0], [1.0, 2.0, 3.0], [1.0, 2.0, 1.0]])
def test_values_without_a_limit_are_refused(values: list[float]) -> None:
    with pytest.raises(ValueError, match="limit"):
        richardson(values)


def test_front_holds_what_nothing_beats() -> None:
    seconds = [1.0, 2.0, 3.0, 4.0, 2.5, 1.0]
    error = [1e-1, 1e-2, 1e-2, 1e-4, 1e-3, 2e-1]
    assert pareto(seconds, error).tolist() == [True, True, False, True, True, False]


def test_equal_points_are_both_on_the_front() -> None:
    assert pareto([1.0, 1.0], [1.0, 1.0]).all()


def test_every_point_is_beaten_by_a_point_of_the_front_or_on_it() -> None:
    rng = np.random.default_rng(1)
    seconds, error = rng.random(200), rng.random(200)
    front = pareto(seconds, error)
    for t, e in zip(seconds[~front], error[~front], strict=True):
        assert ((seconds[front] <= t) & (error[front] <= e)).any()


def test_time_to_an_error_is_interpolated_in_logarithms() -> None:
    """On error = 1/t^2 the answer is exact, with points that others beat or without."""
    seconds = np.array([1.0, 4.0, 20.0])
    error = seconds**-2
    worse = np.append(seconds, 30.0), np.append(error, 1.0)
    for wanted in (1.0, 0.2, 1 / 16, 0.01, 1 / 400):
        assert seconds_to(seconds, error, wanted) == pytest.approx(wanted**-0.5)
        assert seconds_to(*worse, wanted) == pytest.approx(wanted**-0.5)


def test_coarse_errors_cost_the_fastest_point_and_unreached_ones_have_no_time() -> None:
    assert seconds_to([1.0, 4.0], [0.1, 0.01], 0.5) == 1.0
    assert seconds_to([1.0, 4.0], [0.1, 0.01], 0.001) is None


SPACE = [n for n, scene in SCENES.items() if scene.exact and not scene.in_plane]
PLANE = [n for n, scene in SCENES.items() if scene.in_plane]


def measured(scene: str, solver: str, edges: int, cpu: float, value: float) -> Measurement:
    """One run of a scene; what does not matter here is nought."""
    return Measurement(
        scene=scene,
        film=SCENES[scene].film,
        solver=solver,
        mesh="uniform",
        loop_edges=edges,
        vertices=edges,
        repeat=0,
        set_up=0.0,
        solve=cpu,
        cpu=cpu,
        start_up=0.0,
        iterations=1,
        memory=1.0,
        value=value,
        gyration=1.0,
        error=float("nan"),
        shape_error=0.0,
        status="converged",
        area_error=0.0,
        bending_error=0.0,
    )


def ladder(scene: str, solver: str = "newton", pace: float = 1.0) -> list[Point]:
    """Four meshes with the error h^2 + 10 h^4, each costing pace times its edges."""
    answer = SCENES[scene].answer
    assert answer is not None
    runs = [
        measured(scene, solver, n, pace * n, answer * (1 + n**-2.0 + 10 * n**-4.0))
        for n in (36, 72, 144, 288)
    ]
    return points(with_errors(runs))


def test_two_meshes_together_cancel_the_second_order() -> None:
    both = extrapolated(ladder(SPACE[0]))
    h = [1 / p.first.loop_edges for p in both]
    assert fitted_order(h, [p.first.error for p in both])[0] == pytest.approx(4, rel=1e-4)
    assert [p.cpu for p in both] == [36 + 72, 72 + 144, 144 + 288]


def test_a_coarse_mesh_already_paid_for_is_not_charged_again() -> None:
    both = extrapolated(ladder(SPACE[0], "newton, coarse to fine"))
    assert [p.cpu for p in both] == [72, 144, 288]


def test_points_of_different_ladders_are_not_combined() -> None:
    mixed = [ladder(SPACE[0])[0], ladder(SPACE[1])[1]]
    assert extrapolated(mixed) == []


def test_cheapest_way_suffices_in_every_scene() -> None:
    """By h^2: 1e-3 needs 36 edges, 1e-4 needs 144, or 36 and 72 together."""
    known = [p for scene in SPACE for p in ladder(scene)]
    assert cheapest(known, 1e-3, in_plane=False) == (Way("newton", "uniform", 36), 36)
    assert cheapest(known, 1e-4, in_plane=False) == (
        Way("newton, extrapolated", "uniform", 72),
        108,
    )
    assert cheapest(known, 1e-12, in_plane=False) is None
    missing = [p for p in known if p.first.scene != SPACE[0]]
    assert cheapest(missing, 1e-3, in_plane=False) is None


def test_of_two_solvers_the_faster_is_chosen_and_evolver_is_none_of_ours() -> None:
    known = [
        p
        for scene in SPACE
        for solver, pace in (("newton", 2.0), ("cg", 1.0), ("evolver", 0.1))
        for p in ladder(scene, solver, pace)
    ]
    found = cheapest(known, 1e-3, in_plane=False)
    assert found == (Way("cg", "uniform", 36), 36)


def test_films_kept_in_their_plane_have_a_way_of_their_own() -> None:
    known = [p for scene in SPACE for p in ladder(scene)]
    assert cheapest(known, 1e-3, in_plane=True) is None
    for scene in PLANE:
        answer = SCENES[scene].answer
        assert answer is not None
        run = measured(scene, mesh_free(SCENES[scene]), 4, 1e-4, answer * (1 + 1e-5))
        known += points(with_errors([replace(run, mesh=HARMONICS)]))
    way = Way("tangent angle", HARMONICS, 4)
    assert cheapest(known, 1e-3, in_plane=True) == (way, 1e-4)
    assert cheapest(known, 1e-6, in_plane=True) is None


@pytest.mark.parametrize("name", [SPACE[-1], *PLANE])
def test_without_a_mesh_the_exact_film_is_found(name: str) -> None:
    scene = SCENES[name]
    assert scene.answer is not None
    records = list(mesh_free_repeats(scene, 16))
    assert {record["status"] for record in records} == {"converged"}
    assert records[0]["value"] == pytest.approx(scene.answer, rel=1e-8)
    assert records[0]["shape_error"] < 1e-6


def test_where_strands_touch_nothing_is_found_and_the_record_says_so() -> None:
    touching = replace(SCENES[PLANE[0]], load=3000.0)
    record = next(mesh_free_repeats(touching, 8))
    assert record["status"] == "stalled"
    assert np.isnan(record["value"])


def test_every_solver_of_ours_is_drawn() -> None:
    for scene in SCENES.values():
        assert {*solvers(scene), mesh_free(scene)} <= MARKERS.keys()


def test_repeats_become_their_median_and_failures_are_left_out() -> None:
    scene = SPACE[0]
    runs = [measured(scene, "newton", 36, cpu, 1.0) for cpu in (3.0, 1.0, 2.0)]
    failed = replace(measured(scene, "newton", 72, 1.0, 1.0), status="stalled")
    (point,) = points(with_errors([*runs, failed]))
    assert (point.least, point.cpu, point.most) == (1.0, 2.0, 3.0)


def test_errors_without_an_exact_answer_are_against_the_limit() -> None:
    scene = next(n for n, scene in SCENES.items() if scene.answer is None)
    runs = [
        replace(measured(scene, "newton", n, 1.0, 7 * (1 + n**-2.0)), gyration=1 - n**-2.0)
        for n in (36, 72, 144, 288)
    ]
    for run in with_errors(runs):
        assert run.error == pytest.approx(run.loop_edges**-2.0, rel=1e-6)
        assert run.shape_error == pytest.approx(run.loop_edges**-2.0, rel=1e-6)


def test_without_a_limit_the_errors_are_unknown_and_the_points_left_out() -> None:
    scene = next(n for n, scene in SCENES.items() if scene.answer is None)
    values = zip((36, 72, 144, 288), (1.0, 2.0, 1.0, 2.0), strict=True)
    runs = with_errors([measured(scene, "newton", n, 1.0, v) for n, v in values])
    assert np.isnan([run.error for run in runs]).all()
    assert points(runs) == []


def erring(solver: str, edges: int, cpu: float, **errors: float) -> Measurement:
    """A run whose energy errs by little, its parts by what is said."""
    run = replace(measured(SPACE[0], solver, edges, cpu, 1.0), error=1e-9)
    return replace(run, **errors)  # type: ignore[arg-type]


def test_at_equal_error_the_first_mesh_that_is_as_good_in_all_is_compared() -> None:
    """With Evolver's faster way; one of the three errors alone makes a mesh too coarse."""
    ours = "newton, corrected"
    runs = [
        erring("evolver", 36, 0.1, bending_error=1e-2),  # coarser than what is compared
        erring("evolver", 72, 3.0, bending_error=1e-3, area_error=1e-4),
        erring("evolver, coarse to fine", 72, 2.0, bending_error=1e-3, area_error=1e-4),
        erring(ours, 24, 0.2, area_error=1e-2),
        erring(ours, 30, 0.4, area_error=1e-6, shape_error=1e-3),
        erring(ours, 36, 0.3, area_error=1e-6),
        erring("newton", 72, 0.1, bending_error=1e-5),  # not what is compared
    ]
    [pair] = pairs(points(runs))
    assert (pair.theirs.cpu, pair.ours.first.loop_edges) == (2.0, 30)
    assert pair.ratio == pytest.approx(5.0)
    table = equal_error({SPACE[0]: points(runs)})
    assert table[-2].endswith("| 5 |")
    assert equal_error({SPACE[0]: points(runs[:3])}) == []


def test_growth_is_the_power_of_a_power_law() -> None:
    """In vertices on uniform meshes, in loop edges on graded ones, from 72 of them on."""
    sizes = [(n, 10 * n**3) for n in (36, 72, 144, 288)]
    runs = [
        replace(erring("newton", n, 7e-9 * size**of), vertices=vertices, mesh=mesh)
        for mesh, of in (("uniform", 1.1), ("graded", 2.1))
        for n, vertices in sizes
        for size in (vertices if mesh == "uniform" else n,)
    ]
    runs[0] = replace(runs[0], cpu=1.0)  # overhead
    found = [row.split(" | ")[3:] for row in growth(points(runs))[4:]]
    assert found == [
        [f"{10 * 72**3} to {10 * 288**3} vertices", "1.10 ± 0.00 |"],
        ["72 to 288 loop edges", "2.10 ± 0.00 |"],
    ]


def test_what_is_not_known_is_not_as_good() -> None:
    runs = [
        erring("evolver", 72, 1.0, bending_error=1e-3),
        erring("newton, corrected", 24, 1.0, area_error=float("nan")),
    ]
    assert list(pairs(points(runs))) == []


def test_every_run_is_written_and_every_scene_drawn(tmp_path: Path) -> None:
    runs = with_errors([measured(SPACE[0], "newton", n, n, 1.0 + n) for n in (36, 72)])
    write_csv(tmp_path / "runs.csv", runs)
    with (tmp_path / "runs.csv").open(encoding="ascii") as file:
        rows = list(csv.DictReader(file))
    assert [int(row["loop_edges"]) for row in rows] == [36, 72]
    assert [float(row["value"]) for row in rows] == [37.0, 73.0]
    again = read_csv(tmp_path / "runs.csv")
    assert [replace(run, error=0.0) for run in again] == [
        replace(run, error=0.0) for run in runs
    ]
    draw(tmp_path / "runs.png", runs)
    assert imread(tmp_path / "runs.png").std() > 0.05
