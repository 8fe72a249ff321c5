"""The eight in contact on meshes: what they are off by from the film without a mesh.

The meshes are plain round disks of even edges. A film begins where the mesh-free one's loop
is, spanned across it by the mesh's harmonic functions.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import pi

import numpy as np
from scipy.interpolate import CubicSpline

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.conformal import ThickEight, thick_eight
from eulerplateau.exact.conformal import ConformalFilm
from eulerplateau.mesh import Disk, mesh_polygon
from eulerplateau.solvers import Equilibrium, Problem, solve

# Diameter, load, C / B and Lk.
CASES = (
    (0.05, 1700.0, 0.0, 0.0),
    (0.05, 2500.0, 0.0, 0.0),
    (0.05, 1700.0, 2 / 3, 1.0),
    (0.02, 1700.0, 0.0, 0.0),
    (0.02, 2500.0, 0.0, 0.0),
    (0.02, 1700.0, 2 / 3, 1.0),
    (0.01, 1700.0, 0.0, 0.0),
    (0.005, 1700.0, 0.0, 0.0),
)
EDGES = (60, 120, 240)
# Points at which arclength along a loop is tabulated.
_TABLE = 4096


@dataclass(frozen=True)
class Off:
    """By what a mesh of n_b loop edges is off.

    Energy and force relative to the mesh-free film's, the angle in degrees.
    """

    n_b: int
    energy: float
    force: float
    angle: float
    n_unstable: int | None

    @property
    def numbers(self) -> tuple[float, float, float]:
        """Energy, force and angle."""
        return self.energy, self.force, self.angle


def round_disk(edges: int) -> Disk:
    """Return a round disk of so many loop edges, and inside of edges as long."""
    length = 2 * np.sin(pi / edges)
    return mesh_polygon("regular", sides=edges, edge_length=length)


def along(film: ConformalFilm, t: FloatArray) -> FloatArray:
    """Return points (n, 3) of a film's loop at arclengths t (n,), of the whole loop's."""
    phi = np.linspace(0.0, 2 * pi, _TABLE + 1)
    speed = np.linalg.norm(film.basis.at(film.coefficients, phi).x1, axis=1)
    arc = CubicSpline(phi, speed).antiderivative()(phi)
    at = CubicSpline(arc / arc[-1], phi)(np.mod(t, 1.0))
    return film.basis.at(film.coefficients, at).x


def eight_on(
    mesh: Disk, exact: ThickEight, shift: float = 0.0, *, refine: bool = False
) -> Equilibrium:
    """Return what a mesh's film comes to from a mesh-free one's loop, at its values.

    The mesh is shifted along the loop by a part of an edge, and finer at the contact if
    `refine` is true.
    """
    t = np.cumsum(mesh.rest_lengths) + shift / mesh.n_b
    film = Problem(mesh).tied_film()
    if film is None:
        raise ArithmeticError(f"no film across {mesh}")
    start = film.shape(along(exact.film, t))
    problem = Problem(
        mesh,
        "area",
        twist_ratio=exact.twist_ratio or None,
        link=exact.link,
        diameter=exact.diameter,
        refine=refine,
    )
    return solve(problem, exact.film.load, start)


def off(found: Equilibrium, exact: ThickEight) -> Off:
    """Return what a mesh's film is off by; there must be one point of contact."""
    contacts = found.contacts
    if not found.converged or contacts is None or len(contacts) != 1:
        raise ArithmeticError(f"no film with one point of contact: {found}")
    return Off(
        len(found.shape.loop),
        found.energy / exact.energy - 1,
        contacts.force / exact.contact_force - 1,
        float(contacts.angles[0]) - exact.crossing_angle,
        found.n_unstable,
    )


def limit(rows: Sequence[Off]) -> tuple[float, ...]:
    """Return what the two finest are off by, errors of second order taken out."""
    coarse, fine = rows[-2:]
    more = (fine.n_b / coarse.n_b) ** 2 - 1
    pairs = zip(coarse.numbers, fine.numbers, strict=True)
    return tuple(at + (at - before) / more for before, at in pairs)


def orders(rows: Sequence[Off]) -> tuple[float, ...]:
    """Return the fitted powers of the edge length that energy, force and angle go with."""
    sizes = np.log([row.n_b for row in rows])
    errors = np.log(np.abs([row.numbers for row in rows]))
    return tuple(-np.polyfit(sizes, errors, 1)[0])


def table() -> Iterator[list[str]]:
    """Yield a head, then for every case its meshes, their limit and the orders."""
    yield ["d", "load", "C/B", "edges", "energy", "force", "angle", "unstable"]
    for diameter, load, ratio, link in CASES:
        exact = thick_eight(load, diameter, ratio, link)
        case = [f"{diameter:g}", f"{load:g}", f"{ratio:.2g}"]
        rows = [off(eight_on(round_disk(edges), exact), exact) for edges in EDGES]
        for row in rows:
            yield [*case, str(row.n_b), *shown(row.numbers), str(row.n_unstable)]
        yield [*case, "limit", *shown(limit(rows)), str(exact.n_unstable)]
        yield [*case, "order", *(f"{order:.2f}" for order in orders(rows)), ""]


def shown(errors: Sequence[float]) -> list[str]:
    """Return how much energy, force and angle are off by, to be read."""
    energy, force, angle = errors
    return [f"{energy:.1e}", f"{force:.1e}", f"{angle:.4f}"]
