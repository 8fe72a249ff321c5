"""The exact films' functions take what a user has, and say in one line what they cannot."""

from __future__ import annotations

from collections.abc import Callable
from math import inf, nan, pi
from typing import Any

import numpy as np
import pytest

from eulerplateau import exact
from eulerplateau.errors import NOT_CONVERGED_EXIT_CODE, EulerPlateauError, SpecError
from eulerplateau.exact.conformal import flat_eight

ANGLES = 2 * pi * np.arange(96) / 96
OVAL = np.stack([1.3 * np.cos(ANGLES), np.sin(ANGLES), 0 * ANGLES], axis=1)


def in_space(**changed: Any) -> Any:
    given = {"start": OVAL, "tension": 1600.0, "harmonics": 8, "lobes": 2}
    return exact.relax(**(given | changed))


def in_plane(**changed: Any) -> Any:
    given = {"start": OVAL, "tension": 1600.0, "harmonics": 8, "lobes": 2}
    return exact.relax_in_plane(**(given | changed))


def planar(**changed: Any) -> Any:
    return exact.planar_film(**({"lobes": 2, "tension": 2000.0} | changed))


CALLS = [planar, in_space, in_plane]


@pytest.mark.parametrize("call", CALLS)
def test_results_print_in_one_short_line(call: Callable[..., Any]) -> None:
    film = call()
    for text in (repr(film), str(film)):
        assert "\n" not in text
        assert len(text) < 150
        assert f"energy={film.energy:.6g}"[:12] in text


@pytest.mark.parametrize("call", [in_space, in_plane])
def test_lists_are_as_good_as_arrays(call: Callable[..., Any]) -> None:
    assert call(start=OVAL.tolist()).energy == call().energy


def test_points_of_the_loop_may_be_asked_for_by_lists_and_numbers() -> None:
    s = [0.0, 0.25, 0.4]
    for film in (planar(), in_plane()):
        assert film.positions(s).shape == (3, 2)
        assert np.array_equal(film.curvature(s), film.curvature(np.array(s)))
        assert film.positions(0.25) == pytest.approx(film.positions(s)[1], abs=1e-15)


@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize("tension", [-1.0, nan, inf, None, "much", [1.0, 2.0], OVAL])
def test_wrong_tensions_are_refused(call: Callable[..., Any], tension: Any) -> None:
    with pytest.raises(
        SpecError, match=r"^tension: found .*finite and not negative"
    ) as told:
        call(tension=tension)
    assert "\n" not in str(told.value)


@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize("lobes", [1, 0, -3, 2.5, None, "two", nan, [2, 3]])
def test_wrong_numbers_of_lobes_are_refused(call: Callable[..., Any], lobes: Any) -> None:
    with pytest.raises(SpecError, match=r"^lobes: found .*whole number"):
        call(lobes=lobes)


@pytest.mark.parametrize("call", [in_space, in_plane])
@pytest.mark.parametrize("harmonics", [0, -1, 7.5, None, "8"])
def test_wrong_numbers_of_harmonics_are_refused(
    call: Callable[..., Any], harmonics: Any
) -> None:
    with pytest.raises(SpecError, match=r"^harmonics: found .*whole number"):
        call(harmonics=harmonics)


STARTS = [
    None,
    [],
    "circle",
    OVAL[0],
    OVAL[:, :1],
    OVAL[None],
    np.hstack([OVAL, OVAL]),
    [[0.0, 1.0], [1.0]],
    OVAL[:10],
    np.where(OVAL[5] == OVAL, nan, OVAL),
    np.where(OVAL[5] == OVAL, inf, OVAL),
    1j * OVAL,
]


@pytest.mark.parametrize("call", [in_space, in_plane])
@pytest.mark.parametrize("start", STARTS)
def test_wrong_starts_are_refused(call: Callable[..., Any], start: Any) -> None:
    with pytest.raises(SpecError, match=r"^start: ") as told:
        call(start=start)
    assert "\n" not in str(told.value)


def test_a_start_in_the_plane_has_two_coordinates_for_plane_films_only() -> None:
    assert in_plane(start=OVAL[:, :2]).energy == in_plane().energy
    with pytest.raises(SpecError, match=r"start: found shape \(96, 2\); .*\(points, 3\)"):
        in_space(start=OVAL[:, :2])


@pytest.mark.parametrize("load", [-1.0, nan, inf, None, 5127.72, "heavy"])
def test_wrong_loads_of_the_flat_eight_are_refused(load: Any) -> None:
    with pytest.raises(SpecError, match=r"^load: found"):
        flat_eight(load)


def test_branches_that_end_raise_the_projects_error() -> None:
    from eulerplateau.exact.conformal import BranchError

    assert issubclass(BranchError, EulerPlateauError)
    assert BranchError.exit_code == NOT_CONVERGED_EXIT_CODE


@pytest.mark.parametrize("load", [-1.0, nan, inf, None])
def test_wrong_loads_of_a_branch_are_refused_at_once(load: Any) -> None:
    from eulerplateau.exact.conformal import PLANAR, disk, go_to_load, make_basis, start

    point = start(disk(make_basis(8, PLANAR), 1000.0))
    with pytest.raises(SpecError, match=r"^load: found"):
        go_to_load(point, load)
