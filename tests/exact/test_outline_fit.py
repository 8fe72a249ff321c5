"""Films fitted to outlines: exact without noise, honest with it, the same in any frame."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.errors import SpecError
from eulerplateau.exact import fit_outline, fit_racket, planar_film, thresholds
from eulerplateau.exact.outline.curves import Curves, Lobes, Racket
from eulerplateau.exact.outline.matching import Matching
from eulerplateau.exact.outline.noise import estimate
from scripts.studies.outline_fit.coverage import QUANTITIES, hit
from tests.helpers.marks import quick_with

RANDOM = np.random.default_rng(8)


def moved(x: np.ndarray, size: float, angle: float) -> np.ndarray:
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return size * x @ turn.T + [40.0, -7.0]


def outline(
    lobes: int, load: float, count: int, edge: float = 0.0, even: bool = False
) -> np.ndarray:
    """Points (count, 2) of a film of length 180, `edge` outwards of its centre."""
    t = np.arange(count) / count if even else np.sort(RANDOM.uniform(size=count))
    found = planar_film(lobes, load).points(t)
    outwards = np.stack([np.sin(found.angle), -np.cos(found.angle)], -1)
    return moved(found.x + edge / 180 * outwards, 180.0, 2.3)


@pytest.mark.parametrize(
    ("curves", "shape"),
    [
        (Lobes(2), [0.02]),
        pytest.param(Lobes(2), [0.5], marks=pytest.mark.slow),
        pytest.param(Lobes(2), [1.2], marks=pytest.mark.slow),
        (Lobes(2), [2.0]),
        (Lobes(5), [0.8]),
        (Racket(), []),
    ],
)
def test_slopes_of_distances_are_their_derivatives(
    curves: Curves, shape: list[float]
) -> None:
    ends = (0.0, 1.0) if curves.closed else (-5.0, 5.0)
    t = np.linspace(*ends, 60, endpoint=False)
    foot = curves.curve(np.array(shape)).points(t)
    size = 1 / np.ptp(foot.x[:, 0])
    points = moved(foot.x, size, 0.7) + 1e-3 * RANDOM.normal(size=foot.x.shape)
    unknowns = np.array([*shape, np.log(size), 40.0, -7.0, 0.7])
    matching = Matching(points, curves, t, offset=0.01)
    slopes = matching.at(unknowns).slopes
    for number, axis in enumerate(np.eye(len(unknowns))):
        errors = []
        for step in (1e-3, 5e-4):
            ahead = matching.at(unknowns + step * axis).distances
            behind = matching.at(unknowns - step * axis).distances
            errors.append(np.abs((ahead - behind) / 2 / step - slopes[:, number]).max())
        assert errors[0] < 1e-3 * np.abs(slopes).max()
        # Of second order, or down to rounding.
        assert errors[1] < 0.3 * errors[0] or errors[0] < 1e-8


def test_the_amplitude_goes_through_the_circle_smoothly() -> None:
    curves, t = Lobes(3), np.linspace(0, 1, 40, endpoint=False)
    size = 1e-4
    ahead, circle, behind = (
        curves.curve(np.array([a])).points(t).x for a in (size, 0.0, -size)
    )
    slope = curves.slopes(np.zeros(1), t)[0]
    np.testing.assert_allclose(ahead - circle, size * slope, atol=20 * size**2)
    np.testing.assert_allclose(circle - behind, size * slope, atol=20 * size**2)
    unknowns, settled = curves.settled(np.array([-0.4, 0.0, 1.0, 2.0, 0.3]), t)
    turned = curves.curve(np.array([-0.4])).points(t).x
    np.testing.assert_allclose(
        moved(turned, 1.0, 0.3),
        moved(curves.curve(unknowns[:1]).points(settled).x, 1.0, unknowns[-1]),
        atol=1e-13,
    )


@pytest.mark.parametrize(
    ("lobes", "load"),
    quick_with(
        [(2, 1700.0), (2, 9000.0), (3, 5000.0)],
        [(2, 1488.302), (2, 1700.0), (2, 2700.0), (2, 5093.0), (2, 9000.0), (3, 5000.0)],
    ),
)
def test_without_noise_the_film_comes_back(lobes: int, load: float) -> None:
    fit = fit_outline(outline(lobes, load, 60))
    assert fit.lobes == lobes
    assert fit.sigma_hat is not None
    assert fit.sigma_hat.value == pytest.approx(load, rel=1e-8)
    assert fit.size.value == pytest.approx(180, rel=1e-8)
    assert fit.strength.value == pytest.approx(load / 180**3, rel=1e-8)
    assert fit.sigma_hat.low <= load <= fit.sigma_hat.high
    assert fit.sigma_hat.high - fit.sigma_hat.low < 1e-8 * load


@pytest.mark.slow
def test_place_size_order_and_the_last_point_make_no_difference() -> None:
    points = outline(2, 1800.0, 50) + 0.1 * RANDOM.normal(size=(50, 2))
    fit = fit_outline(points)
    assert fit.sigma_hat is not None
    other = fit_outline(moved(np.roll([*points, points[0]], 0, axis=0)[::-1], 1e-3, 1.9))
    assert other.sigma_hat is not None
    for name in ("value", "low", "high"):
        # Noise is estimated from groups of points, which begin with the first.
        found = getattr(other.sigma_hat, name)
        assert found == pytest.approx(getattr(fit.sigma_hat, name), rel=1e-5)
    assert other.size.value == pytest.approx(1e-3 * fit.size.value, rel=1e-9)


def test_an_outer_edge_is_half_a_diameter_from_the_centre() -> None:
    points = outline(2, 2000.0, 60, edge=1.5)
    fit = fit_outline(points, diameter=3.0)
    assert fit.sigma_hat is not None
    assert fit.sigma_hat.value == pytest.approx(2000, rel=1e-8)
    assert fit.size.value == pytest.approx(180, rel=1e-8)


@pytest.mark.slow
def test_a_circle_yields_an_upper_bound() -> None:
    buckling = thresholds(2).sigma_buckling
    circle = outline(2, 800.0, 80)
    for deviation in (0.0, 0.5):
        fit = fit_outline(circle + deviation * RANDOM.normal(size=circle.shape))
        assert fit.is_circle
        assert fit.lobes is None
        assert fit.sigma_hat is not None
        assert fit.sigma_hat.low == 0
        assert buckling <= fit.sigma_hat.high < 1.1 * buckling
        assert fit.strength.low == 0
        assert 0.97 * 180 < fit.size.value < 1.03 * 180
    # What is called a circle may be a film of that load, and no more of it.
    beyond = outline(2, 1.05 * fit.sigma_hat.high, 80)
    assert fit_outline(beyond + 0.5 * RANDOM.normal(size=circle.shape)).lobes == 2


@pytest.mark.slow
def test_a_racket_s_head_has_its_size() -> None:
    head = Racket().curve(np.empty(0))
    fine = head.points(np.linspace(-5.0, 5.0, 20001)).x
    # From the planar films, in units of (EI / sigma)^(1/3): docs/planar.md.
    assert fine[:, 0].max() == pytest.approx(3.0541, abs=1e-4)
    assert np.ptp(fine[:, 1]) == pytest.approx(1.0639, abs=1e-4)
    found = head.points(np.linspace(-6.0, 5.0, 60))
    outwards = np.stack([np.sin(found.angle), -np.cos(found.angle)], -1)
    for edge in (0.0, 0.02):
        points = moved(found.x + edge * outwards, 14.6, 4.0)
        for order in (points, points[::-1]):
            fit = fit_racket(order, diameter=2 * edge * 14.6)
            assert fit.size.value == pytest.approx(14.6, rel=1e-8)
            assert fit.strength.value == pytest.approx(2 / 14.6**3, rel=1e-8)
            assert fit.sigma_hat is None


@pytest.mark.slow
@pytest.mark.parametrize("deviation", [0.0, 1e-3, 5e-3])
def test_what_is_left_of_another_curve_is_no_noise(deviation: float) -> None:
    random, t = np.random.default_rng(5), np.linspace(0, 2 * np.pi, 80, endpoint=False)

    def seen(x: np.ndarray) -> np.ndarray:
        return x + deviation * np.ptp(x, axis=0).max() * random.normal(size=x.shape)

    film = seen(planar_film(2, 2000.0).points(t / 2 / np.pi).x)
    head = seen(Racket().curve(np.empty(0)).points(np.linspace(-5, 5, 80)).x)
    ellipse = seen(np.stack([np.cos(t), 0.25 * np.sin(t)], -1))
    right, wrong, racket = fit_outline(film), fit_racket(film), fit_racket(head)
    assert not right.is_misfit
    assert not racket.is_misfit
    assert fit_outline(ellipse).is_misfit
    assert wrong.is_misfit
    assert wrong.is_farther_than(right)
    assert not right.is_farther_than(wrong)
    assert right.is_exact == (deviation == 0)
    if deviation < 2e-3:  # the misfit's, along strands as long as these, is 3e-3
        assert fit_outline(head).is_farther_than(racket)


@pytest.mark.parametrize("length", quick_with([0.03], [0.0, 0.03]))
def test_errors_of_a_mean_are_those_of_noise_that_is_alike(length: float) -> None:
    """The variance of a mean, which plain least squares get wrong by a factor of 7."""
    random, n = np.random.default_rng(4), 120
    t = np.arange(n) / n
    apart = np.minimum(np.abs(t[:, None] - t), 1 - np.abs(t[:, None] - t))
    cover = np.exp(-apart / length) if length else np.eye(n)
    root, truth = np.linalg.cholesky(cover), cover.mean()
    found = []
    for _ in range(9):
        noise = root @ random.normal(size=n)
        mean = noise.mean()
        one = estimate(noise - mean, np.ones((n, 1)), t, 1.0)
        found.append(one.covariance[0, 0])
    # Now and then slow noise is seen in white noise: the median does not mind.
    assert truth / 1.5 < np.median(found) < 1.5 * truth


@pytest.mark.slow
def test_intervals_hold_the_truth_as_often_as_they_say() -> None:
    hits = [hit(number, seed=3) for number in range(72)]
    assert all(one.lobes for one in hits)
    # Smooth noise may look like another curve; what differs from point to point does not.
    assert not any(one.misfit for one in hits if one.kind != "smooth")
    for name in QUANTITIES:
        share = np.mean([getattr(one, name) for one in hits])
        # Three standard deviations of 72 tries at 95 %.
        assert share > 0.95 - 3 * (0.95 * 0.05 / 72) ** 0.5, name


@pytest.mark.parametrize(
    ("points", "said"),
    [
        (np.zeros((40, 2)), "1 different"),
        (np.zeros((40, 3)), "shape"),
        (np.full((40, 2), np.nan), "not finite"),
        (outline(2, 1700.0, 12), "12 different"),
    ],
)
def test_what_is_no_outline_is_refused(points: np.ndarray, said: str) -> None:
    with pytest.raises(SpecError, match=said):
        fit_outline(points)


@pytest.mark.parametrize(
    "options", [{"lobes": 1}, {"level": 1.0}, {"level": 0.0}, {"diameter": -1.0}]
)
def test_wrong_options_are_refused(options: dict[str, float]) -> None:
    with pytest.raises(SpecError) as caught:
        fit_outline(outline(2, 1700.0, 40), **options)
    assert caught.value.key in options
