"""Films without a mesh whose rod resists twist: exact thresholds, balance, energies."""

import json
from functools import cache
from itertools import islice
from math import pi, sqrt

import numpy as np
import pytest
from scipy.optimize import brentq

from eulerplateau.branches import point_near
from eulerplateau.branches.conformal import (
    NoFilmError,
    SmoothFamily,
    Start,
    critical_moment,
    films_by_writhe,
    pinched_eight,
    rod_film,
    smooth_family,
    stiffness,
)
from eulerplateau.errors import SpecError
from eulerplateau.exact.conformal import GENERAL, disk, edge, make_basis
from eulerplateau.exact.planar import planar_film
from eulerplateau.solvers import tangent_model
from tests.helpers.command import command_line, run_here
from tests.helpers.conformal_films import twisted
from tests.helpers.marks import quick_with
from tests.helpers.processes import shown_at_a_terminal

LOADS = (0.2, 0.5, 1.0, 1.7, 2.9)  # nu, below n^2 - 1 for n = 2, 3, 4


@pytest.mark.parametrize("n", [2, 3, 4])
@pytest.mark.parametrize("ratio", [0.5, 2 / 3, 1.0])
@pytest.mark.parametrize("nu", quick_with([0.5, 1.7], LOADS))
def test_disk_yields_where_the_theory_says(n, ratio, nu):
    """Phi_n = 2 pi (B/C) sqrt((n^2 - 1 - nu)(1 - nu/(n (n + 1)))), to 1e-10."""
    load, basis = 16 * pi**3 * nu, make_basis(n + 3, GENERAL)
    family = SmoothFamily(basis, {"load": load, "twist_ratio": ratio, "link": 0.0}, "link")
    flat = family.unknowns.x(disk(basis, load).coefficients)
    expected = sqrt((n * n - 1 - nu) * (1 - nu / (n * (n + 1)))) / ratio
    # Both chiralities of the lower modes are unstable by then, two of each n.
    number = 2 * (n - 2)

    def lowest(link):
        return tangent_model(family.energy(link), flat).eigenvalues[number]

    found = brentq(lowest, 0.999 * expected, 1.001 * expected, xtol=1e-13, rtol=1e-14)
    assert found == pytest.approx(expected, rel=1e-10)
    moment = 4 * pi * ratio * expected
    assert critical_moment(load, n) == pytest.approx(moment, rel=1e-14)


@cache
def film(name):
    """Return a film, of which the first ones are stable and the last is not."""
    return {
        "lobes": lambda: rod_film(Start.LOBES, 1700.0, 2 / 3, 0.25),
        "left-handed": lambda: rod_film(Start.LOBES, 1550.0, 1.0, -0.2),
        "soft": lambda: rod_film(Start.LOBES, 1650.0, 0.3, 0.3),
        "unstable": lambda: rod_film(Start.TWISTED, 1700.0),
    }[name]()


FILMS = ["lobes", "left-handed", "soft", "unstable"]


@pytest.mark.parametrize("name", quick_with(["soft"], FILMS))
def test_rod_is_balanced_point_by_point(name):
    """F' = -sigma T with M kappa b in F; T from the surface, no gradient of ours."""
    found = film(name)
    assert found.resolved
    assert found.n_unstable == (name == "unstable")
    frame = edge(found.film)
    off = frame.force_balance(found.film.load, found.film.beta, found.twist_moment)
    assert off < 1e-8
    if found.twist_ratio:
        without = frame.force_balance(found.film.load, found.film.beta)
        assert without > 1e-3


def energy_next_to(found, **changed):
    """Return the energy of the film next to one, at other values of load or link."""
    values = {"load": found.film.load, "twist_ratio": found.twist_ratio, "link": found.link}
    family = SmoothFamily(found.film.basis, {**values, **changed})
    start = family.unknowns.x(found.film.coefficients)
    point = point_near(family, start, family.values["load"])
    twist = family.twist(point.value)
    return family.film(point).energy + twist.energy(point.x)


def test_energy_changes_by_area_and_moment():
    """dE/dsigma = A, dE/dLk = 2 pi M: Richardson's differences, good to O(h^4)."""
    found = film("lobes")
    for name, value, h, slope in (
        ("load", found.film.load, 2.0, found.film.area),
        ("link", found.link, 2e-3, 2 * pi * found.twist_moment),
    ):
        coarse, fine = (
            (
                energy_next_to(found, **{name: value + step})
                - energy_next_to(found, **{name: value - step})
            )
            / (2 * step)
            for step in (2 * h, h)
        )
        assert (4 * fine - coarse) / 3 == pytest.approx(slope, rel=1e-7)


@pytest.mark.slow
def test_twist_that_costs_nothing_gives_back_known_films():
    flat, known = rod_film(Start.LOBES, 1700.0), planar_film(2, 1700.0)
    assert flat.energy == pytest.approx(known.energy, rel=1e-10)
    assert flat.film.area == pytest.approx(known.area, rel=1e-10)
    off_plane, same = film("unstable"), twisted(1700.0).film
    assert off_plane.energy == pytest.approx(same.energy, rel=1e-10)
    assert off_plane.film.area == pytest.approx(same.area, rel=1e-9)


@pytest.mark.slow
def test_rod_that_was_hardly_turned_writhes_in_proportion():
    """Lk - Wr = Wr E_0''(0) / (8 pi^2 C/B), up to the cube."""
    stiff = stiffness(next(films_by_writhe(1700.0))) / (8 * pi**2 * 0.7)
    found = rod_film(Start.LOBES, 1700.0, 0.7, 1e-3)
    assert found.writhe == pytest.approx(1e-3 / (1 + stiff), rel=1e-4)


@pytest.mark.slow
def test_mirror_image_of_a_rod_turned_the_other_way():
    left, right = film("left-handed"), rod_film(Start.LOBES, 1550.0, 1.0, 0.2)
    assert left.energy == right.energy
    assert (left.writhe, left.twist_moment) == (-right.writhe, -right.twist_moment)
    x, y = left.film.curve.x, right.film.curve.x
    np.testing.assert_allclose(x * [1, 1, -1], y, atol=1e-14)


def test_disk_is_flat_and_counts_its_unstable_modes():
    """Two modes of n = 2 beyond Phi_2, at any link the same shape."""
    load = 1000.0
    yields = critical_moment(load) / (4 * pi * 0.8)
    below, above = (rod_film(Start.DISK, load, 0.8, t * yields) for t in (0.99, 1.01))
    assert (below.n_unstable, above.n_unstable) == (0, 2)
    assert below.film.area == pytest.approx(1 / (4 * pi), rel=1e-13)
    assert above.twist_energy == pytest.approx(1.6 * (2.02 * pi * yields) ** 2 / 2)


@pytest.mark.slow
def test_ring_without_film_loses_its_disk_as_known():
    """E_0'' tends to -8 pi^2 11/8 at no load and no writhe (rings of DNA)."""
    loads, ratios = np.array([30.0, 60.0, 90.0]), []
    for load in loads:
        path = films_by_writhe(load)
        points = [next(path), next(path)]
        twist = [p.family.twist(p.value).writhe(p.x) for p in points]
        there = [-stiffness(p) / (8 * pi**2) for p in points]
        # To no writhe, a straight line.
        ratios.append(there[0] - twist[0] * np.diff(there)[0] / np.diff(twist)[0])
    at_no_load = np.polyfit(loads, ratios, 2)[-1]
    assert at_no_load == pytest.approx(11 / 8, abs=1e-3)


@pytest.mark.slow
def test_branch_that_folds_is_refused():
    """At 1855 a rod of C/B = 0.1 snaps before a quarter of a turn."""
    with pytest.raises(NoFilmError, match="folds near the link 0"):
        rod_film(Start.LOBES, 1850.0, 0.05, 0.25)


@pytest.mark.parametrize(
    ("arguments", "key"),
    [
        ((Start.LOBES, 1700.0, 0.0, 0.5), "link"),
        ((Start.LOBES, 1700.0, -1.0, 0.5), "twist_ratio"),
        ((Start.LOBES, 1400.0, 1.0, 0.5), "load"),
        ((Start.DISK, 0.0, 1.0, 0.5), "load"),
        ((Start.DISK, float("nan"), 1.0, 0.5), "load"),
    ],
)
def test_wrong_numbers_are_named(arguments, key):
    with pytest.raises(SpecError) as error:
        rod_film(*arguments)
    assert error.value.key == key


@pytest.mark.slow
def test_twist_opens_or_presses_the_pinched_eight():
    opens, presses, rests = (
        pinched_eight(1700.0, 0.7, link).pinch for link in (0.6, 1.2, 1.0)
    )
    assert (opens, presses, rests) == ("opens", "presses", "rests")
    left = pinched_eight(1700.0, 0.7, -0.6)
    assert (left.writhe, left.pinch) == (-1.0, "opens")


def test_the_spectrum_in_space_is_that_of_all_harmonics_in_one_matrix():
    """By half-turns that each displacement keeps; the loop is neither flat nor round."""
    *_, point = islice(films_by_writhe(1700.0), 5)
    family = smooth_family(point)
    assert abs(family.twist(point.value).writhe(point.x)) > 0.05
    expected = family.at_once(point).eigenvalues
    found = family.in_space(point).eigenvalues
    np.testing.assert_allclose(found, expected, atol=1e-11 * np.abs(expected).max())


def test_command_prints_json_and_says_what_is_no_film():
    args = ["film", "--sigma-hat", "1700", "--twist-ratio", "0.7", "--json"]
    done = run_here(*args, "--start", "lobes")
    numbers = json.loads(done.stdout)
    assert done.returncode == 0
    # A bar is for people: this is no terminal.
    assert done.stderr == ""
    assert numbers["status"] == "converged"
    assert numbers["energy"] == pytest.approx(planar_film(2, 1700.0).energy, rel=1e-10)
    pinched = run_here(*args, "--start", "eight", "--link", "0.5")
    assert pinched.returncode == 4
    assert json.loads(pinched.stdout)["pinch"] == "opens"


@pytest.mark.slow
def test_at_a_terminal_the_command_shows_how_far_it_has_followed_the_film():
    args = ["film", "--sigma-hat", 1700, "--twist-ratio", 0.7, "--start", "lobes"]
    shown = shown_at_a_terminal(command_line(*args, "--link", 0.05))
    assert b"writhe 0.0" in shown
    assert b"film/s" in shown
