"""The twisted eight of a loop with a diameter: forces by energies, stability, limits."""

from __future__ import annotations

import json
from functools import cache
from math import pi

import numpy as np
import pytest

from eulerplateau.branches.conformal import (
    TouchingFamily,
    opening_load,
    splitting_load,
    thick_eight,
)
from eulerplateau.branches.conformal.contact_eight import reached, touching
from eulerplateau.branches.conformal.touching import Touching, settled
from eulerplateau.exact.conformal import (
    GENERAL,
    crossing,
    edge,
    flat_eight,
    go_to_load,
    make_basis,
    waist,
)
from tests.helpers.command import run_here
from tests.helpers.conformal_films import twisted

WIDE = 0.085
ROD = (2 / 3, 1.0)


@cache
def touching_at(diameter, load=1700.0, ratio=0.0, link=0.0):
    """Return a film by few harmonics."""
    values = {"load": load, "twist_ratio": ratio, "link": link, "diameter": diameter}
    return touching(values)


def next_to(film, **changed):
    """Return the film at other values, in the same basis: Newton's method alone."""
    family = TouchingFamily(film.basis, {**film.values, **changed})
    found = settled(Touching(family, film.x, film.others, 0))
    assert found is not None
    return found


def slope(film, name, h):
    """Return dE/dname by differences, good to O(h^6)."""
    value, steps = film.values[name], (1, 2, 3)
    energy = {
        k: next_to(film, **{name: value + k * h}).energy
        for k in (*steps, *(-k for k in steps))
    }
    odd = [energy[k] - energy[-k] for k in steps]
    return (45 * odd[0] - 9 * odd[1] + odd[2]) / (60 * h)


@pytest.mark.parametrize("rod", [(0.0, 0.0), pytest.param(ROD, marks=pytest.mark.slow)])
def test_energy_changes_by_force_area_and_moment(rod):
    """dE/dd = F, dE/dsigma = A, dE/dLk = 2 pi M, in any basis."""
    film = touching_at(WIDE, 1700.0, *rod)
    c = film.family.unknowns.loop(film.x).coefficients
    area = 0.5 * c @ film.basis.dirichlet @ c
    assert film.force > 1
    assert slope(film, "diameter", 2e-4) == pytest.approx(film.force, rel=1e-7)
    assert slope(film, "load", 5.0) == pytest.approx(area, rel=1e-7)
    if rod[0]:
        moment = film.family.twist(1700.0).moment(film.x)
        assert slope(film, "link", 5e-3) == pytest.approx(2 * pi * moment, rel=1e-7)


def test_distance_of_strands_has_the_derivatives_it_says():
    """Both arc lengths eliminated, for displacements of no symmetry: Taylor's slopes."""
    film = touching_at(WIDE)
    basis = make_basis(12, GENERAL, film.basis.crowding)
    rng = np.random.default_rng(3)
    c = basis.transfer(film.basis, film.family.unknowns.loop(film.x).coefficients)
    c = c + 1e-3 * rng.standard_normal(basis.size) / basis.wavenumbers**3
    step = rng.standard_normal(basis.size) / basis.wavenumbers**3
    at = crossing(basis, c)
    first, second = at.slope @ step, step @ at.curvature @ step
    sizes = np.array([4e-4, 2e-4, 1e-4])
    errors = [
        abs(
            crossing(basis, c + h * step).distance
            - at.distance
            - h * first
            - 0.5 * h**2 * second
        )
        for h in sizes
    ]
    assert np.polyfit(np.log(sizes), np.log(errors), 1)[0] == pytest.approx(3, abs=0.1)
    # No other points are nearer: all pairs of a fine sample of both strands.
    phi = np.linspace(-0.3, 0.3, 601)
    upper, lower = (basis.at(c, middle + phi).x for middle in (pi / 2, 3 * pi / 2))
    least = np.linalg.norm(upper[:, None] - lower, axis=2).min()
    assert at.distance <= least
    assert least == pytest.approx(at.distance, rel=1e-4)


def test_command_says_what_is_no_eight_in_contact():
    eight = ["film", "--start", "eight", "--sigma-hat", "1700", "--json", "--diameter"]
    opens = run_here(*eight, "0.1")
    assert (opens.returncode, json.loads(opens.stdout)["status"]) == (4, "opens")
    assert json.loads(opens.stdout)["problem"] in opens.stderr
    assert "higher load" in opens.stderr
    for wrong in (("0",), ("0.2",), ("0.05", "--link", "1"), ("0.05", "--start", "disk")):
        refused = run_here(*eight, *wrong)
        assert (refused.returncode, refused.stdout) == (2, "")
        assert len(refused.stderr.splitlines()) == 1


@pytest.mark.slow
def test_command_prints_the_eight_in_contact():
    done = run_here(
        *("film", "--start", "eight", "--sigma-hat", "1700", "--json"),
        *("--diameter", "0.05"),
    )
    numbers = json.loads(done.stdout)
    assert (done.returncode, numbers["status"]) == (0, "converged")
    assert numbers["n_unstable"] == 0
    assert abs(numbers["smallest_gap"]) < 1e-14


@pytest.mark.slow
def test_free_film_is_in_contact_without_force():
    """A twisted film is one whose waist is held at its own width; wider, it opens."""
    free = twisted(1350.0).film
    film = reached(touching_at(0.05), {**touching_at(0.05).values, "load": 1350.0})
    film = next_to(film, diameter=waist(free))
    assert film.energy == pytest.approx(free.energy, rel=1e-10)
    assert abs(film.force) < 1e-4
    narrower, wider = (
        next_to(film, diameter=part * waist(free)).force for part in (0.999, 1.001)
    )
    assert wider < film.force < narrower


@pytest.mark.slow
def test_eight_opens_where_the_twisted_film_is_as_wide():
    opens = opening_load(0.05)
    as_wide = go_to_load(twisted(1350.0), opens)
    assert waist(as_wide.film) == pytest.approx(0.05, rel=1e-8)
    assert thick_eight(opens - 1.0, 0.05).status == "opens"
    assert thick_eight(opens + 1.0, 0.05).status == "converged"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("diameter", "rod"), [(0.03, ()), (0.004, ()), (0.05, ROD), (0.05, (2 / 3, 0.5))]
)
def test_strands_push_above_the_opening_load_and_pull_below(diameter, rod):
    """By films in contact, from another load; where their force vanishes is the load."""
    opens, far = opening_load(diameter, *rod), touching_at(diameter, 1700.0, *rod)
    below, above = (
        reached(far, {**far.values, "load": (1 + part) * opens}).force
        for part in (-1e-3, 1e-3)
    )
    assert below < 0 < above
    assert abs(below + above) < 1e-2 * above


@pytest.mark.slow
def test_mirror_images_open_at_one_load_and_a_line_without_turns_nowhere():
    """Mirror images open at one load; without turns the strands come to lie along."""
    assert opening_load(0.1, 2 / 3, -1.0) == opening_load(0.1, 2 / 3, 1.0)
    assert opening_load(0.1, 2 / 3, 0.0) is None


@pytest.mark.slow
def test_contact_splits_where_strands_would_overlap_beside_it():
    """The index rises there too: the strands turn away from each other's way."""
    splits = splitting_load(0.05)
    below, above = (thick_eight(splits + by, 0.05) for by in (-20.0, 20.0))
    assert (below.status, above.status) == ("converged", "splits")
    assert below.smallest_gap > -1e-12 * 0.05 > above.smallest_gap
    assert (below.n_unstable, above.n_unstable) == (0, 1)


@pytest.mark.slow
@pytest.mark.parametrize("rod", [(0.0, 0.0), ROD])
def test_force_is_what_the_rods_resultant_jumps_by(rod):
    """F' = -sigma T with T from the surface, along both sides of the contact.

    F + sigma int T ds is the same all along one side, but for what K harmonics make of a
    kink; it is averaged with a weight that leaves the contact out.
    """
    found = thick_eight(1700.0, 0.05, *rod)
    frame = edge(found.film)
    n = len(frame.x)
    pull = 1700.0 * frame.weights[:, None] * frame.conormal
    kappa2 = (frame.curvature**2).sum(axis=1)[:, None]
    bent = np.fft.irfft(
        1j * np.arange(n // 2 + 1)[:, None] * np.fft.rfft(frame.curvature, axis=0),
        n=n,
        axis=0,
    )
    resultant = (found.film.beta - 3 * kappa2) * frame.tangent
    resultant += found.twist_moment * np.cross(frame.tangent, frame.curvature)
    resultant -= 2 * bent / frame.speed[:, None]
    same = resultant + np.cumsum(pull, axis=0) - pull / 2
    side = np.arange(n // 4)
    weight = np.sin(pi * side / len(side)) ** 4
    jump = weight @ (same[side] - same[side + n // 4]) / weight.sum()
    force = found.contact_force
    np.testing.assert_allclose(jump, [0, force, 0], atol=1e-4 * force)


@pytest.mark.slow
def test_numbers_do_not_depend_on_the_number_of_harmonics():
    """A point force leaves O(K^-3) in energy and force; the index stays."""
    film = touching_at(0.05)
    more = [film.in_basis(make_basis(k, film.basis.family, 1e-3)) for k in (64, 96, 144)]
    energies, forces = np.array([f.energy for f in more]), [f.force for f in more]
    first, second = -np.diff(energies)
    assert np.log(first / second) / np.log(1.5) == pytest.approx(3, abs=0.5)
    assert forces == pytest.approx([forces[-1]] * 3, rel=1e-7)
    assert np.ptp([f.convexity for f in more]) < 1e-4
    assert [f.family.in_space(f.point).n_unstable for f in more] == [0, 0, 0]


@pytest.mark.slow
def test_mirror_image_of_a_rod_turned_the_other_way():
    right, left = (thick_eight(1700.0, WIDE, ROD[0], link) for link in (1.0, -1.0))
    assert (left.energy, left.contact_force) == (right.energy, right.contact_force)
    assert (left.writhe, left.twist_moment) == (-right.writhe, -right.twist_moment)
    mirrored = right.film.curve.x * [1, 1, -1]
    np.testing.assert_allclose(left.film.curve.x, mirrored, atol=1e-14)


@pytest.mark.slow
def test_narrow_waists_cost_what_a_helicoid_costs():
    """E - E8 = (sigma/omega) d^2 log(C/d): the slope by log d is known, C is not."""
    flat = flat_eight(1700.0)
    stiff = 1700.0 / (2 * abs(flat.angle))
    slopes = []
    for d in (0.02, 0.01):
        excess = [(touching_at(size).energy - flat.energy) / size**2 for size in (d, d / 2)]
        slopes.append((excess[1] - excess[0]) / np.log(2) / stiff)
    # What is left is of the order of d^2 log^2 d.
    assert abs(slopes[1] - 1) < 0.25 * abs(slopes[0] - 1) < 0.01
