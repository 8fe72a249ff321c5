"""A referee for the exact planar films that knows no elliptic function: shooting.

It integrates the shape equation with the Frenet equations from the tip of a lobe and asks
only for what can be seen: where the curve is, which way it points, how long it is. What
kappa^2 - beta is at a contact, or the similarity of lobes, is not put in.
"""

from __future__ import annotations

from collections.abc import Callable
from math import pi

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import root

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.planar import planar_film, thresholds
from tests.helpers.marks import quick_with

KAPPA, SLOPE, ANGLE, Y, AREA, BENDING = range(6)
# Curvature of the tip, beta, and the rest of the unknowns: this far off at the start.
OFF = 1e-3


def shoot(
    kappa: float, slope: float, beta: float, sigma: float, length: float
) -> FloatArray:
    """Return the state at `length` from a start at (0, 0) with the tangent along y.

    AREA is the integral of -y dx, BENDING that of kappa^2.
    """

    def change(_: float, state: FloatArray) -> list[float]:
        k, dk, angle, y = state[:4]
        c, s = np.cos(angle), np.sin(angle)
        return [dk, (sigma + beta * k - k**3) / 2, k, s, -y * c, k * k]

    start = [kappa, slope, pi / 2, 0.0, 0.0, 0.0]
    run = solve_ivp(change, (0, length), start, method="DOP853", rtol=1e-13, atol=1e-13)
    return np.asarray(run.y[:, -1])


def solve(
    conditions: Callable[[FloatArray], list[float]], guess: list[float]
) -> FloatArray:
    """Return the solution, in units of a guess that is taken off by OFF."""
    scale = np.array(guess)
    signs = np.where(np.arange(len(guess)) % 2, -1, 1)
    found = root(lambda x: conditions(x * scale), 1 + OFF * signs, options={"xtol": 1e-13})
    assert np.abs(found.fun).max() <= 1e-9
    return np.asarray(found.x * scale)


@pytest.mark.parametrize(
    ("n", "part"),
    [(2, 0.0005), (2, 0.005), (2, 0.5), (2, 0.99), (3, 0.3), (5, 0.8), (12, 0.5)],
)
def test_buckled_films(n: int, part: float) -> None:
    limits = thresholds(n)
    start, contact = limits.sigma_buckling, limits.sigma_contact
    sigma = start + part * (contact - start)
    film = planar_film(n, sigma)

    def closes(unknown: FloatArray) -> list[float]:
        kappa, beta = unknown
        end = shoot(kappa, 0.0, beta, sigma, 1 / (2 * n))
        return [end[SLOPE], end[ANGLE] - pi / 2 - pi / n]

    kappa, beta = solve(closes, [film.kappa_max, film.beta_hat])
    assert film.kappa_max == pytest.approx(kappa, rel=1e-9)
    assert film.beta_hat == pytest.approx(beta, rel=1e-9)
    end = shoot(kappa, 0.0, beta, sigma, 1 / (2 * n))
    assert film.kappa_min == pytest.approx(end[KAPPA], rel=1e-8)


@pytest.mark.parametrize("diameter", [None, 0.004, 0.05])
def test_first_contact_of_two_lobes_to_ten_digits(diameter: float | None) -> None:
    sigma = thresholds(2, diameter).sigma_contact
    film = planar_film(2, sigma, diameter)

    def touches(unknown: FloatArray) -> list[float]:
        kappa, beta, load = unknown
        end = shoot(kappa, 0.0, beta, load, 0.25)
        return [end[SLOPE], end[ANGLE] - pi, 100 * (end[Y] - film.diameter / 2)]

    found = solve(touches, [film.kappa_max, film.beta_hat, sigma])
    assert sigma == pytest.approx(found[2], rel=1e-11)


@pytest.mark.parametrize(
    ("n", "diameter"),
    quick_with(
        [(3, None), (12, None), (3, 0.04)],
        [(3, None), (4, None), (6, None), (12, None), (3, 0.04), (12, 0.01)],
    ),
)
def test_first_contact_of_more_lobes_to_ten_digits(n: int, diameter: float | None) -> None:
    sigma = thresholds(n, diameter).sigma_contact
    film = planar_film(n, sigma, diameter)

    def touches(unknown: FloatArray) -> list[float]:
        kappa, beta, load, length = unknown
        at_contact = shoot(kappa, 0.0, beta, load, length)
        end = shoot(kappa, 0.0, beta, load, 1 / (2 * n))
        return [
            100 * (at_contact[Y] - film.diameter / 2),
            at_contact[ANGLE] - pi,
            end[SLOPE] / 1000,
            end[ANGLE] - pi / 2 - pi / n,
        ]

    guess = [film.kappa_max, film.beta_hat, sigma, film.half_lobe.ends[1]]
    assert sigma == pytest.approx(solve(touches, guess)[2], rel=1e-11)


@pytest.mark.parametrize(
    ("n", "diameter"),
    quick_with(
        [(2, None), (12, None), (3, 0.02)],
        [(2, None), (3, None), (5, None), (12, None), (2, 0.06), (3, 0.02), (12, 0.005)],
    ),
)
def test_onset_of_line_contact_to_ten_digits_and_its_beta(
    n: int, diameter: float | None
) -> None:
    sigma = thresholds(n, diameter).sigma_line_contact
    film = planar_film(n, sigma, diameter)
    # In units of sigma^(2/3), 0 without a diameter.
    beta_there = -film.diameter * sigma ** (1 / 3) / 2
    half = 1 / (2 * n)

    def lobe(unknown: FloatArray) -> list[float]:
        kappa, beta, load, length = unknown
        end = shoot(kappa, 0.0, beta * load ** (2 / 3), load, length)
        offset = end[Y] - film.diameter / 2
        return [end[KAPPA] / 100, end[ANGLE] - pi, 100 * offset]

    def whole(unknown: FloatArray) -> list[float]:
        kappa, beta_off, load, length, slope = unknown
        # beta is near zero: 1 + beta as the unknown keeps it in scale.
        beta = (beta_off - 1) * load ** (2 / 3)
        end = shoot(0.0, slope, beta, load, half - length)
        turned = end[ANGLE] - pi / 2 - (pi / n - pi / 2)
        return [*lobe(np.array([kappa, beta_off - 1, load, length])), end[SLOPE], turned]

    if n == 2:
        found = solve(
            lambda x: lobe(np.array([x[0], x[1] - 1, x[2], 0.25])),
            [film.kappa_max, 1.0 + beta_there, sigma],
        )
    else:
        length = film.half_lobe.ends[1]
        bend = 1e-7
        slope = -float(film.curvature(length) - film.curvature(length + bend)) / bend
        found = solve(whole, [film.kappa_max, 1.0 + beta_there, sigma, length, slope])
    assert sigma == pytest.approx(found[2], rel=1e-11)
    assert found[1] - 1 == pytest.approx(beta_there, abs=1e-11)


@pytest.mark.parametrize(
    ("n", "diameter"),
    quick_with(
        [(2, None), (8, None), (3, 0.02)],
        [(2, None), (3, None), (8, None), (2, 0.05), (3, 0.02), (8, 0.008)],
    ),
)
def test_point_contact_films(n: int, diameter: float | None) -> None:
    limits = thresholds(n, diameter)
    sigma = (limits.sigma_contact + limits.sigma_line_contact) / 2
    film = planar_film(n, sigma, diameter)
    half = 1 / (2 * n)

    def arcs(unknown: FloatArray) -> tuple[FloatArray, FloatArray]:
        kappa, beta, length, slope = unknown
        lobe = shoot(kappa, 0.0, beta, sigma, length)
        return lobe, shoot(lobe[KAPPA], slope, beta, sigma, half - length)

    def touches(unknown: FloatArray) -> list[float]:
        lobe, neck = arcs(unknown)
        turned = neck[ANGLE] - pi / 2 - (pi / n - pi / 2)
        offset = lobe[Y] - film.diameter / 2
        return [100 * offset, lobe[ANGLE] - pi, neck[SLOPE] / 1000, turned]

    if n == 2:
        kappa, beta = solve(
            lambda x: touches(np.array([*x, half, 0.0]))[:2],
            [film.kappa_max, film.beta_hat],
        )
        lobe = shoot(kappa, 0.0, beta, sigma, half)
        bending, area, jump = 4 * lobe[BENDING], 4 * lobe[AREA], 2 * lobe[SLOPE]
        assert film.area == pytest.approx(area, rel=1e-9)
    else:
        length = film.half_lobe.ends[1]
        ahead = film.curvature(length + np.array([0, 1e-7]))
        guess = [film.kappa_max, film.beta_hat, length, float(np.diff(ahead)[0]) / 1e-7]
        found = solve(touches, guess)
        kappa, beta = found[:2]
        lobe, _ = arcs(found)
        bending = 2 * n * sum(arc[BENDING] for arc in arcs(found))
        jump = 2 * (lobe[SLOPE] - found[3])
    assert film.kappa_max == pytest.approx(kappa, rel=1e-9)
    assert film.beta_hat == pytest.approx(beta, rel=1e-9)
    assert film.energy - sigma * film.area == pytest.approx(bending, rel=1e-9)
    # The shear force 2 kappa' jumps by the point force on each of the half lobes.
    assert film.contact_force == pytest.approx(n * jump, rel=1e-8)


@pytest.mark.parametrize(("n", "diameter"), [(2, 0.05), (2, 0.002), (3, 0.015), (8, 0.004)])
def test_line_contact_films(n: int, diameter: float) -> None:
    sigma = 1.5 * thresholds(n, diameter).sigma_line_contact
    film = planar_film(n, sigma, diameter)
    to_contact, half = film.half_lobe.ends[1], 1 / (2 * n)

    def lobe(unknown: FloatArray) -> list[float]:
        kappa, below, length = unknown
        end = shoot(kappa, 0.0, below - sigma ** (2 / 3), sigma, length)
        offset = end[Y] - diameter / 2
        return [end[KAPPA] / 100, end[ANGLE] - pi, 100 * offset]

    above = film.beta_hat + sigma ** (2 / 3)
    kappa, above, length = solve(lobe, [film.kappa_max, above, to_contact])
    beta = above - sigma ** (2 / 3)
    arcs = [shoot(kappa, 0.0, beta, sigma, length)]
    jump, line = 2 * arcs[0][SLOPE], half - length
    if n > 2:

        def neck(unknown: FloatArray) -> list[float]:
            end = shoot(0.0, unknown[0], beta, sigma, unknown[1])
            return [end[SLOPE] / 1000, end[ANGLE] - pi / n]

        start, step = film.half_lobe.ends[2], 1e-7
        slope = float(film.curvature(start + step)) / step
        slope, inner = solve(neck, [slope, half - start])
        arcs.append(shoot(0.0, slope, beta, sigma, inner))
        jump, line = jump - 2 * slope, line - inner
    assert beta == pytest.approx(-sigma * diameter / 2, abs=1e-9 * sigma ** (2 / 3))
    assert film.kappa_max == pytest.approx(kappa, rel=1e-9)
    assert film.contact_length == pytest.approx(line, rel=1e-8)
    assert film.contact_force == pytest.approx(n * (jump + sigma * line), rel=1e-9)
    bending = 2 * n * sum(arc[BENDING] for arc in arcs)
    assert film.energy - sigma * film.area == pytest.approx(bending, rel=1e-9)
