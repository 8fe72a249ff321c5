"""The discrete Euler-Plateau problem: film plus loop, in units L = alpha = 1.

Minimise E(x) = load * sum_e w_e |e|^2 + sum_v <s_v> kappa_v^2 (eq. discrete-energy) subject
to c_v(x) = (|e_v|^2 - s_v^2) / (2 s_v) = 0 for every loop edge.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.film import (
    FILMS,
    THIN,
    AreaFilm,
    Chart,
    Condensation,
    Film,
    PlaneFilm,
    balance,
    chart_at,
    condense,
    is_flat,
    minimal,
    plane_film,
    repaired,
)
from eulerplateau.loop import Loop, kernels, sliding, without
from eulerplateau.mesh import DiskMesh
from eulerplateau.solvers.equilibrium import (
    LARGEST_LOAD,
    RESOLVED_TURNING,
    Equilibrium,
    Status,
)

# Relative error of lengths up to which what a solver stopped at is a loop at all.
_CLOSED = 1e-3


@dataclass(frozen=True)
class Problem:
    """Everything a solver needs to know.

    Attributes
    ----------
    film, loop : the two energies
    loop_vertices : (n_b,) int, cyclic
    interior : (n_v - n_b,) int, all other vertices
    centre : (n_v, 3) float
        The shape near which a soap film is sought (chart.py); films of fixed weights need
        none.
    free : bool
        Whether that is a discrete minimal surface, whose vertices are free to move.
    """

    film: Film | AreaFilm | PlaneFilm
    loop: Loop
    loop_vertices: IntArray
    interior: IntArray
    centre: FloatArray | None = None
    free: bool = False

    @property
    def n_v(self) -> int:
        """Number of vertices."""
        return len(self.loop_vertices) + len(self.interior)

    @cached_property
    def condensed(self) -> Condensation | Chart:
        """The film with its interior eliminated; factorised on first use.

        Not of a film kept in its plane, which has no use for an interior.
        """
        if isinstance(self.film, PlaneFilm):
            raise TypeError("a film kept in its plane is not condensed")
        if isinstance(self.film, AreaFilm):
            centre = self.film.rest if self.centre is None else self.centre
            return chart_at(self.film, centre, self.free)
        laplacian = self.film.laplacian(self.n_v)
        return condense(laplacian, self.loop_vertices, self.interior)

    def near(self, x: FloatArray) -> Problem:
        """Return the problem with its film sought near a shape (n_v, 3).

        Thin triangles of a soap film are replaced by better ones: `centre` is then that
        shape with other vertices inside; of a free one by those of a minimal surface.
        """
        film = self.film
        if not isinstance(film, AreaFilm):
            return self
        if self.free and (freed := self.freed(x)) is not self:
            return freed
        if film.sides(x).smallest_angle < THIN:
            film, x = repaired(film, x)
        return replace(self, film=film, centre=x, free=False)

    def freed(self, x: FloatArray) -> Problem:
        """Return the problem with its film sought near the minimal surface next to x.

        The problem itself where there is none, and where the film is flat: then its
        vertices may lie anywhere.
        """
        if not isinstance(self.film, AreaFilm) or is_flat(self.film, x):
            return self
        found = minimal(self.film, x)
        if found is None:
            return self
        film, centre = found
        return replace(self, film=film, centre=centre, free=True)

    def at(self, x: FloatArray) -> Problem:
        """Return the problem with its film sought near x (n_v, 3), its triangles kept."""
        return replace(self, centre=x) if isinstance(self.film, AreaFilm) else self

    def with_triangles(self, triangles: IntArray) -> Problem:
        """Return the problem with a soap film's triangles (n_t, 3) replaced."""
        film = self.film
        if isinstance(film, PlaneFilm):
            return replace(self, film=replace(film, soap=film.soap.retiled(triangles)))
        assert isinstance(film, AreaFilm)
        return replace(self, film=film.retiled(triangles))

    def film_energy(self, x: FloatArray, load: float) -> tuple[float, FloatArray]:
        """Return the film's energy and its gradient (n_v, 3) at x (n_v, 3)."""
        return self.film.energy_gradient(x, load)

    def film_forces(self, x: FloatArray, load: float) -> FloatArray:
        """Return the film's forces (n_v, 3), which inside a film at rest vanish.

        A soap film's are those that do work: see `harmonic.balance`.
        """
        if isinstance(self.film, AreaFilm):
            return load * balance(self.film, x)
        return self.film_energy(x, load)[1]

    def bending_energy(self, x: FloatArray) -> tuple[float, FloatArray]:
        """Return the loop's bending energy and its gradient (n_v, 3) at x (n_v, 3)."""
        gradient = np.zeros_like(x)
        energy = kernels.bending_energy_gradient(
            x, self.loop_vertices, self.loop.rest_lengths, gradient
        )
        return energy, gradient

    def tension_force(self, x: FloatArray, multipliers: FloatArray) -> FloatArray:
        """Return J^T lambda (n_v, 3)."""
        force = np.zeros_like(x)
        force[self.loop_vertices] = self.loop.tension_force(
            x[self.loop_vertices], multipliers
        )
        return force

    def residual(self, x: FloatArray, multipliers: FloatArray, load: float) -> float:
        """Return the imbalance of forces over the largest force, both as max norms.

        Infinite where a soap film is so degenerate that there is no film or no loop.
        """
        bending, tension = self.bending_energy(x)[1], self.tension_force(x, multipliers)
        try:
            film = self.film_forces(x, load)
            total = self.unslid(x, bending + film + tension)
        except LinAlgError:
            return np.inf
        scale = max(float(np.abs(f).max()) for f in (bending, film, tension))
        return float(np.abs(total).max()) / scale if scale != 0 else 0.0

    def unslid(self, x: FloatArray, forces: FloatArray) -> FloatArray:
        """Return forces (n_v, 3) without what would slide a soap film's loop along itself.

        See motions.sliding; films of fixed weights are tied to their rest mesh.
        """
        if isinstance(self.film, Film):
            return forces
        on_loop = self.loop_vertices
        slide = sliding(self.loop, x[on_loop])
        rest = forces.copy()
        rest[on_loop] = without(slide, self.loop, forces[on_loop])
        return rest

    def length_error(self, x: FloatArray) -> float:
        """Return max |l_v / s_v - 1| over the loop's edges."""
        return self.loop.length_error(x[self.loop_vertices])

    def equilibrium(
        self, x: FloatArray, multipliers: FloatArray, load: float, status: Status
    ) -> Equilibrium:
        """Record a shape with all its numbers computed by the kernels on the full mesh."""
        film, pull = self.film_energy(x, load)
        bending = self.bending_energy(x)[0]
        pulls = np.abs(pull).max(axis=1)
        inside, strongest = pulls[self.interior].max(initial=0.0), pulls.max()
        return Equilibrium(
            x=x,
            multipliers=multipliers,
            load=load,
            energy=film + bending,
            film_energy=film,
            bending_energy=bending,
            residual=self.residual(x, multipliers, load),
            film_residual=float(inside / strongest) if strongest > 0.0 else 0.0,
            length_error=self.length_error(x),
            iterations=0,
            seconds=0.0,
            status=status,
        )

    def refused(self, x: FloatArray, load: float) -> Equilibrium | None:
        """Return the record of a start (n_v, 3) no solver can work with, or None."""
        if np.isfinite(x).all() and abs(load) <= LARGEST_LOAD:
            return None
        return Equilibrium(
            x=x,
            multipliers=np.zeros(len(self.loop_vertices)),
            load=load,
            energy=np.nan,
            film_energy=np.nan,
            bending_energy=np.nan,
            residual=np.nan,
            film_residual=np.nan,
            length_error=np.nan,
            iterations=0,
            seconds=0.0,
            status=Status.NOT_FINITE,
        )

    def pinched(self, x: FloatArray) -> bool:
        """Whether a soap film (n_v, 3) has run out of width: strands of its loop meet.

        Or, in its plane, have passed each other and turned the film inside out.
        """
        film = self.film
        if isinstance(film, Film):
            return False
        inside_out = isinstance(film, PlaneFilm) and film.energy_gradient(x, 1.0)[0] < 0
        return inside_out or self.loop.strands_meet(x[self.loop_vertices])

    def judged(self, found: Equilibrium) -> Equilibrium:
        """Return `found`; UNRESOLVED if it converged to a loop that its mesh cannot carry.

        And PINCHED if a soap film has run out of width: between strands that meet no disk
        is left to span, and what a solver makes of the mesh there means nothing. Every
        solution passes here before anybody sees it, whatever method found it.
        """
        loop = found.status is not Status.NOT_FINITE and found.length_error < _CLOSED
        if loop and self.pinched(found.x):
            return replace(found, status=Status.PINCHED)
        if not found.converged:
            return found
        turning = self.loop.largest_turning(found.x[self.loop_vertices])
        resolved = turning <= RESOLVED_TURNING
        return found if resolved else replace(found, status=Status.UNRESOLVED)


def make_problem(mesh: DiskMesh, film: str = "springs", *, plane: bool = False) -> Problem:
    """Build the problem on a mesh; `film` is a key of FILMS.

    In its plane a soap film ("area") needs its loop only. Raises MeshError where there is
    no plane to keep to.
    """
    made = plane_film(mesh) if plane else FILMS[film](mesh)
    return Problem(made, Loop(mesh.rest_lengths), mesh.loop, mesh.interior)
