"""The discrete Euler-Plateau problem: disk, film and loop, in units L = alpha = 1.

Minimise E(x) = load * sum_e w_e |e|^2 + sum_v <s_v> kappa_v^2 (eq. discrete-energy) subject
to c_v(x) = (|e_v|^2 - s_v^2) / (2 s_v) = 0 for every loop edge.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass, replace

import numpy as np
from numpy.linalg import LinAlgError
from numpy.typing import ArrayLike

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import MeshError, SpecError
from eulerplateau.film import Film, FilmOfLoop, make_film
from eulerplateau.loop import Loop, Rod, largest_turning, remove_sliding
from eulerplateau.mesh import Disk, Shape
from eulerplateau.solvers.equilibrium import (
    LARGEST_LOAD,
    RESOLVED_TURNING,
    Equilibrium,
    Stability,
    Status,
    not_finite,
    with_stability,
)

# Relative error of lengths up to which what a solver stopped at is a loop at all; by which
# part of the diameter strands may overlap between the places they are held at.
_CLOSED, _OVERLAP = 1e-3, 1e-5


@dataclass(frozen=True, init=False, repr=False)
class Problem:
    """Everything a solver needs to know.

    Attributes
    ----------
    disk : the mesh at rest
    film, loop : the two energies
    refines : whether a soap film is made finer where strands of a thick loop cross
    """

    disk: Disk
    film: Film
    loop: Loop
    refines: bool

    def __init__(
        self,
        disk: Disk,
        film: str | Film = "springs",
        *,
        in_plane: bool = False,
        twist_ratio: float | None = None,
        link: float = 0.0,
        rest_curvature: float = 0.0,
        diameter: float | None = None,
        refine: bool = True,
    ) -> None:
        """Span a disk by a film: "springs", "dirichlet", "area", or a film of one's own.

        `in_plane` keeps a film of true area in the plane of its disk. With `twist_ratio`,
        the rigidities' C / B, the loop resists twist: it was turned `link` times and then
        welded; by nature it is `rest_curvature` times as curved as a circle of its length.
        With a `diameter`, in units of L, its strands touch and pass through nothing; where
        they cross, loop and film of true area are finer, unless `refine` is false. Raises
        SpecError for an unknown film or a wrong number, MeshError for an unfit disk.
        """
        if not isinstance(disk, Disk):
            problem = f"found {type(disk).__name__}; read_disk and mesh_polygon return one"
            raise SpecError("disk", problem)
        made = make_film(disk, film, in_plane=in_plane) if isinstance(film, str) else film
        object.__setattr__(self, "disk", disk)
        object.__setattr__(self, "film", made)
        rod = Rod(twist_ratio, link, rest_curvature, diameter)
        object.__setattr__(self, "loop", rod.loop(disk.rest_lengths, in_plane))
        finer = refine and made.refines and diameter is not None
        object.__setattr__(self, "refines", finer)

    def __repr__(self) -> str:
        """Return one line: the film, and the size of its mesh."""
        film = type(self.film).__name__
        return f"<Problem: {film} on {self.disk.n_v} vertices, {self.disk.n_b} on the loop>"

    def value(self, parameter: str, load: float) -> float:
        """Return a parameter of the energy: the load, or one of the loop's own."""
        return {"load": load, **self.loop.parameters}[parameter]

    def at(self, parameter: str, value: float, load: float) -> tuple[Problem, float]:
        """Return the problem and its load at another value of one of these parameters."""
        if parameter == "load":
            return self, value
        return self.with_loop(self.loop.with_value(parameter, value)), load

    def with_loop(self, loop: Loop) -> Problem:
        """Return the same film on another loop of as many edges."""
        made = copy(self)
        object.__setattr__(made, "loop", loop)
        return made

    def shape(self, x: ArrayLike) -> Shape:
        """Return the disk with its vertices at x (n_v, 3), in units of L.

        Raises SpecError for another size.
        """
        try:
            positions = np.array(x, dtype=np.float64)
        except (TypeError, ValueError):
            raise SpecError("start", "should be three numbers for a vertex") from None
        wanted = self.disk.x.shape
        if positions.shape != wanted:
            raise SpecError("start", f"has shape {positions.shape}; should be {wanted}")
        return self.disk.shape.moved(positions)

    def tied_film(self) -> FilmOfLoop | None:
        """Return the film of least Dirichlet energy, tied to the mesh as it was given.

        It can be spanned across any loop, however crumpled. None if the mesh is no good.
        """
        try:
            return make_film(self.disk, "dirichlet").of_loop(self.disk.shape)
        except (MeshError, LinAlgError):
            return None

    def loop_of(self, shape: Shape) -> Loop:
        """Return the loop of a shape, finer than the mesh's where its film was refined."""
        same = len(shape.loop) == self.disk.n_b
        return self.loop if same else self.loop.cut(self.disk.parts(shape.loop))

    def bending_energy(self, shape: Shape) -> tuple[float, FloatArray]:
        """Return the loop's bending energy and its gradient (n_v, 3)."""
        loop, x = self.loop_of(shape), shape.x_loop
        return loop.bending_energy(x), self.on_loop(shape, loop.bending_force(x))

    def energy(self, shape: Shape, load: float) -> float:
        """Return the energy of film and loop together."""
        film, bending = self.film.energy_gradient(shape, load), self.bending_energy(shape)
        terms = self.loop_of(shape).terms.values()
        return film[0] + bending[0] + sum(term.energy(shape.x_loop) for term in terms)

    def loop_forces(self, shape: Shape) -> list[FloatArray]:
        """Return the gradient (n_v, 3) of what the loop's energy has beside its bending."""
        terms = self.loop_of(shape).terms.values()
        return [self.on_loop(shape, term.force(shape.x_loop)) for term in terms]

    def said_of_loop(self, shape: Shape) -> tuple[dict[str, float], dict[str, FloatArray]]:
        """Return what that says in tables and, as fields (n_v, 3), in shapes.

        Fields are NaN inside the film.
        """
        columns: dict[str, float] = {}
        fields: dict[str, FloatArray] = {}
        for term in self.loop_of(shape).terms.values():
            columns |= term.columns(shape.x_loop)
            for name, on_loop in term.fields(shape.x_loop).items():
                fields[name] = np.full_like(shape.x, np.nan)
                fields[name][shape.loop] = on_loop
        return columns, fields

    def on_loop(self, shape: Shape, forces: FloatArray) -> FloatArray:
        """Return forces (n_v, 3) that are those on the loop (n_b, 3), and else 0."""
        whole = np.zeros_like(shape.x)
        whole[shape.loop] = forces
        return whole

    def tension_force(self, shape: Shape, tensions: FloatArray) -> FloatArray:
        """Return J^T lambda (n_v, 3) for the tensions lambda (n_b,) of the loop's edges."""
        loop = self.loop_of(shape)
        return self.on_loop(shape, loop.tension_force(shape.x_loop, tensions))

    def residual(
        self,
        shape: Shape,
        tensions: FloatArray,
        load: float,
        pushes: FloatArray | None = None,
    ) -> float:
        """Return the imbalance of forces over the largest force, both as max norms.

        pushes : (n_b, 3) float, the gradient that contacts add, if there are any.

        Infinite where a soap film is so degenerate that there is no film or no loop.
        """
        bending = self.bending_energy(shape)[1]
        tension = self.tension_force(shape, tensions)
        try:
            film = load * self.film.forces(shape)
            parts = [bending, film, tension, *self.loop_forces(shape)]
            if pushes is not None:
                parts.append(self.on_loop(shape, pushes))
            total = self.without_sliding(shape, sum(parts[1:], start=parts[0]))
        except LinAlgError:
            return np.inf
        scale = max(float(np.abs(part).max()) for part in parts)
        return float(np.abs(total).max()) / scale if scale != 0 else 0.0

    def without_sliding(self, shape: Shape, forces: FloatArray) -> FloatArray:
        """Return forces (n_v, 3) less what slides the loop along itself for nothing.

        Films of fixed weights are tied to their rest mesh: their forces stay as they are.
        """
        loop = self.loop_of(shape)
        slide = self.film.slide(loop, shape.x_loop)
        if slide is None:
            return forces
        rest = forces.copy()
        rest[shape.loop] = remove_sliding(slide, loop, forces[shape.loop])
        return rest

    def length_error(self, shape: Shape) -> float:
        """Return max |l_v / s_v - 1| over the loop's edges."""
        return self.loop_of(shape).length_error(shape.x_loop)

    def pinched(self, shape: Shape) -> bool:
        """Return whether strands meet where there is no film, or no loop, beyond that."""
        loop = self.loop_of(shape)
        return loop.pinched(shape.x_loop) or self.film.pinched(shape, loop)

    def equilibrium(
        self,
        shape: Shape,
        tensions: FloatArray,
        load: float,
        status: Status,
        pushes: FloatArray | None = None,
    ) -> Equilibrium:
        """Record a shape with all its numbers computed on the full mesh."""
        film, pull = self.film.energy_gradient(shape, load)
        bending, terms = self.bending_energy(shape)[0], self.loop_of(shape).terms.items()
        loop = {name: term.energy(shape.x_loop) for name, term in terms}
        pulls = np.abs(pull).max(axis=1)
        inside, strongest = np.delete(pulls, shape.loop).max(initial=0.0), pulls.max()
        return Equilibrium(
            shape=shape,
            tensions=tensions,
            load=load,
            energy=film + bending + sum(loop.values()),
            film_energy=film,
            bending_energy=bending,
            loop_energies=loop,
            residual=self.residual(shape, tensions, load, pushes),
            film_residual=float(inside / strongest) if strongest > 0.0 else 0.0,
            length_error=self.length_error(shape),
            iterations=0,
            seconds=0.0,
            status=status,
        )

    def record(
        self,
        shape: Shape,
        tensions: FloatArray,
        load: float,
        status: Status,
        stability: Stability | None,
        iterations: int,
    ) -> Equilibrium:
        """Return what a search has come to, with the status its stability gives it."""
        found = self.equilibrium(shape, tensions, load, status)
        return with_stability(replace(found, iterations=iterations), stability)

    def unusable_start(self, shape: Shape, load: float) -> Equilibrium | None:
        """Return the record of a start no solver can work with, or None."""
        usable = np.isfinite(shape.x).all() and abs(load) <= LARGEST_LOAD
        return None if usable else not_finite(shape, load)

    def classified(self, found: Equilibrium) -> Equilibrium:
        """Return `found`; UNRESOLVED if it converged to a loop that its mesh cannot carry.

        FOLDED if triangles of a soap film lie on each other, whose area is not spanned. And
        PINCHED if a soap film has run out of width: between strands that meet no disk
        is left to span, and what a solver makes of the mesh there means nothing; or if
        strands of a twisted rod meet, which do not pass through each other. FILM_TOUCHED
        if the film on a loop that has a diameter comes against the rod or against itself.
        Every solution passes here before anybody sees it, whatever method found it.
        """
        loop = found.status is not Status.NOT_FINITE and found.length_error < _CLOSED
        if loop and self.pinched(found.shape):
            return replace(found, status=Status.PINCHED)
        if loop and self.loop_of(found.shape).is_too_thick(found.shape.x_loop):
            return replace(found, status=Status.TOO_THICK)
        if not found.converged:
            return found
        turning = largest_turning(found.shape.x_loop)
        if turning > RESOLVED_TURNING:
            return replace(found, status=Status.UNRESOLVED)
        if self.film.folded(found.shape):
            return replace(found, status=Status.FOLDED)
        diameter = self.loop.diameter
        if diameter is None:
            return found
        if found.overlap > _OVERLAP * diameter:
            return replace(found, status=Status.UNRESOLVED)
        if self.film.touches(found.shape, diameter):
            return replace(found, status=Status.FILM_TOUCHED)
        return found
