"""`eulerplateau locus`: the disk's bifurcation over link and load, from its branches."""

from __future__ import annotations

import csv
import signal
from pathlib import Path

import numpy as np
import pytest

from eulerplateau import interruption
from eulerplateau.branches import LocusPoint, energy_at
from eulerplateau.errors import ConflictError
from eulerplateau.mesh import write_mesh
from eulerplateau.runs import locus as locus_runs
from tests.helpers.command import run_here
from tests.solvers.test_curved_rod import softening
from tests.solvers.test_twist import critical_link, disk

RATIO, LOAD = 0.75, 500.0
NU = LOAD / (16 * np.pi**3)


@pytest.fixture(scope="module")
def explored(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("locus")
    write_mesh(disk(24), folder / "disk.vtp")
    near = critical_link("dirichlet", NU, RATIO, 2)
    (folder / "ring.toml").write_text(
        f"""
        mesh.file = "disk.vtp"
        film = {{ model = "dirichlet", load = {LOAD} }}
        loop.twist_ratio = {RATIO}
        sweep = {{ parameter = "link", values = [{0.9 * near}, {1.05 * near}] }}
        branches = {{ special_points = 0 }}
        """
    )
    words = "branches", folder / "ring.toml", "--quiet", "--no-pictures"
    assert run_here(*words).returncode == 0
    return folder


def followed(explored: Path, *arguments: object) -> list[dict[str, str]]:
    out = explored / "curve"
    words = "locus", explored / "ring.toml", "--point", 0, "-o", out, *arguments
    done = run_here(*words, "--overwrite")
    assert done.returncode == 0, done.stderr
    assert "curve of bifurcations" in done.stdout
    assert "breaks" not in done.stdout
    assert (out / "locus.png").stat().st_size > 0
    with (out / "locus.csv").open() as file:
        return list(csv.DictReader(file))


def test_the_disk_s_bifurcation_over_link_and_load(explored: Path) -> None:
    window = "--from", 300.0, "--to", 700.0
    rows = followed(explored, "--with", "load", *window)
    loads = np.array([float(row["sigma_hat"]) for row in rows])
    links = np.array([float(row["link"]) for row in rows])
    assert loads.min() < 300
    assert loads.max() > 700
    assert {row["kind"] for row in rows} == {"bifurcation"}
    assert {row["n_unstable"] for row in rows} == {"0"}
    assert max(float(row["residual"]) for row in rows) < 1e-9
    nu = loads / (16 * np.pi**3)
    exact = [critical_link("dirichlet", each, RATIO, 2) for each in nu]
    errors = links / exact - 1
    # Of a polygon of 24 sides: all of one sign, of the size of (2 pi / 24)^2.
    assert (errors < 0).all()
    assert np.abs(errors).max() < 2 * (2 * np.pi / 24) ** 2


@pytest.mark.slow
def test_the_disk_s_threshold_over_natural_curvature(tmp_path: Path) -> None:
    """sigma_2(q) of the classical formula, from a rod that is straight by nature on."""
    q = 0.2
    write_mesh(disk(24), tmp_path / "disk.vtp")
    near = 96 * np.pi**3 * softening(2, q, RATIO)
    ends = f"load_min = {0.3 * near}, load_max = {1.2 * near}"
    (tmp_path / "ring.toml").write_text(
        f"""
        mesh.file = "disk.vtp"
        film.model = "dirichlet"
        loop = {{ twist_ratio = {RATIO}, rest_curvature = {q} }}
        sweep.loads = [{0.97 * near}, {1.02 * near}]
        branches = {{ special_points = 0, {ends} }}
        """
    )
    words = "branches", tmp_path / "ring.toml", "--quiet", "--no-pictures"
    assert run_here(*words).returncode == 0
    window = "--from", 0.05, "--to", 0.8
    rows = followed(tmp_path, "--with", "loop.rest_curvature", *window)
    loads = np.array([float(row["sigma_hat"]) for row in rows])
    curvatures = np.array([float(row["rest_curvature"]) for row in rows])
    assert curvatures.min() < 0.05
    assert curvatures.max() > 0.8
    exact = 96 * np.pi**3 * softening(2, curvatures, RATIO)
    # Of a polygon of 24 sides.
    np.testing.assert_allclose(loads, exact, rtol=(2 * np.pi / 24) ** 2)


@pytest.mark.slow
def test_ctrl_c_leaves_the_points_so_far(
    explored: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out, seen = explored / "broken-off", []

    def interrupted(point: LocusPoint) -> float:
        seen.append(point)
        if len(seen) == 4:
            patched.setattr(interruption._noted, "number", signal.SIGINT)
        return energy_at(point)

    words = "locus", explored / "ring.toml", "--point", 0, "--with", "load", "-o", out
    with monkeypatch.context() as patched:
        patched.setattr(locus_runs, "energy_at", interrupted)
        done = run_here(*words)
    assert done.returncode == 130
    assert f"interrupted: {out}: 4 points" in done.stderr
    with (out / "locus.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [float(row["sigma_hat"]) for row in rows] == [p.values[1] for p in seen]
    assert all(None not in row.values() for row in rows)
    # It is a curve as others are, in whose place another one comes only if asked to.
    assert run_here(*words).returncode == ConflictError.exit_code
    assert run_here(*words, "--to", 510, "--overwrite").returncode == 0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--point", 7, "--with", "load"), "found 7"),
        (("--point", 0, "--with", "loop.link"), "vary already"),
        (("--point", 0, "--with", "loop.rest_curvature"), "loop.rest_curvature is given"),
        (("--point", 0, "--with", "load", "--from", 900), "does not hold 500"),
        (("--point", 0, "--with", "load", "--branches", "nowhere"), "nowhere"),
    ],
)
def test_slips_are_told_in_a_line(
    explored: Path, arguments: tuple[object, ...], words: str
) -> None:
    out = explored / "slips"
    done = run_here("locus", explored / "ring.toml", "-o", out, *arguments)
    assert done.returncode in (2, 5)
    assert words in done.stderr
    assert done.stderr.count("\n") == 1
