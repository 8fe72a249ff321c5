"""Two methods for a loop that resists twist: films without a mesh, and meshes."""

from itertools import islice
from math import pi

import numpy as np
import pytest

from eulerplateau.branches.conformal import (
    Start,
    film_of,
    films_by_writhe,
    in_basis,
    rod_film,
    smooth_family,
    stiffness,
    tail,
)
from eulerplateau.branches.conformal.by_writhe import CONTROL
from eulerplateau.exact.conformal import edge, make_basis, waist
from eulerplateau.loop import polygon_writhe
from eulerplateau.solvers import Status
from scripts.studies.welded_loop.answers import at_load
from scripts.studies.welded_loop.curves import rows_at, stable_links
from scripts.studies.welded_loop.meshes import (
    ellipse,
    keeping_ratio,
    richardson,
    twisted_film,
)
from scripts.studies.welded_loop.starts import FINER, End, cases, run

EDGES = (48, 64, 96)


def test_twist_stiffens_flat_lobes_as_much_on_meshes():
    """C/B that would keep them flat: E_0''(0) without a mesh, w K^-1 w on meshes."""
    first = next(films_by_writhe(1800.0))
    smooth = -stiffness(first) / (8 * pi**2)
    errors = [keeping_ratio(ellipse(edges), 1800.0) - smooth for edges in EDGES]
    order = -np.polyfit(np.log(EDGES), np.log(np.abs(errors)), 1)[0]
    assert order == pytest.approx(2, abs=0.15)


def by_both_methods(load, ratio, link, edges):
    """Yield energy, area and writhe without a mesh, and on meshes."""
    found = rod_film(Start.LOBES, load, ratio, link)
    films = [twisted_film(ellipse(n), load, ratio, link) for n in edges]
    assert found.resolved
    assert all(film.is_minimum for film in films)
    yield found.energy, [film.energy for film in films]
    yield found.film.area, [film.film_energy / load for film in films]
    yield found.writhe, [polygon_writhe(film.shape.x_loop) for film in films]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("load", "ratio", "link"), [(1700.0, 2 / 3, 0.25), (1600.0, 1.0, 0.5)]
)
def test_twisted_film_is_the_limit_of_meshes(load, ratio, link):
    """Energy, area and writhe to 1e-5 by Richardson, with second order."""
    edges = (96, 128, 192, 256)
    for known, values in by_both_methods(load, ratio, link, edges):
        limit, _, order = richardson(edges, values)
        assert limit == pytest.approx(known, rel=1e-5)
        assert order == pytest.approx(2, abs=0.15)


@pytest.mark.slow
def test_film_that_is_all_but_closed_at_its_waist_is_the_limit_of_meshes():
    """At a waist of 0.012 L, 1.6 to 3.1 edges of the loop: to 1e-5, with second order.

    The writhe errs by a few parts in 1e5 on every mesh, as vertices happen to lie.
    """
    edges = (128, 160, 192, 256)
    assert rod_film(Start.LOBES, 1700.0, 1.0, 0.75).numbers()["waist"] < 0.0125
    energy, area, writhe = by_both_methods(1700.0, 1.0, 0.75, edges)
    for known, values in (energy, area):
        limit, _, order = richardson(edges, values)
        assert limit == pytest.approx(known, rel=1e-5)
        assert order == pytest.approx(2, abs=0.15)
    assert richardson(edges, writhe[1])[0] == pytest.approx(writhe[0], rel=1e-5)


@pytest.mark.slow
def test_pinching_film_is_balanced_the_better_the_more_harmonics():
    """At a waist of 0.01 L, to 1e-5 sigma; the moment falls to none as the waist closes."""
    *_, last = films_by_writhe(1700.0, narrowest=0.01)
    assert 0.01 < waist(film_of(last)) < 0.012

    def imbalance(point):
        family, film = smooth_family(point), film_of(point)
        moment = family.twist(point.value).moment(point.x)
        return edge(film).force_balance(1700.0, film.beta, moment)

    basis = smooth_family(last).basis
    finer = in_basis(last, make_basis(240, basis.family, basis.crowding / 3), CONTROL)
    assert finer is not None
    assert tail(finer) < 1e-10
    coarser = in_basis(last, make_basis(72, basis.family, basis.crowding), CONTROL)
    assert imbalance(finer) < 1e-5
    assert imbalance(coarser) > 10 * imbalance(finer)


@pytest.mark.slow
def test_isotropic_rods_have_a_stable_film_at_every_link():
    """At 1700 above C/B = 0.473, from flat to pinched; a softer rod snaps in between."""
    rows = rows_at(1700.0)
    assert 0.45 < at_load(rows).every < 0.5
    assert all(not row.index for row in rows)
    (low, high), *others = stable_links(rows, 2 / 3)
    assert not others
    assert low == pytest.approx(0, abs=1e-12)
    assert high > 0.8
    assert len(stable_links(rows, 0.2)) == 2


def test_first_films_hardly_writhe():
    writhes = [
        smooth_family(p).twist(p.value).writhe(p.x)
        for p in islice(films_by_writhe(1700.0, step=0.5), 3)
    ]
    assert writhes[0] == pytest.approx(0, abs=1e-12)
    assert 0 < writhes[1] < writhes[2] < 0.02


@pytest.mark.slow
def test_start_that_pinches_on_a_coarse_mesh_beside_a_fold_ends_wide_on_finer_ones():
    """On 72 edges the film with a wide waist folds at a smaller link than it should."""
    case = cases()[40]
    found = rod_film(Start.LOBES, case.load, case.twist_ratio, case.link)
    assert found.resolved
    assert found.n_unstable == 0
    assert found.numbers()["waist"] > 3 / 72
    assert run(case) == End(case, "pinched", 0)
    on_the_way = twisted_film(ellipse(72), case.load, case.twist_ratio, -case.link)
    assert on_the_way.status is Status.PINCHED
    for edges in FINER:
        assert run(case, edges) == End(case, "converged", 0)
