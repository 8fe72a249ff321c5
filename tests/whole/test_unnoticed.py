"""Laws that small mistakes in the core once broke without a test that noticed."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from eulerplateau.exact import planar_film, relax_in_plane
from eulerplateau.mesh import Disk, mesh_polygon, write_mesh
from eulerplateau.mesh.drawing.alignment import settled
from eulerplateau.runs import RunSpec, run_branches, run_sweep
from eulerplateau.solvers import Problem, Stability, Status, solve, solving, sweep


@pytest.fixture(scope="module")
def disk(tmp_path_factory: pytest.TempPathFactory) -> tuple[Disk, str]:
    made = mesh_polygon("circle", vertices=90)
    path = tmp_path_factory.mktemp("disk") / "disk.vtp"
    write_mesh(made, path)
    return made, str(path)


def test_energies_of_a_row_are_those_of_its_columns(disk, tmp_path):
    """Area film: sigma_hat times the area; bending of a round loop: 4 pi^2."""
    spec = RunSpec(
        mesh={"file": disk[1]}, film={"model": "area"}, sweep={"loads": [200.0, 900.0]}
    )
    for row in run_sweep(spec, tmp_path / "run").rows:
        assert row.converged
        assert row.film_energy == pytest.approx(row.sigma_hat * row.area, rel=1e-12)
        assert row.bending_energy == pytest.approx(4 * np.pi**2, rel=1e-2)
        assert row.energy == pytest.approx(row.film_energy + row.bending_energy, rel=1e-14)


def test_errors_of_a_special_point_are_in_the_ratio_of_the_loads(disk, tmp_path):
    """Both columns say the same: sigma_hat = 2 sqrt(3) k L^3 / alpha."""
    spec = RunSpec(
        mesh={"file": disk[1]},
        film={"model": "area"},
        sweep={"loads": [1400.0, 1560.0]},
        branches={"special_points": 0, "unstable_modes": 2},
    )
    points = run_branches(spec, tmp_path / "run").special
    assert points
    for point in points:
        ratio = 2 * np.sqrt(3.0)
        assert point["sigma_hat"] == pytest.approx(ratio * point["kL3_alpha"], rel=1e-14)
        errors = point["sigma_hat_error"], point["kL3_alpha_error"]
        assert errors[0] == pytest.approx(ratio * errors[1], rel=1e-14)
        assert errors[0] > 0


def test_sweep_starts_from_the_last_shape_that_is_finite(disk, monkeypatch):
    """Also from one that did not converge; not from one that is not finite."""
    problem = Problem(disk[0])
    found = solve(problem, 100.0)
    ends = [Status.CONVERGED, Status.STALLED, Status.NOT_FINITE, Status.CONVERGED]
    starts = []

    def pretended(problem, load, start, tensions, limit, observe):
        place = len(starts)
        starts.append(start.x[0, 0])
        x = np.full_like(start.x, np.nan if ends[place] is Status.NOT_FINITE else place + 1)
        return replace(found, shape=start.moved(x), status=ends[place])

    monkeypatch.setattr(solving, "_named", lambda solver: pretended)
    list(sweep(problem, [1.0, 2.0, 3.0, 4.0], found))
    assert starts[1:] == [1.0, 2.0, 2.0]


def test_stability_is_blind_from_a_tenth_of_the_bare_loop_on():
    """Where rounding hides a tenth of the softest bending, 22443."""
    for bound, blind in ((2244.0, False), (2245.0, True)):
        assert Stability(np.array([1.0, 1e7]), bound).blind is blind
        assert not Stability(np.array([1e5, 1e7]), bound).blind


def test_odd_numbers_of_harmonics_converge_like_even_ones():
    """Two lobes in the plane against elliptic functions, with 4 to 9 harmonics."""
    exact = planar_film(2, 1700.0).energy
    angle = 2 * np.pi * np.arange(400) / 400
    ellipse = np.stack([1.4 * np.cos(angle), np.sin(angle)], axis=1)
    off = [
        abs(relax_in_plane(ellipse, 1700.0, m, 2).energy / exact - 1) for m in range(3, 9)
    ]
    assert all(after < 0.5 * before for before, after in pairwise(off))
    assert abs(relax_in_plane(ellipse, 1700.0, 17, 2).energy / exact - 1) < 1e-12


def test_shapes_that_follow_each_other_are_turned_and_never_mirrored(disk):
    """A film and its mirror image keep the signs of the volumes they enclose."""
    mesh, loop = disk[0], disk[0].loop
    rng = np.random.default_rng(1)
    x = mesh.x + 0.1 * rng.standard_normal(mesh.x.shape)
    shapes = np.array([x, x * [1.0, 1.0, -1.0]])

    def volumes(shapes):
        corners = (shapes - shapes.mean(axis=1, keepdims=True))[:, mesh.triangles]
        return np.linalg.det(corners).sum(axis=1)

    turned = settled(shapes, [None, 0], loop)
    np.testing.assert_allclose(volumes(turned), volumes(shapes), rtol=1e-10)
    assert volumes(shapes)[0] * volumes(shapes)[1] < 0
