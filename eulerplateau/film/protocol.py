"""What a film is to everything above it: forces on a shape, and an energy of its loop.

The films do not import this file; they only do what it says.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Protocol

from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray
from eulerplateau.film.load import Load
from eulerplateau.loop import Loop, LoopEnergy
from eulerplateau.mesh import Shape

if TYPE_CHECKING:
    from eulerplateau.film.refinement import Finer


class Film(Protocol):
    """A film across a disk. Energies in units of alpha / L, loads the film's own.

    Shapes have the vertices of the disk, and its triangles or others; a soap film may have
    more of them inside, behind the disk's.
    """

    @property
    def load(self) -> Load:
        """Which load it is, and its names."""

    @property
    def dimension(self) -> int:
        """Coordinates of its loops as a function of which it is known: 3, or 2."""

    def energy_gradient(self, shape: Shape, load: float) -> tuple[float, FloatArray]:
        """Return the film's energy on a shape and its gradient (n_v, 3)."""

    def forces(self, shape: Shape) -> FloatArray:
        """Return the forces (n_v, 3) of unit load, of them those that do work.

        Inside a film at rest they vanish. Raises LinAlgError where there is no film.
        """

    def prepared(self, shape: Shape) -> Shape:
        """Return the shape made fit to start from: laid flat, thin triangles replaced."""

    def carried(self, shape: Shape, x_loop: FloatArray) -> Shape:
        """Return the shape after its loop has moved to x_loop (n_b, 3)."""

    @property
    def refines(self) -> bool:
        """Whether it may be finer than its mesh: not if it is tied to that."""

    def refined(self, shape: Shape, finer: Finer) -> Shape:
        """Return the shape as fine as that, if it may be; itself where it nearly is."""

    def of_loop(self, near: Shape) -> FilmOfLoop:
        """Return the film as a function of its loop, good near a shape."""

    def slide(self, loop: Loop, x_loop: FloatArray) -> FloatArray | None:
        """Return the loop's sliding along itself (n_b, 3) if the film does not resist it.

        See loop.sliding; None of a film that is tied to its rest mesh.
        """

    def pinched(self, shape: Shape, loop: Loop) -> bool:
        """Return whether the film has run out of width: strands of its loop meet."""

    def folded(self, shape: Shape) -> bool:
        """Return whether triangles lie on each other, and count what they do not span."""

    def touches(self, shape: Shape, diameter: float) -> bool:
        """Return whether the film comes against a rod so thick, or against itself."""


class FilmOfLoop(Protocol):
    """A film with its inside eliminated: a function of its loop, good near one shape.

    Loops x_loop are (n_b, d), d = 3, or 2 of a film that is kept in its plane.
    """

    def project(self, x: FloatArray) -> FloatArray:
        """Return positions (n, 3) in the loop's coordinates (n, d)."""

    def lift(self, x_loop: FloatArray) -> FloatArray:
        """Return a loop (n_b, d) in space (n_b, 3)."""

    def shape(self, x_loop: FloatArray) -> Shape:
        """Return the film at rest on a loop. Raises LinAlgError where there is none."""

    def force(self, x_loop: FloatArray) -> FloatArray:
        """Return the derivative (n_b, d) of the film's energy of unit load."""

    def displacement(self, x_loop: FloatArray, moved: FloatArray) -> FloatArray:
        """Return how the film (n_v, 3) follows a small move (n_b, d) of its loop."""

    def energy(self, loop: Loop, load: float) -> LoopEnergy:
        """Return bending plus the film's energy of the loop."""

    def made_at(self, x_loop: FloatArray) -> bool:
        """Return whether the film on this loop is the shape that this was made near."""

    def renewed(self, x_loop: FloatArray) -> FilmOfLoop:
        """Return the film as a function of its loop, good near the shape on this loop."""

    def released(self, x_loop: FloatArray) -> FilmOfLoop:
        """Return the film with all its vertices free, where that makes a difference.

        A curved soap film becomes a discrete minimal surface; other films are returned as
        they are.
        """

    def kept(self, x_loop: FloatArray) -> Mapping[str, NDArray[Any]]:
        """Return what makes it again, as one that knows the film on this loop alone."""

    def restored(self, kept: Mapping[str, NDArray[Any]]) -> FilmOfLoop:
        """Return the one that this was `kept` of; the same from any of a film's."""
