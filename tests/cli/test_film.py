"""`eulerplateau film`: what it says of films that it has, and of those it has not."""

from __future__ import annotations

import json
from math import pi

import pytest

from tests.helpers.command import Shell, run_here


def film(*words: object) -> Shell:
    """What the command says."""
    return run_here("film", "--json", "--sigma-hat", *words)


def yielding(load: float, ratio: float, link: float) -> int:
    """The disk's modes that yield: of each n two pairs, in the plane and across it.

    Their stiffnesses are n^2 - 1 - nu and 1 - nu / (n (n + 1)); twist couples a pair, whose
    determinant is the product less (C/B Lk)^2.
    """
    nu, count = load / (16 * pi**3), 0
    for n in range(2, 1000):
        within, across = n * n - 1 - nu, 1 - nu / (n * (n + 1))
        same_sign = within * across > (ratio * link) ** 2
        count += (4 if within < 0 else 0) if same_sign else 2
    return count


@pytest.mark.parametrize(
    ("load", "ratio", "link"),
    [(1e-300, 0, 0), (1e-3, 0, 0), (2e5, 0, 0), (1e6, 0, 0), (1e5, 0.8, 20.3), (50, 1, 30)],
)
def test_disk_of_any_load_and_link_counts_all_modes_that_yield(
    load: float, ratio: float, link: float
) -> None:
    done = film(load, "--start", "disk", "--twist-ratio", ratio, "--link", link)
    said = json.loads(done.stdout)
    assert (done.returncode, said["status"]) == (0, "converged")
    assert said["n_unstable"] == yielding(load, ratio, link)
    assert said["area"] == pytest.approx(1 / (4 * pi), rel=1e-14)
    assert str(said["twist_moment"]) != "-0.0"


@pytest.mark.slow
def test_ring_curved_by_nature_counts_all_modes_that_yield() -> None:
    """Of natural curvature q, without a film, those of q (q + g) > q + g n^2, g = C/B."""
    q, ratio = 5.0, 0.1
    rod = "--twist-ratio", ratio, "--rest-curvature", q
    said = json.loads(film(1e-2, "--start", "disk", *rod).stdout)
    yields = [n for n in range(2, 100) if q * (q + ratio) > q + ratio * n * n]
    assert said["n_unstable"] == 2 * len(yields)


@pytest.mark.slow
def test_next_to_a_film_of_no_link_there_is_one_of_a_little() -> None:
    """dE/dLk = 2 pi M."""
    rod = 1700, "--start", "twisted", "--twist-ratio", 0.1, "--link"
    before, there, after = (
        json.loads(film(*rod, link).stdout) for link in (0.0, 1e-3, 2e-3)
    )
    slope = (after["energy"] - before["energy"]) / 2e-3
    assert slope == pytest.approx(2 * pi * there["twist_moment"], rel=1e-4)
    assert there["n_unstable"] == 1


@pytest.mark.parametrize(
    ("words", "status", "said"),
    [
        ((1e9, "--start", "disk"), "unresolved", "240 are counted"),
        (
            (100, "--start", "disk", "--twist-ratio", 1e200, "--link", 1e200),
            "unresolved",
            "inf waves",
        ),
        pytest.param(
            (1e9, "--start", "eight", "--diameter", 0.02),
            "stalled",
            "the last on the way",
            marks=pytest.mark.slow,
        ),
    ],
)
def test_film_that_is_refused_is_json_with_a_reason(
    words: tuple[object, ...], status: str, said: str
) -> None:
    done = film(*words)
    numbers = json.loads(done.stdout)
    assert (done.returncode, numbers["status"], numbers["energy"]) == (4, status, None)
    assert said in numbers["problem"]
    assert done.stderr == f"eulerplateau: {numbers['problem']}\n"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "status"),
    [
        ((2550, "--start", "lobes"), "unresolved"),
        ((2400, "--start", "twisted"), "absent"),
        ((2000, "--start", "eight", "--diameter", 1e-4), "unresolved"),
        ((1700, "--start", "lobes", "--twist-ratio", 0.8, "--link", 0.9), "pinched"),
        ((1850, "--start", "lobes", "--twist-ratio", 0.05, "--link", 0.25), "folds"),
        ((6000, "--start", "eight", "--diameter", 0.02), "splits"),
    ],
)
def test_film_that_is_lost_on_the_way_says_how(
    words: tuple[object, ...], status: str
) -> None:
    done = film(*words)
    assert (done.returncode, json.loads(done.stdout)["status"]) == (4, status)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((1e300, "--start", "disk"), "at most 1e+100"),
        ((2e3, "--start", "disk", "--link", "nan"), "positive or negative"),
        ((2e3, "--start", "eight", "--diameter", 0.1000001), "found 0.1000001;"),
    ],
)
def test_number_that_is_wrong_is_told_in_a_line(
    words: tuple[object, ...], said: str
) -> None:
    done = film(*words)
    assert (done.returncode, done.stdout) == (2, "")
    assert said in done.stderr
    assert done.stderr.count("\n") == 1
