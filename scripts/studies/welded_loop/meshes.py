"""The same on meshes: which rods keep the flat film flat, and a twisted film itself."""

from __future__ import annotations

from math import ceil, pi

import numpy as np

from eulerplateau.film import AreaFilm
from eulerplateau.film.harmonic import follower
from eulerplateau.loop import Twist
from eulerplateau.mesh import Disk
from eulerplateau.mesh.polygon import ellipse_perimeter
from eulerplateau.solvers import Equilibrium, Problem, solve, sweep
from scripts.studies.common import make_mesh

# The start, an ellipse, fixes which way the lobes lie and nothing else.
ASPECT = 2.0
# By how many steps a rod is turned once: by longer ones strands meet on the way.
_STEPS_A_TURN = 12


def ellipse(loop_edges: int) -> Disk:
    """Return a mesh of the ellipse."""
    return make_mesh(
        polygon={"kind": "ellipse", "aspect": ASPECT},
        edge_length=ellipse_perimeter(ASPECT) / loop_edges,
    )


def keeping_ratio(mesh: Disk, load: float) -> float:
    """Return C/B above which the flat film of two lobes at a load stays flat.

    Its second variation across the plane is K + 4 pi^2 gamma w w^T, w the slope of the
    writhe: singular where 4 pi^2 gamma w^T K^-1 w = -1.
    """
    film = AreaFilm(mesh.loop, mesh.interior)
    problem = Problem(mesh, "area", in_plane=True)
    found = solve(problem, load)
    stiffness, rigid = _across_plane(problem, film, found)
    x = found.shape.x_loop
    slope = Twist(problem.loop, 1.0, 0.0).rate("link", x)
    assert slope is not None
    w = -slope[:, 2] / (8 * pi**2)
    others = np.linalg.qr(rigid, mode="complete")[0][:, rigid.shape[1] :]
    inside = others.T @ stiffness @ others
    compliance = (others.T @ w) @ np.linalg.solve(inside, others.T @ w)
    return float(-1 / (8 * pi**2 * compliance))


def _across_plane(
    problem: Problem, film: AreaFilm, found: Equilibrium
) -> tuple[np.ndarray, np.ndarray]:
    """Return the second variation (n, n) across a flat film's plane, and rigid motions."""
    loop, shape = problem.loop, found.shape
    tiling = film.tiling(shape.triangles)
    pull = follower(tiling, tiling.sides(shape.x)).condensed.stiffness
    stiffness = 2 * loop.bending_matrix + loop.tension_stiffness(found.tensions)
    flat = np.linalg.svd(shape.x_loop, full_matrices=False)[0][:, :2]
    return stiffness + found.load * pull, np.column_stack([np.ones(len(flat)), flat])


def twisted_film(mesh: Disk, load: float, twist_ratio: float, link: float) -> Equilibrium:
    """Return the film on a mesh that follows the flat one as the rod is turned."""
    problem = Problem(mesh, "area", twist_ratio=twist_ratio)
    flat = solve(Problem(mesh, "area", in_plane=True), load)
    links = np.linspace(0.0, link, ceil(_STEPS_A_TURN * link) + 1)[1:]
    *_, last = sweep(problem, None, flat.shape, parameter="link", values=links, load=load)
    return last


def curved_film(
    loop_edges: int, load: float, ratio: float, link: float, curvature: float
) -> tuple[Equilibrium, dict[str, float]]:
    """Return the film a bent disk leads to, of a rod that is curved by nature.

    And what a table says of the rod, by columns.
    """
    mesh = make_mesh(polygon={"kind": "circle"}, edge_length=2 * pi / loop_edges)
    bent = mesh.x.copy()
    bent[:, 2] += 2 * bent[:, 0] * bent[:, 1]
    problem = Problem(mesh, "area", twist_ratio=ratio, link=link, rest_curvature=curvature)
    found = solve(problem, load, bent)
    return found, problem.said_of_loop(found.shape)[0]


def richardson(edges: tuple[int, ...], values: list[float]) -> tuple[float, float, float]:
    """Return the limit of second-order values, its error, and the fitted order.

    A fit of v + a h^2 + b h^4; the error is how far the limit moves when the coarsest mesh
    is left out, or the finest.
    """
    h = 1 / np.array(edges, dtype=float)
    v = np.array(values)

    def limit(chosen: slice) -> float:
        powers = np.vander(h[chosen] ** 2, 3, increasing=True)
        return float(np.linalg.lstsq(powers, v[chosen], rcond=None)[0][0])

    best = limit(slice(None))
    error = max(abs(limit(slice(1, None)) - best), abs(limit(slice(None, -1)) - best))
    order = np.polyfit(np.log(h), np.log(np.abs(v - best)), 1)[0]
    return best, error, float(order)
