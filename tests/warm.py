"""Compile what Numba compiles, once for all who run the tests: `python -m tests.warm`.

Small films and cells of every kind are solved for. What that compiles is kept next to the
modules, as it is whenever they are used; if this is interrupted, the next to need the rest
compiles it.
"""

from __future__ import annotations

import numpy as np

from eulerplateau.branches.conformal import Start, rod_film
from eulerplateau.cells import Cell, regular_sites, solve_cell, strands_near
from eulerplateau.exact import relax, relax_in_plane
from eulerplateau.mesh import film_touches
from eulerplateau.solvers import SOLVERS, Problem, solve
from tests.helpers import shapes


def warm() -> None:
    """Solve for one film of each kind by each solver, for films without a mesh, a cell."""
    mesh = shapes.mesh_of(*shapes.disk_points(6, jitter=0.1))
    start = shapes.crumpled(mesh, 1e-2)
    films = Problem(mesh), Problem(mesh, "area"), Problem(mesh, "area", in_plane=True)
    for problem in films:
        for solver in SOLVERS:
            solve(problem, 1000.0, start, solver=solver, max_iterations=8)
    for curvature in (0.0, 0.5):
        rod = Problem(mesh, twist_ratio=0.75, link=0.3, rest_curvature=curvature)
        solve(rod, 500.0, start, max_iterations=8)
    thick = Problem(mesh, "area", diameter=0.05)
    solve(thick, 500.0, start, max_iterations=8)
    film_touches(mesh.shape.moved(start), 0.01)
    angle = 2 * np.pi * np.arange(200) / 200
    ellipse = np.stack([1.3 * np.cos(angle), np.sin(angle)], axis=1)
    relax_in_plane(ellipse, 1600.0, 16, 2)
    relax(np.pad(ellipse, ((0, 0), (0, 1))), 1600.0, 8)
    rod_film(Start.DISK, 1000.0, 0.75, 0.2)
    cell = solve_cell(Cell(regular_sites(3), 8), 10.0, 60.0)
    strands_near(cell.x)


if __name__ == "__main__":
    warm()
