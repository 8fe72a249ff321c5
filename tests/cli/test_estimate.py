"""`eulerplateau estimate`: loads of real loops, lengths at which they change, slips."""

from __future__ import annotations

import json
from math import pi
from pathlib import Path
from typing import Any

import pytest

from eulerplateau.exact import Bench, thresholds
from eulerplateau.exact.conformal import quick_opening_load
from tests.helpers.command import run_here

NYLON = {
    "young": "2 GPa",
    "diameter": "0.2 mm",
    "length": "20 cm",
    "surface-tension": "25 mN/m",
}
TRUE_FILM = Path(__file__).parents[2] / "docs/true_film.json"


def options(said: dict[str, str]) -> list[str]:
    return [word for name, value in said.items() for word in (f"--{name}", value)]


def estimated(**changed: str) -> dict[str, Any]:
    done = run_here("estimate", *options(NYLON | changed), "--json")
    assert (done.returncode, done.stderr) == (0, "")
    return json.loads(done.stdout)


def test_a_nylon_line_has_the_load_of_its_definition() -> None:
    numbers = estimated()
    rigidity = 2e9 * pi * 0.2e-3**4 / 64
    load = (2 * 25e-3) * 0.2**3 / (rigidity / 2)
    assert numbers["sigma_hat"] == pytest.approx(load, rel=1e-12)
    assert numbers["sigma_hat"] == pytest.approx(5093, abs=1)
    assert numbers["kL3_alpha"] * 2 * 3**0.5 == pytest.approx(load, rel=1e-12)
    assert numbers["diameter"] == pytest.approx(0.001, rel=1e-12)
    assert numbers["elastocapillary_length"] ** 3 * 0.05 == pytest.approx(rigidity)


def test_a_rigidity_says_as_much_as_modulus_and_diameter() -> None:
    rest = {name: NYLON[name] for name in ("length", "surface-tension")}
    ei = f"{2e9 * pi * 0.2e-3**4 / 64!r} N m^2"
    done = run_here("estimate", "--bending-rigidity", ei, *options(rest), "--json")
    numbers = json.loads(done.stdout)
    assert numbers["sigma_hat"] == pytest.approx(estimated()["sigma_hat"], rel=1e-12)
    assert numbers["diameter"] is None


def test_at_the_lengths_it_names_the_film_changes() -> None:
    numbers = estimated()
    assert numbers["loads"]["buckles"] == pytest.approx(48 * pi**3, rel=1e-14)
    onset = json.loads(TRUE_FILM.read_text())["twist"]["onset"]
    assert numbers["loads"]["jumps"] == pytest.approx(onset, rel=1e-11)
    states = {
        "buckles": (("disk", "disk"), ("buckled", "buckled")),
        "jumps": (("buckled", "buckled"), ("eight", "buckled")),
        "touches": (("eight", "buckled"), ("eight", "point-contact")),
        "touches_along_a_line": (("eight", "point-contact"), ("eight", "line-contact")),
    }
    for name, beside in states.items():
        for share, expected in zip((1 - 1e-6, 1 + 1e-6), beside, strict=True):
            there = estimated(length=f"{share * numbers['lengths'][name]!r} m")
            assert there["sigma_hat"] == pytest.approx(
                numbers["loads"][name] * share**3, rel=1e-12
            )
            film = there["film"]["untwisting"], there["film"]["welded"]
            assert film == expected, (name, share)


def test_sides_touch_a_diameter_apart() -> None:
    numbers = estimated(diameter="2 mm", young="200 kPa")
    for name, threshold in (
        ("touches", "sigma_contact"),
        ("touches_along_a_line", "sigma_line_contact"),
    ):
        relative = 2e-3 / numbers["lengths"][name]
        own = getattr(thresholds(2, relative), threshold)
        assert numbers["loads"][name] == pytest.approx(own, rel=1e-9)
        assert own < getattr(thresholds(2), threshold)
    thick = estimated(diameter="20 mm", young="30 Pa")
    assert thick["lengths"]["touches"] is None
    assert thick["film"]["welded"] == "too_thick"
    assert thick["loads"]["buckles"] == numbers["loads"]["buckles"]


def test_an_eight_opens_where_its_waist_is_as_wide_as_the_line() -> None:
    numbers = estimated()
    relative = 0.2e-3 / numbers["lengths"]["opens"]
    opens = numbers["loads"]["opens"]
    assert opens == pytest.approx(quick_opening_load(relative), rel=1e-9)
    assert opens < numbers["loads"]["buckles"]
    for modulus in ("20 GPa", "30 Pa"):  # too thin and too thick for its length there
        beyond = estimated(diameter="20 mm", young=modulus)
        assert beyond["lengths"]["opens"] is None


def test_what_is_printed_speaks_the_unit_of_the_length() -> None:
    said = run_here("estimate", *options(NYLON), "--poisson", 0.4).stdout
    assert "5093.0" in said
    assert "13.27 cm" in said
    assert "0.7143" in said  # C/B = 1 / (1 + 0.4)
    assert "132.7 mm" in run_here("estimate", *options(NYLON | {"length": "200 mm"})).stdout


@pytest.mark.parametrize(
    ("changed", "key", "example"),
    [
        ({"young": "2 mm"}, "--young", "'2 GPa'"),
        ({"young": "2"}, "--young", "'2 GPa'"),
        ({"diameter": "-0.2 mm"}, "--diameter", "'0.2 mm'"),
        ({"length": "nan cm"}, "--length", "'20 cm'"),
        ({"surface-tension": "25 mPa"}, "--surface-tension", "'25 mN/m'"),
        ({"poisson": "0.6"}, "--poisson", "0.4"),
        ({"bending-rigidity": "1 N m^2"}, "--young", "--bending-rigidity"),
        ({"length": "1e200 m"}, "sigma_hat", "units"),
        ({"diameter": "30 mm"}, "--diameter", "at most 20 mm, 0.1 of the loop's"),
        ({"diameter": "1e-200 m"}, "sigma_hat", "units"),
    ],
)
def test_slips_are_told_in_a_line_that_shows_an_example(
    changed: dict[str, str], key: str, example: str
) -> None:
    done = run_here("estimate", *options(NYLON | changed))
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith(f"eulerplateau: {key}: ")
    assert example in done.stderr
    assert done.stderr.count("\n") == 1


def test_a_line_that_is_not_said_is_asked_for() -> None:
    rest = {name: NYLON[name] for name in ("length", "surface-tension")}
    for words in ([], ["--diameter", "0.2 mm"]):
        done = run_here("estimate", *words, *options(rest))
        assert (done.returncode, done.stderr.count("\n")) == (2, 1)
        assert '"2 GPa"' in done.stderr
    done = run_here("estimate", "--young", "2 GPa", *options(rest))
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert '"0.2 mm"' in done.stderr


def test_a_length_and_its_load_belong_together() -> None:
    bench = Bench(1e-7, 0.3, 0.03)
    assert bench.length_at(bench.load) == pytest.approx(0.3, rel=1e-14)
