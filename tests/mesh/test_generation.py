"""From a mesh specification to a mesh: polygons, sizes, grading, repeatability."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from eulerplateau.errors import EulerPlateauError, SpecError
from eulerplateau.mesh import ALGORITHMS, MeshSpec, generate, read_disk
from eulerplateau.mesh.polygon import (
    counter_clockwise,
    ellipse,
    ellipse_perimeter,
    perimeter,
    polygon_area,
    subdivide,
)
from eulerplateau.settings import load_toml, validate
from tests.helpers.marks import quick_with

MESHES = Path(__file__).parents[2] / "meshes"
HEXAGON = {"kind": "regular", "sides": 6}
STRETCHED = {"kind": "stretched-hexagon", "factor": 2}
LENGTHENED = {"kind": "lengthened-hexagon", "half_length": 2.2}
CONCAVE = {"kind": "corners", "points": [[0, 0], [3, 0], [3, 3], [1.5, 0.5], [0, 3]]}
POLYGONS = {
    "triangle": {"kind": "regular", "sides": 3},
    "hexagon": HEXAGON,
    "stretched": STRETCHED,
    "lengthened": LENGTHENED,
    "circle": {"kind": "circle"},
    "ellipse": {"kind": "ellipse", "aspect": 2},
    "concave": CONCAVE,
}


def spec(polygon, **settings):
    return validate({"polygon": polygon, **settings}, MeshSpec, "test")


def film_area(mesh):
    a, b, c = mesh.x[mesh.triangles].transpose(1, 0, 2)
    return np.cross(b - a, c - a)[:, 2].sum() / 2 * mesh.length**2


# Polygons.

AREAS = {
    "pentagon": ({"kind": "regular", "sides": 5}, 2.5 * np.sin(2 * np.pi / 5)),
    "stretched": (STRETCHED, 3 * np.sqrt(3)),
    "lengthened": (LENGTHENED, 4 * (2.2 - 1 / np.sqrt(3)) + 2 / np.sqrt(3)),
    "circle": ({"kind": "circle", "sides": 40}, 20 * np.sin(np.pi / 20)),
    "ellipse_as_rhombus": ({"kind": "ellipse", "aspect": 3, "sides": 4}, 6.0),
    "concave": (CONCAVE, 9 - 1.5 * 2.5),
}


@pytest.mark.parametrize("name", AREAS)
def test_a_polygon_and_its_film_have_the_exact_area(name):
    polygon, exact = AREAS[name]
    wanted = spec(polygon, vertices=300)
    assert polygon_area(wanted.polygon.corners(0.1)) == pytest.approx(exact, rel=1e-14)
    assert film_area(generate(wanted)) == pytest.approx(exact, rel=1e-13)


def test_lengthened_hexagons_start_from_the_regular_one():
    chords = spec({"kind": "lengthened-hexagon", "half_length": 2 / np.sqrt(3)})
    corners = chords.polygon.corners(0.1)
    sides = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    np.testing.assert_allclose(sides, 2 / np.sqrt(3), rtol=1e-15)


@pytest.mark.parametrize("aspect", [1.0, 2.0, 50.0])
def test_corners_of_an_ellipse_lie_on_it_at_equal_arc_length(aspect):
    corners = ellipse(aspect, 4000)
    x, y = corners.T
    np.testing.assert_allclose((x / aspect) ** 2 + y**2, 1, rtol=1e-14)
    chords = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    # A chord is shorter than its arc by the arc cubed, times curvature squared over 24.
    arc = ellipse_perimeter(aspect) / 4000
    assert (chords <= arc * (1 + 1e-12)).all()
    assert (chords >= arc * (1 - (arc * aspect) ** 2 / 23)).all()


def test_a_circle_of_radius_one_is_the_ellipse_of_aspect_one():
    assert ellipse_perimeter(1.0) == pytest.approx(2 * np.pi, rel=1e-15)


@pytest.mark.parametrize("start", range(4))
def test_clockwise_corners_are_turned_round(start):
    square = np.roll([[0, 0], [1, 0], [1, 1], [0, 1]], start, axis=0)
    turned = counter_clockwise(square[::-1])
    assert polygon_area(turned) == 1
    assert turned[0].tolist() == square[-1].tolist()
    assert counter_clockwise(square).tolist() == square.tolist()


BAD_CORNERS = {
    "two": [[0, 0], [1, 0]],
    "repeated": [[0, 0], [1, 0], [1, 0], [0, 1]],
    "repeated_apart": [[0, 0], [2, 0], [1, 1], [2, 2], [0, 2], [1, 1]],
    "bow_tie": [[0, 0], [1, 1], [1, 0], [0, 1]],
    "pentagram": [[np.cos(4 * np.pi * k / 5), np.sin(4 * np.pi * k / 5)] for k in range(5)],
    "on_a_line": [[0, 0], [1, 0], [3, 0]],
    "corner_on_a_side": [[0, 0], [2, 0], [2, 2], [1, 0], [0, 2]],
    "folded_back": [[0, 0], [2, 0], [1, 0], [1, 1]],
    "spike": [[0, 0], [1, 0], [1, 2], [1, 1], [0, 1]],
    "overlapping_sides": [[0, 0], [3, 0], [3, 1], [2, 1], [2, 0], [1, 0], [1, 1], [0, 1]],
}


@pytest.mark.parametrize("unit", [1e-9, 1, 1e9])
@pytest.mark.parametrize("name", BAD_CORNERS)
def test_a_polygon_that_bounds_no_region_is_refused(name, unit):
    points = [[x * unit, y * unit] for x, y in BAD_CORNERS[name]]
    with pytest.raises(SpecError) as caught:
        spec({"kind": "corners", "points": points})
    assert caught.value.key == "polygon.points"


def test_corners_on_a_straight_side_and_parallel_sides_are_fine():
    comb = [[0, 0], [1, 0], [3, 0], [3, 2], [2, 2], [2, 1], [1, 1], [1, 2], [0, 2]]
    assert polygon_area(counter_clockwise(comb)) == 5


# Specifications.

BAD_SPECS = {
    "two_sizes": ({"polygon": HEXAGON, "vertices": 100, "edge_length": 0.1}, "edge_length"),
    "no_vertices": ({"polygon": HEXAGON, "vertices": 0}, "vertices"),
    "negative_edge": ({"polygon": HEXAGON, "edge_length": -0.1}, "edge_length"),
    "nan_edge": ({"polygon": HEXAGON, "edge_length": float("nan")}, "edge_length"),
    "grading": ({"polygon": HEXAGON, "grading": 0.5}, "grading"),
    "algorithm_number": ({"polygon": HEXAGON, "algorithm": 7}, "algorithm"),
    "algorithm_name": ({"polygon": HEXAGON, "algorithm": "frontal"}, "algorithm"),
    "algorithm_true": ({"polygon": HEXAGON, "algorithm": True}, "algorithm"),
    "sides": ({"polygon": {"kind": "regular", "sides": 2}}, "polygon.sides"),
    "factor": ({"polygon": {"kind": "stretched-hexagon", "factor": 0}}, "polygon.factor"),
    "aspect": ({"polygon": {"kind": "ellipse", "aspect": 0.5}}, "polygon.aspect"),
    "half_length": (
        {"polygon": {"kind": "lengthened-hexagon", "half_length": 0.5}},
        "polygon.half_length",
    ),
    "nan_corner": (
        {"polygon": {"kind": "corners", "points": [[0, 0], [1, 0], [0, float("nan")]]}},
        "polygon.points[2][1]",
    ),
    "no_polygon": ({"vertices": 474}, "polygon"),
}


@pytest.mark.parametrize("case", BAD_SPECS)
def test_a_bad_mesh_spec_names_its_key(case):
    data, key = BAD_SPECS[case]
    with pytest.raises(SpecError) as caught:
        validate(data, MeshSpec, "test")
    assert caught.value.key == key


@pytest.mark.parametrize(
    ("size", "key"),
    [
        ({"vertices": 10**9}, "vertices"),
        ({"edge_length": 1e-9}, "edge_length"),
        ({"edge_length": 10.0}, "edge_length"),
    ],
)
def test_a_size_that_makes_no_usable_mesh_names_its_key(size, key):
    with pytest.raises(SpecError) as caught:
        generate(spec({"kind": "regular", "sides": 3}, **size))
    assert caught.value.key == key


def test_algorithms_go_by_number_or_name():
    for name, number in ALGORITHMS.items():
        assert spec(HEXAGON, algorithm=name) == spec(HEXAGON, algorithm=number)
    assert spec(HEXAGON).algorithm == ALGORITHMS["frontal-delaunay"] == 6


# Meshes.


@pytest.mark.parametrize("grading", [1, 3])
@pytest.mark.parametrize("vertices", quick_with([150, 474], [150, 300, 474]))
@pytest.mark.parametrize("polygon", POLYGONS)
def test_the_number_of_vertices_is_met_within_two_percent(polygon, vertices, grading):
    mesh = generate(spec(POLYGONS[polygon], vertices=vertices, grading=grading))
    assert abs(mesh.n_v - vertices) <= 0.02 * vertices


# Algorithm 9 takes seconds for larger meshes.
@pytest.mark.parametrize(
    ("algorithm", "vertices"),
    [*((a, n) for a in (1, 5, 6, 8) for n in (150, 474)), (9, 150)],
)
@pytest.mark.parametrize("polygon", [HEXAGON, STRETCHED], ids=["hexagon", "stretched"])
def test_every_algorithm_meets_the_target_and_repeats_itself(polygon, algorithm, vertices):
    wanted = spec(polygon, vertices=vertices, algorithm=algorithm)
    mesh = generate(wanted)
    assert abs(mesh.n_v - vertices) <= 0.02 * vertices
    assert generate(wanted).digest == mesh.digest


@pytest.mark.slow
@pytest.mark.parametrize("grading", [1, 3])
@pytest.mark.parametrize("vertices", [1000, 2000])
@pytest.mark.parametrize("polygon", POLYGONS)
def test_larger_numbers_of_vertices_are_met(polygon, vertices, grading):
    mesh = generate(spec(POLYGONS[polygon], vertices=vertices, grading=grading))
    assert abs(mesh.n_v - vertices) <= 0.02 * vertices


@pytest.mark.slow
@pytest.mark.parametrize("vertices", [474, 1000, 2000])
@pytest.mark.parametrize("algorithm", [1, 5, 8, 9])
@pytest.mark.parametrize("polygon", [HEXAGON, STRETCHED], ids=["hexagon", "stretched"])
def test_every_algorithm_meets_larger_targets(polygon, algorithm, vertices):
    mesh = generate(spec(polygon, vertices=vertices, algorithm=algorithm))
    assert abs(mesh.n_v - vertices) <= 0.02 * vertices


def test_algorithm_8_repeats_itself_with_other_things_in_memory():
    wanted = spec(STRETCHED, edge_length=1 / 24, algorithm=8)
    random = np.random.default_rng(0)
    ballast, digests = [], set()
    for _ in range(6):
        ballast += [bytearray(size) for size in random.integers(20, 200, 2000)]
        del ballast[:: random.integers(2, 5)]
        digests.add(generate(wanted).digest)
    assert len(digests) == 1


@pytest.mark.parametrize("polygon", POLYGONS)
def test_the_loop_runs_counter_clockwise_and_evenly_along_each_side(polygon):
    wanted = spec(POLYGONS[polygon], edge_length=0.13)
    mesh = generate(wanted)
    assert mesh.loop.tolist() == list(range(mesh.n_b))
    expected = subdivide(wanted.polygon.corners(0.13), 0.13)
    placed = mesh.x[mesh.loop, :2] * mesh.length
    np.testing.assert_allclose(placed, expected - expected.mean(axis=0), atol=1e-14)
    assert mesh.length == pytest.approx(perimeter(expected), rel=1e-14)
    assert polygon_area(placed) > 0


def test_sides_of_equal_length_are_divided_alike():
    for edge_length in (1 / 12.5, np.nextafter(1 / 12.5, 1), np.nextafter(1 / 12.5, 0)):
        loop = subdivide(spec(HEXAGON).polygon.corners(0.1), edge_length)
        assert len(loop) % 6 == 0


def test_without_sides_the_edges_of_a_circle_are_its_sides():
    mesh = generate(spec({"kind": "circle"}, edge_length=0.1))
    assert mesh.n_b == 63
    np.testing.assert_allclose(mesh.rest_lengths, 1 / 63, rtol=1e-12)
    radius = np.linalg.norm(mesh.x[mesh.loop], axis=1) * mesh.length
    np.testing.assert_allclose(radius, 1, rtol=1e-12)


def test_with_sides_a_circle_keeps_its_corners():
    mesh = generate(spec({"kind": "circle", "sides": 12}, edge_length=0.1))
    radius = np.linalg.norm(mesh.x[mesh.loop], axis=1) * mesh.length
    assert np.isclose(radius, 1, rtol=1e-12).sum() == 12
    assert mesh.n_b == 60


@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_the_polygon_may_come_in_any_unit(unit):
    def scaled(factor):
        points = [[x * factor, y * factor] for x, y in CONCAVE["points"]]
        return generate(spec({"kind": "corners", "points": points}, vertices=200))

    mesh = scaled(1.0)
    assert scaled(unit).n_v == mesh.n_v
    np.testing.assert_allclose(scaled(unit).x, mesh.x, atol=1e-8)
    assert scaled(unit).length == pytest.approx(mesh.length * unit, rel=1e-13)
    assert scaled(2.0**-30).digest == mesh.digest


@pytest.mark.parametrize("grading", [2.0, 4.0])
def test_graded_edges_are_grading_times_longer_deep_inside(grading):
    # Edges grow by 0.3 per length: they are uniform within 1 - 3.3 * 3 * 0.03 = 0.7.
    mesh = generate(spec({"kind": "circle"}, edge_length=0.03, grading=grading))
    ends = mesh.x[mesh.edges] * mesh.length
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    depth = 1 - np.linalg.norm(ends.mean(axis=1), axis=1)
    inside = np.median(lengths[depth > 0.5])
    beside = np.median(lengths[depth < 0.03])
    assert inside == pytest.approx(0.03 * grading, rel=0.15)
    assert beside == pytest.approx(0.03, rel=0.15)
    uniform = generate(spec({"kind": "circle"}, edge_length=0.03))
    assert mesh.n_v < uniform.n_v / grading


def test_meshes_are_well_shaped():
    mesh = generate(spec(STRETCHED))
    a, b, c = mesh.x[mesh.triangles].transpose(1, 0, 2)
    sides = [np.linalg.norm(q - p, axis=1) for p, q in ((a, b), (b, c), (c, a))]
    twice = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    quality = 2 * np.sqrt(3) * twice / (sides[0] ** 2 + sides[1] ** 2 + sides[2] ** 2)
    assert quality.min() > 0.6
    assert quality.mean() > 0.95


def test_no_other_process_state_or_file_of_the_user_matters(tmp_path):
    (tmp_path / ".gmshrc").write_text("Mesh.Algorithm = 5; Mesh.MeshSizeFactor = 2;\n")
    code = (
        "from eulerplateau.mesh import read_disk;"
        f"import sys; sys.stdout.write(read_disk({str(MESHES / 'hexagon.toml')!r}).digest)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        env={"HOME": str(tmp_path), "PYTHONPATH": str(MESHES.parent)},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout == read_disk(MESHES / "hexagon.toml").digest


def test_a_machine_without_the_display_libraries_is_told_what_to_install(monkeypatch):
    class Broken:
        @staticmethod
        def find_spec(name, path=None, target=None):
            if name == "gmsh":
                raise OSError("libGLU.so.1: cannot open shared object file")

    monkeypatch.delitem(sys.modules, "gmsh", raising=False)
    monkeypatch.setattr(sys, "meta_path", [Broken, *sys.meta_path])
    with pytest.raises(EulerPlateauError) as caught:
        generate(spec(HEXAGON))
    assert caught.value.exit_code == 1


# The meshes that come with the project.


@pytest.mark.parametrize("path", sorted(MESHES.glob("*.toml")), ids=lambda path: path.stem)
def test_shipped_specs_give_the_papers_size(path):
    assert abs(generate(load_toml(path, MeshSpec)).n_v - 474) <= 0.02 * 474
