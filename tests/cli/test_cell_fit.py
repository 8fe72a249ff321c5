"""`eulerplateau cell fit`: what it reads, prints and draws, and how it refuses."""

from __future__ import annotations

import json
import subprocess
import sys
from math import pi
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from eulerplateau.cli.area_table import AreaTable, read_areas
from eulerplateau.cli.cell import cell
from eulerplateau.errors import EulerPlateauError, OutputError, SpecError
from eulerplateau.exact.cell import cell_radius, fit_areas
from tests.cli.test_startup import HEAVY, loaded_by
from tests.helpers.marks import quick_with

STIFFNESS = [0.5, 1.0, 3.0, 10.0, 30.0, 100.0]
AREA = (pi * cell_radius(STIFFNESS, 1.5, 900.0, 20.0) ** 2).round(1).tolist()
ERROR = [30.0] * 6
ROWS = "".join(f"{k},{a},{e}\n" for k, a, e in zip(STIFFNESS, AREA, ERROR, strict=True))
TWO = "".join(f"{k},{a}\n" for k, a in zip(STIFFNESS, AREA, strict=True))
TABLE = AreaTable(STIFFNESS, AREA, ERROR)


@pytest.fixture
def data(tmp_path: Path) -> Path:
    path = tmp_path / "data.csv"
    path.write_text(ROWS)
    return path


def output(*arguments: object) -> str:
    words = ["fit", *map(str, arguments)]
    result = CliRunner().invoke(cell, words, catch_exceptions=False)
    assert result.exit_code == 0
    return result.stdout


def refusal(*arguments: object) -> EulerPlateauError:
    """Return the error, which is one line."""
    result = CliRunner().invoke(cell, ["fit", *map(str, arguments)])
    assert isinstance(result.exception, EulerPlateauError)
    assert "\n" not in str(result.exception)
    assert result.stdout == ""
    return result.exception


@pytest.mark.parametrize(
    "text",
    [
        ROWS,
        "stiffness,area,error\n" + ROWS,
        "# gels\n\nStiffness (nN/um), Area [um^2], error\n" + ROWS,
        ROWS.replace("\n", "  # a comment\n"),
        ROWS.replace(",", ";"),
        ROWS.replace(",", "\t"),
        "\ufeff" + ROWS.replace("\n", "\r\n"),
        '"error","day","area","stiffness"\n'
        + "".join(f"30,mon,{a},{k}\n" for k, a in zip(STIFFNESS, AREA, strict=True)),
    ],
    ids=["bare", "names", "units", "comments", ";", "tabs", "Windows", "any order"],
)
def test_tables_are_read_however_they_are_written(tmp_path: Path, text: str) -> None:
    path = tmp_path / "data.csv"
    path.write_text(text, encoding="utf-8", newline="")
    assert read_areas(path) == TABLE


def test_errors_are_optional(data: Path) -> None:
    data.write_text(TWO)
    assert read_areas(data) == AreaTable(STIFFNESS, AREA, None)


def test_json_has_every_digit_of_the_fit(data: Path) -> None:
    found = json.loads(output(data, "--json"))
    fit = fit_areas(STIFFNESS, AREA, ERROR)
    for name in ("sigma", "alpha", "rest_radius"):
        estimate = getattr(fit, name)
        assert found[name] == {
            "value": estimate.value,
            "low": estimate.low,
            "high": estimate.high,
        }
    assert found["noise"] == {"kind": "given", "value": None}
    assert (found["chi2"], found["dof"], found["points"]) == (fit.chi2, 3, 6)
    assert (found["xi"], found["level"]) == (fit.xi, 0.95)


@pytest.mark.parametrize(
    ("options", "kind"), [([], "constant"), (["--relative"], "relative")]
)
def test_options_are_those_of_the_fit(data: Path, options: list[str], kind: str) -> None:
    data.write_text(TWO)
    words = ["--rest-radius", "20", "--level", "0.8", *options, "--json"]
    found = json.loads(output(data, *words))
    fit = fit_areas(
        STIFFNESS, AREA, rest_radius=20.0, level=0.8, relative=kind == "relative"
    )
    assert found["sigma"]["high"] == fit.sigma.high
    assert found["rest_radius"] == {"value": 20.0, "low": 20.0, "high": 20.0}
    assert found["noise"] == {"kind": kind, "value": fit.noise}
    assert found["chi2"] is None


def test_what_data_leave_open_is_null(data: Path) -> None:
    data.write_text("".join(f"{k},500,20\n" for k in STIFFNESS))
    found = json.loads(output(data, "--json"))
    assert [found["sigma"][end] for end in ("low", "high")] == [0.0, None]


def test_without_json_the_same_numbers_can_be_read(data: Path) -> None:
    fit = fit_areas(STIFFNESS, AREA, ERROR)
    lines = dict(line.split(None, 1) for line in output(data).splitlines()[1:])
    for name in ("sigma", "alpha", "rest_radius"):
        value, low, _, high = lines[name].split()
        estimate = getattr(fit, name)
        assert [float(value), float(low), float(high)] == pytest.approx(
            [estimate.value, estimate.low, estimate.high], rel=1e-4
        )
    assert float(lines["xi"].split()[0]) == pytest.approx(fit.xi, rel=1e-4)
    assert lines["points"].split()[0] == "6"


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("1,2\n2,-3\n", 2, "area -3"),
        ("# x\n0,2\n", 2, "stiffness 0"),
        ("1,2\n\n2,nan\n", 3, "area nan"),
        ("1,2\n2,inf\n", 2, "area inf"),
        ("1,2\n2,much\n", 2, "area much"),
        ("1,2\n2,\n", 2, "area empty"),
        ("1,2,3\n2,3\n", 2, "2 columns"),
        ("1,2,3,4\n", 1, "4 columns"),
        ("1\n2\n", 1, "1 columns"),
        ("stiffness,radius\n1,2\n", 1, "area"),
        ("stiffness,area,area\n1,2,2\n", 1, "area"),
        ("soft,2\n1,2\n", 1, "soft"),
    ],
)
def test_a_wrong_line_is_named_with_what_is_wrong_there(
    data: Path, text: str, line: int, words: str
) -> None:
    data.write_text(text)
    error = refusal(data)
    assert isinstance(error, SpecError)
    assert str(error).startswith(f"{data}, line {line}: ")
    assert words in str(error)
    assert "should" in str(error)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "no data"),
        ("stiffness,area\n", "points"),
        ("1,2\n2,3\n3,4\n", "need 4"),
        ("1,2,1\n2,3,1\n", "need 3"),
        ("2,3\n2,4\n2,5\n2,6\n", "different"),
    ],
)
def test_data_too_few_to_fit_are_refused(data: Path, text: str, words: str) -> None:
    data.write_text(text)
    error = refusal(data)
    assert isinstance(error, SpecError)
    assert str(error).startswith(f"{data}: ")
    assert words in str(error)


@pytest.mark.parametrize(
    ("option", "value"), [("--rest-radius", "-1"), ("--level", "1"), ("--level", "nan")]
)
def test_wrong_options_are_named(data: Path, option: str, value: str) -> None:
    error = refusal(data, option, value)
    assert isinstance(error, SpecError)
    assert error.key == option


def test_relative_noise_and_errors_exclude_each_other(data: Path) -> None:
    assert isinstance(refusal(data, "--relative"), SpecError)


def test_files_that_cannot_be_read_are_told_from_wrong_ones(tmp_path: Path) -> None:
    assert isinstance(refusal(tmp_path / "none.csv"), SpecError)
    assert isinstance(refusal(tmp_path), OutputError)
    (tmp_path / "binary.csv").write_bytes(b"\xff\xfe\x00")
    assert isinstance(refusal(tmp_path / "binary.csv"), SpecError)


@pytest.mark.parametrize(
    ("words", "code"),
    quick_with(
        [(["data.csv", "--level"], 2)],
        [(["none.csv"], 2), (["."], 5), (["data.csv", "--level"], 2)],
    ),
)
def test_a_shell_sees_the_exit_code_and_no_traceback(
    data: Path, words: list[str], code: int
) -> None:
    command = [sys.executable, "-m", "eulerplateau", "cell", "fit", *words]
    result = subprocess.run(
        command, cwd=data.parent, capture_output=True, text=True, check=False
    )
    assert result.returncode == code
    assert "Traceback" not in result.stderr


@pytest.mark.parametrize(
    "text", [ROWS, pytest.param(TWO, marks=pytest.mark.slow)], ids=["errors", "no errors"]
)
def test_figure_shows_something_and_keeps_clear_of_its_edges(
    data: Path, tmp_path: Path, text: str
) -> None:
    from matplotlib.image import imread

    data.write_text(text)
    output(data, "--out", tmp_path / "fit.png")
    image = imread(tmp_path / "fit.png")[..., :3]
    assert image.std() > 0.05
    edges = [image[:2], image[-2:], image[:, :2], image[:, -2:]]
    assert all(np.all(edge == 1) for edge in edges)


def test_figures_that_cannot_be_drawn_are_refused(data: Path, tmp_path: Path) -> None:
    result = CliRunner().invoke(
        cell, ["fit", str(data), "--out", str(tmp_path / "fit.txt")]
    )
    assert result.exit_code == 2
    result = CliRunner().invoke(
        cell, ["fit", str(data), "--out", str(tmp_path / "none" / "fit.png")]
    )
    assert isinstance(result.exception, OutputError)


def test_help_loads_no_numerical_library() -> None:
    for words in (("cell", "--help"), ("cell", "fit", "--help")):
        assert not loaded_by(*words) & (HEAVY | {"numpy", "scipy", "numba"})
