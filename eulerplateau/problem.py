"""The discrete Euler-Plateau problem: film plus loop, in units L = alpha = 1.

Minimise E(x) = load * sum_e w_e |e|^2 + sum_v <s_v> kappa_v^2 (eq. discrete-energy) subject
to c_v(x) = (|e_v|^2 - s_v^2) / (2 s_v) = 0 for every loop edge.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from eulerplateau import kernels
from eulerplateau.condensation import Condensation, condense
from eulerplateau.film import FILMS, Film
from eulerplateau.loop import Loop
from eulerplateau.mesh import DiskMesh, FloatArray, IntArray
from eulerplateau.solution import Equilibrium, Status


@dataclass(frozen=True)
class Problem:
    """Everything a solver needs to know.

    Attributes
    ----------
    film, loop : the two energies
    loop_vertices : (n_b,) int, cyclic
    interior : (n_v - n_b,) int, all other vertices
    """

    film: Film
    loop: Loop
    loop_vertices: IntArray
    interior: IntArray

    @property
    def n_v(self) -> int:
        """Number of vertices."""
        return len(self.loop_vertices) + len(self.interior)

    @cached_property
    def condensed(self) -> Condensation:
        """The film with its interior eliminated; factorised on first use."""
        laplacian = self.film.laplacian(self.n_v)
        return condense(laplacian, self.loop_vertices, self.interior)

    def film_energy(self, x: FloatArray, load: float) -> tuple[float, FloatArray]:
        """Return the film's energy and its gradient (n_v, 3) at x (n_v, 3)."""
        gradient = np.zeros_like(x)
        energy = kernels.film_energy_gradient(
            x, self.film.edges, load * self.film.weights, gradient
        )
        return energy, gradient

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
        """Return the imbalance of forces over the largest force, both as max norms."""
        forces = (
            self.bending_energy(x)[1],
            self.film_energy(x, load)[1],
            self.tension_force(x, multipliers),
        )
        scale = max(float(np.abs(f).max()) for f in forces)
        return float(np.abs(sum(forces)).max()) / scale if scale > 0 else 0.0

    def length_error(self, x: FloatArray) -> float:
        """Return max |l_v / s_v - 1| over the loop's edges."""
        return self.loop.length_error(x[self.loop_vertices])

    def equilibrium(
        self, x: FloatArray, multipliers: FloatArray, load: float, status: Status
    ) -> Equilibrium:
        """Record a shape with all its numbers computed by the kernels on the full mesh."""
        film = self.film_energy(x, load)[0]
        bending = self.bending_energy(x)[0]
        return Equilibrium(
            x=x,
            multipliers=multipliers,
            load=load,
            energy=film + bending,
            film_energy=film,
            bending_energy=bending,
            residual=self.residual(x, multipliers, load),
            length_error=self.length_error(x),
            iterations=0,
            seconds=0.0,
            status=status,
        )


def make_problem(mesh: DiskMesh, film: str = "springs") -> Problem:
    """Build the problem on a mesh; `film` is a key of FILMS."""
    return Problem(FILMS[film](mesh), Loop(mesh.rest_lengths), mesh.loop, mesh.interior)
