"""`eulerplateau fit`: a nylon line's outline, what is printed, and slips."""

from __future__ import annotations

import json
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from eulerplateau.exact import planar_film
from eulerplateau.exact.outline.curves import Racket
from tests.helpers.command import run_here

NYLON = ("--young", "2 GPa", "--diameter", "0.2 mm", "--unit", "mm")
EI = 2e9 * pi * 0.2e-3**4 / 64


@pytest.fixture
def nylon(tmp_path: Path) -> Path:
    """The outline, in mm, of 16 cm of a nylon line in a film of 25 mN/m."""
    load = 4 * 0.025 * 0.16**3 / EI
    points = 160 * planar_film(2, load).positions(np.arange(60) / 60)
    path = tmp_path / "outline.csv"
    lines = [f"{y!r}; {x!r}" for x, y in points.tolist()]
    path.write_text("\n".join(["y (mm); x (mm)", "# by hand", *lines, lines[0]]) + "\n")
    return path


def fitted(path: Path, *words: str) -> dict[str, Any]:
    done = run_here("fit", path, *words, "--json")
    assert (done.returncode, done.stderr) == (0, "")
    return json.loads(done.stdout)


def test_the_surface_tension_of_a_nylon_line_s_film_comes_back(nylon: Path) -> None:
    found = fitted(nylon, *NYLON)
    assert found["lobes"] == 2
    assert found["circle"] is False
    assert found["sigma_hat"]["value"] == pytest.approx(4 * 0.025 * 0.16**3 / EI, rel=1e-8)
    assert found["length"]["value"] == pytest.approx(160, rel=1e-8)
    tension = found["surface_tension"]
    assert tension["value"] == pytest.approx(0.025, rel=1e-8)
    assert tension["low"] <= 0.025 <= tension["high"]
    assert found["points"] == 60
    rigid = ("--bending-rigidity", f"{EI!r} N m^2", "--unit", "mm")
    assert fitted(nylon, *rigid)["surface_tension"]["value"] == pytest.approx(0.025)
    assert fitted(nylon)["surface_tension"] is None


def test_lines_and_a_picture(nylon: Path, tmp_path: Path) -> None:
    out = tmp_path / "fit.png"
    done = run_here("fit", nylon, *NYLON, "-o", out)
    assert done.returncode == 0
    assert "160 to 160 mm" in done.stdout
    assert "25 to 25 mN/m" in done.stdout
    assert out.stat().st_size > 10_000


@pytest.mark.slow
def test_a_circle_is_said_to_be_one(tmp_path: Path) -> None:
    path = tmp_path / "circle.csv"
    angles = np.arange(50) * 2 * pi / 50
    np.savetxt(path, 20 * np.stack([np.cos(angles), np.sin(angles)], 1))
    done = run_here("fit", path, *NYLON)
    assert done.returncode == 0
    assert "at most 1488.3" in done.stdout
    assert "cannot be told from a circle" in done.stdout
    found = fitted(path, *NYLON)
    assert found["circle"] is True
    assert found["surface_tension"]["low"] == 0
    bound = 48 * pi**3 * EI / 4 / (2 * pi * 0.02) ** 3
    assert found["surface_tension"]["high"] == pytest.approx(bound, rel=1e-4)


@pytest.mark.slow
def test_a_racket_s_head(tmp_path: Path) -> None:
    size = (EI / 0.05) ** (1 / 3) * 1e3
    points = Racket().curve(np.empty(0)).points(np.linspace(-5, 5, 60)).x
    np.savetxt(tmp_path / "racket.csv", size * points, delimiter="\t")
    found = fitted(tmp_path / "racket.csv", "--racket", *NYLON)
    assert found["elastocapillary_length"]["value"] == pytest.approx(size, rel=1e-8)
    assert found["surface_tension"]["value"] == pytest.approx(0.025, rel=1e-8)
    assert found["sigma_hat"] is None
    assert found["misfit"] is False
    done = run_here("fit", tmp_path / "racket.csv", "--racket", *NYLON)
    assert "(EI/sigma)^(1/3)" in done.stdout
    assert "of a point, rounding only" in done.stdout
    # As a film: told, and what to do.
    assert fitted(tmp_path / "racket.csv", *NYLON)["misfit"] is True
    done = run_here("fit", tmp_path / "racket.csv", *NYLON)
    assert done.returncode == 0
    assert done.stdout.splitlines()[-1].endswith("try --racket.")


@pytest.mark.slow
def test_a_film_is_told_to_be_no_racket_s_head(nylon: Path) -> None:
    assert fitted(nylon)["misfit"] is False
    assert fitted(nylon, "--racket")["misfit"] is True
    done = run_here("fit", nylon, "--racket")
    assert done.stdout.splitlines()[-1].endswith("leave out --racket.")


@pytest.mark.slow
def test_what_is_no_film_is_told_to_be_none(tmp_path: Path) -> None:
    path, angles = tmp_path / "ellipse.csv", np.arange(50) * 2 * pi / 50
    np.savetxt(path, np.stack([20 * np.cos(angles), 10 * np.sin(angles)], 1))
    done = run_here("fit", path)
    assert done.returncode == 0
    assert "hardly those of a film" in done.stdout.splitlines()[-1]


@pytest.mark.parametrize(
    ("words", "key", "said"),
    [
        (["--edge", "outer"], "--unit", "mm"),
        (["--edge", "outer", "--unit", "mm"], "--edge", "0.2 mm"),
        (["--young", "2 GPa", "--diameter", "0.2 mm"], "--unit", "mm"),
        (["--young", "2 GPa", "--unit", "mm"], "--young", "0.2 mm"),
        (["--unit", "kg"], "--unit", "mm"),
        (["--racket", "-n", "2"], "--lobes", "leave it out"),
        (["-n", "13"], "--lobes", "from 2 to 12"),
        (["--level", "95"], "--level", "between 0 and 1"),
        (["-o", "fit.gif"], "--out", ".png"),
    ],
)
def test_slips_are_told_in_a_line(
    nylon: Path, words: list[str], key: str, said: str
) -> None:
    done = run_here("fit", nylon, *words)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith(f"eulerplateau: {key}: ")
    assert said in done.stderr
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "has no data"),
        ("x,y\n", "has no points; should have lines of x, y"),
        ("x,y\n1,2\n3\n", "line 3"),
        ("1,2\n3,four\n", "line 2"),
        ("x,y\n" + "1,2\n" * 30, "1 different"),
    ],
)
def test_a_table_that_is_no_outline_is_told(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "points.csv"
    path.write_text(text)
    done = run_here("fit", path)
    assert done.returncode == 2
    assert said in done.stderr
    assert done.stderr.startswith(f"eulerplateau: {path}")
