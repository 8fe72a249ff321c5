"""A shape: where the vertices of a triangulated surface are, and what joins them."""

from __future__ import annotations

from dataclasses import dataclass, replace

from eulerplateau.arrays import FloatArray, IntArray


@dataclass(frozen=True, eq=False, repr=False)
class Shape:
    """A triangulated surface bounded by a loop; lengths in units of L.

    Attributes
    ----------
    x : (n_v, 3) float
    triangles : (n_t, 3) int
        Counter-clockwise seen from the side the film's normal points to.
    loop : (n_b,) int
        Its boundary vertices, cyclic, with the film on the left.
    """

    x: FloatArray
    triangles: IntArray
    loop: IntArray

    def __repr__(self) -> str:
        """Return one line: how many vertices, triangles and loop vertices."""
        sizes = f"{len(self.x)} vertices, {len(self.triangles)} triangles"
        return f"<Shape: {sizes}, {len(self.loop)} vertices on the loop>"

    @property
    def x_loop(self) -> FloatArray:
        """Positions of the loop (n_b, 3)."""
        return self.x[self.loop]

    def moved(self, x: FloatArray) -> Shape:
        """Return the surface with its vertices at x (n_v, 3)."""
        return replace(self, x=x)
