"""`eulerplateau planar`: what it prints, its exit codes, its figures."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from eulerplateau.cli.planar import planar
from eulerplateau.errors import EulerPlateauError, OutputError, SpecError
from eulerplateau.exact.planar import LOBES, planar_film, thresholds
from eulerplateau.pictures import figure
from eulerplateau.pictures.planar import ENERGY, GALLERY


def output(*arguments: str) -> str:
    result = CliRunner().invoke(planar, arguments, catch_exceptions=False)
    assert result.exit_code == 0
    return result.stdout


def test_table_as_json_has_every_digit_of_every_threshold() -> None:
    rows = json.loads(output("table", "--json"))
    assert [row["n"] for row in rows] == list(LOBES)
    for row in rows:
        limits = thresholds(row["n"])
        assert row == {
            "n": limits.lobes,
            "sigma_buckling": limits.sigma_buckling,
            "sigma_contact": limits.sigma_contact,
            "sigma_line_contact": limits.sigma_line_contact,
        }


@pytest.mark.parametrize(
    ("load", "regime"),
    [
        ("0", "disk"),
        ("1488", "disk"),
        ("1600", "buckled"),
        ("4000", "point-contact"),
        ("1e8", "line-contact"),
    ],
)
def test_shape_as_json_in_every_regime(load: str, regime: str) -> None:
    row = json.loads(output("shape", "--n", "2", "--sigma-hat", load, "--json"))
    film = planar_film(2, float(load))
    assert row == {
        "energy": film.energy,
        "area": film.area,
        "kappa_max": film.kappa_max,
        "kappa_min": film.kappa_min,
        "beta_hat": film.beta_hat,
        "regime": regime,
    }


def test_without_json_the_same_numbers_can_be_read() -> None:
    lines = output("table").splitlines()[1:]
    for n, line in zip(LOBES, lines, strict=True):
        limits = thresholds(n)
        loads = (limits.sigma_buckling, limits.sigma_contact, limits.sigma_line_contact)
        assert [float(word) for word in line.split()] == pytest.approx(
            [n, *loads], rel=1e-13
        )
    shape = dict(
        line.split() for line in output("shape", "-n3", "--sigma-hat=5000").splitlines()
    )
    assert float(shape["energy"]) == pytest.approx(planar_film(3, 5000).energy, rel=1e-14)
    assert shape["regime"] == "buckled"


@pytest.mark.parametrize(
    ("n", "load", "key"),
    [
        ("1", "2000", "n"),
        ("13", "2000", "n"),
        ("2", "-1", "sigma_hat"),
        ("2", "nan", "sigma_hat"),
    ],
)
def test_impossible_films_are_refused(n: str, load: str, key: str) -> None:
    result = CliRunner().invoke(planar, ["shape", "--n", n, f"--sigma-hat={load}"])
    assert isinstance(result.exception, SpecError)
    assert result.exception.key == key
    assert result.exception.exit_code == 2


@pytest.mark.parametrize(
    ("load", "regime"),
    [("1000", "free"), ("1800", "free"), ("3000", "point"), ("6e3", "line")],
)
def test_with_a_diameter_the_contact_is_there_too(load: str, regime: str) -> None:
    arguments = ("shape", "--n", "2", "--sigma-hat", load, "--diameter", "0.05")
    row, film = json.loads(output(*arguments, "--json")), planar_film(2, float(load), 0.05)
    assert list(row)[-3:] == ["contact_force", "contact_length", "regime"]
    assert row.pop("regime") == regime
    assert row == {name: getattr(film, name) for name in row}
    lines = dict(line.split() for line in output(*arguments).splitlines())
    assert lines.pop("regime") == regime
    assert {name: float(value) for name, value in lines.items()} == pytest.approx(row)


def test_the_table_with_a_diameter_is_empty_where_the_loop_is_too_thick() -> None:
    rows = json.loads(output("table", "--diameter", "0.05", "--json"))
    assert (rows[0]["n"], rows[1]["sigma_line_contact"]) == (2, None)
    limits = thresholds(2, 0.05)
    assert rows[0]["sigma_contact"] == limits.sigma_contact
    assert rows[0]["sigma_line_contact"] == limits.sigma_line_contact
    assert output("table", "--diameter", "0.05").splitlines()[2].split()[-1] == "-"


@pytest.mark.parametrize("diameter", ["0", "-0.1", "0.11", "nan", "inf"])
def test_impossible_diameters_are_refused(diameter: str) -> None:
    for command in (["shape", "--n=2", "--sigma-hat=3000"], ["table"]):
        result = CliRunner().invoke(planar, [*command, f"--diameter={diameter}"])
        assert isinstance(result.exception, SpecError)
        assert result.exception.key == "diameter"


def test_a_loop_that_is_too_thick_ends_with_four() -> None:
    arguments = ["shape", "--n=2", "--sigma-hat=1e5", "--diameter=0.1", "--json"]
    result = CliRunner().invoke(planar, arguments)
    assert isinstance(result.exception, EulerPlateauError)
    assert result.exception.exit_code == 4
    assert str(result.exception).startswith("too_thick: ")
    said = json.loads(result.stdout)
    assert (said["status"], said["problem"]) == ("too_thick", str(result.exception))
    assert said["energy"] is said["regime"] is None
    assert CliRunner().invoke(planar, arguments[:-1]).stdout == ""


@pytest.mark.parametrize("arguments", [["shape", "--n", "two"], ["shape"], ["figures"]])
def test_wrong_arguments_end_with_two(arguments: list[str]) -> None:
    assert CliRunner().invoke(planar, arguments).exit_code == 2


def test_figures_show_something_and_keep_clear_of_their_edges(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from matplotlib.image import imread

    # A pixel is a quarter of a millimetre.
    monkeypatch.setattr(figure, "_DPI", 100)
    output("figures", "--out", str(tmp_path / "new" / "folder"))
    for name in (GALLERY, ENERGY):
        image = imread(tmp_path / "new" / "folder" / name)[..., :3]
        assert image.std() > 0.05
        edges = [image[0], image[-1], image[:, 0], image[:, -1]]
        assert all(np.all(edge == 1) for edge in edges)


def test_figures_that_cannot_be_written_are_an_output_error(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    result = CliRunner().invoke(planar, ["figures", "--out", str(tmp_path / "file" / "in")])
    assert isinstance(result.exception, OutputError)
