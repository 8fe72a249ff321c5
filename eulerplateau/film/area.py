"""The true soap film: its energy is sigma times its area (eq. continuum-energy).

Its inside has no rest state: where vertices lie, and which triangles join them, is no part
of the film's state, and is chosen anew wherever triangles get thin (repair.py). As a
function of its loop it is known near one shape at a time (interior.py).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.film.area_term import Area
from eulerplateau.film.folds import is_folded, laid_anew
from eulerplateau.film.free_film import FreeFilm
from eulerplateau.film.free_moves import FreeInterior
from eulerplateau.film.harmonic import Follower, balance, follower
from eulerplateau.film.heights_film import HeightsFilm
from eulerplateau.film.indefinite import IndefiniteFactor
from eulerplateau.film.interior import LocalFilm
from eulerplateau.film.load import TENSION, Load
from eulerplateau.film.minimal_surface import find_minimal_surface, is_flat
from eulerplateau.film.normal_moves import normal_heights
from eulerplateau.film.repair import carry_along, mend_triangles
from eulerplateau.film.tiling import LIMITS, Tiling, TriangleGeometry
from eulerplateau.film.with_loop import LoopStiffness
from eulerplateau.loop import (
    FilmLengths,
    Loop,
    LoopEnergy,
    free_motions,
    inextensible,
    sliding,
)
from eulerplateau.mesh import Shape

if TYPE_CHECKING:
    from eulerplateau.film.refinement import Finer

# Tilings whose patterns are kept: of a sweep on a few meshes none is planned twice.
_KEPT = 4

# Re-weighting brings a rough film near: until it gains less than this part of the area.
_NEAR = 1e-3
_REWEIGHTINGS = 6


@dataclass(frozen=True, repr=False)
class AreaFilm:
    """A film whose energy is load * area, load = sigma L^3 / alpha.

    Attributes
    ----------
    loop, interior : (n_b,) and (n_v - n_b,) int
    """

    loop: IntArray
    interior: IntArray
    load: Load = TENSION
    _tilings: list[Tiling] = field(default_factory=list, repr=False, compare=False)
    _recent: list[AreaOfLoop] = field(default_factory=list, repr=False, compare=False)
    refines = True

    def __repr__(self) -> str:
        """Return one line: how many vertices, and the load's name."""
        return f"<AreaFilm: {self.n_v} vertices, load {self.load.text}>"

    @property
    def n_v(self) -> int:
        """Number of vertices of its mesh; shapes have as many, or more where refined."""
        return len(self.loop) + len(self.interior)

    def tiling(self, triangles: IntArray, loop: IntArray | None = None) -> Tiling:
        """Return the tiling by triangles (n_t, 3), on a loop that may be finer; kept."""
        for known in self._tilings:
            if known.triangles is triangles or np.array_equal(known.triangles, triangles):
                return known
        n_v, loop = int(triangles.max()) + 1, self.loop if loop is None else loop
        inside = np.setdiff1d(np.arange(n_v), loop) if n_v > self.n_v else self.interior
        return self._keep(Tiling(triangles, loop, inside))

    def _keep(self, tiling: Tiling) -> Tiling:
        if all(known is not tiling for known in self._tilings):
            self._tilings[:] = [tiling, *self._tilings[: _KEPT - 1]]
        return tiling

    def on(self, tiling: Tiling, x: FloatArray) -> Shape:
        """Return the shape of vertices x (n_v, 3) on a tiling, kept for later."""
        return Shape(x, self._keep(tiling).triangles, tiling.loop)

    @property
    def dimension(self) -> int:
        """Coordinates of its loops: 3, in space."""
        return 3

    def energy_gradient(self, shape: Shape, load: float) -> tuple[float, FloatArray]:
        """Return load * area and its gradient (n_v, 3)."""
        tiling = self.tiling(shape.triangles, shape.loop)
        sides = tiling.sides(shape.x)
        return load * float(sides.areas.sum()), load * tiling.gradient(sides)

    def forces(self, shape: Shape) -> FloatArray:
        """Return the forces (n_v, 3) of unit load that do work (harmonic.balance)."""
        return balance(self.tiling(shape.triangles, shape.loop), shape.x)

    def prepared(self, shape: Shape) -> Shape:
        """Return the shape brought near to rest, folds and thin triangles replaced."""
        tiling, x = self.tiling(shape.triangles, shape.loop), shape.x
        if is_folded(tiling, x):
            tiling, x = laid_anew(tiling, x)
        if tiling.sides(x).smallest_angle < LIMITS.thin:
            tiling, x = mend_triangles(tiling, x)
        return self._near(tiling, x).reference

    def carried(self, shape: Shape, x_loop: FloatArray) -> Shape:
        """Return the shape after its loop has moved, repaired where triangles got thin."""
        tiling = self.tiling(shape.triangles, shape.loop)
        return self.on(*carry_along(tiling, shape.x, x_loop))

    def refined(self, shape: Shape, finer: Finer) -> Shape:
        """Return the shape with finer triangles near places; itself if they are fine."""
        from eulerplateau.film.refinement import refined, with_cut_loop

        tiling = self.tiling(shape.triangles, shape.loop)
        cut = with_cut_loop(tiling, shape.x, finer)
        after, x = refined(*cut, finer.sizes, finer.most)
        return shape if after is tiling else self.on(after, x)

    def of_loop(self, near: Shape) -> AreaOfLoop:
        """Return the film as a function of its loop near a shape, on its triangles."""
        for known in self._recent:
            if known.local.tiling.triangles is near.triangles and known.rests_at(near.x):
                return known
        return self._near(self.tiling(near.triangles, near.loop), near.x)

    def _near(self, tiling: Tiling, x: FloatArray) -> AreaOfLoop:
        found = AreaOfLoop(self, local_film(self._keep(tiling), x))
        self._recent[:] = [found]
        return found

    def slide(self, loop: Loop, x_loop: FloatArray) -> FloatArray | None:
        """Return the loop's sliding along itself (n_b, 3): the film only sees its curve."""
        return sliding(loop, x_loop)

    def pinched(self, shape: Shape, loop: Loop) -> bool:
        """Return whether strands of the loop meet: no film spans what is between them."""
        return loop.strands_meet(shape.x_loop)

    def folded(self, shape: Shape) -> bool:
        """Return whether triangles lie on each other, and count what they do not span."""
        return is_folded(self.tiling(shape.triangles, shape.loop), shape.x)

    def touches(self, shape: Shape, diameter: float) -> bool:
        """Return whether the film comes against a rod so thick, or against itself."""
        from eulerplateau.mesh import film_touches  # only runs with a diameter need it

        return film_touches(shape, 0.5 * diameter)


@dataclass(frozen=True)
class AreaOfLoop:
    """A soap film as a function of its loop, good near one shape."""

    film: AreaFilm
    local: LocalFilm

    @property
    def reference(self) -> Shape:
        """The shape it was made at."""
        return Shape(self.local.x, self.local.tiling.triangles, self.local.tiling.loop)

    def rests_at(self, x: FloatArray) -> bool:
        """Return whether it was made at these very vertices, or rests at them there."""
        return x is self.local.x or self.local.rests_at(x)

    def project(self, x: FloatArray) -> FloatArray:
        """Return the positions (n, 3) as they are."""
        return x

    def lift(self, x_loop: FloatArray) -> FloatArray:
        """Return the loop (n_b, 3) as it is."""
        return x_loop

    def shape(self, x_loop: FloatArray) -> Shape:
        """Return the film at rest on a loop (n_b, 3)."""
        found = self.local.relax(x_loop)
        return Shape(found.x, self.local.tiling.triangles, self.local.tiling.loop)

    def force(self, x_loop: FloatArray) -> FloatArray:
        """Return the gradient of the area with respect to the loop (n_b, 3)."""
        return self.local.relax(x_loop).force

    def displacement(self, x_loop: FloatArray, moved: FloatArray) -> FloatArray:
        """Return how the film (n_v, 3) follows a small move of its loop (n_b, 3)."""
        return self.local.relax(x_loop).displacement(moved)

    def energy(self, loop: Loop, load: float) -> LoopEnergy:
        """Return bending plus load * area of the loop; it slides along itself freely."""
        motions = partial(free_motions, loop, slides=True)
        energy = inextensible(loop, Area(self.local, load), motions)
        return replace(energy, constraint=FilmLengths(loop))

    def with_loop(
        self, x_loop: FloatArray, load: float, loop: LoopStiffness, strip: bool
    ) -> IndefiniteFactor:
        """Factorise `load` times the film's Hessian on a loop with what that adds.

        strip : whether a strip of the film follows the loop. Raises LinAlgError if a pivot
        vanishes, or where there is no film.
        """
        return self.local.with_loop(self.local.relax(x_loop), load, loop, strip)

    def flat_at(self, x_loop: FloatArray) -> bool:
        """Return whether the film on this loop lies in a plane."""
        return is_flat(self.local.tiling, self.local.relax(x_loop).x)

    def made_at(self, x_loop: FloatArray) -> bool:
        """Return whether the film has not tilted from where it was made."""
        return self.local.relax(x_loop).central

    def renewed(self, x_loop: FloatArray) -> AreaOfLoop:
        """Return the film near the shape on this loop; a free one stays free."""
        if self.local.is_free and (free := self.released(x_loop)) is not self:
            return free
        return self.film.of_loop(self.film.prepared(self.shape(x_loop)))

    def released(self, x_loop: FloatArray) -> AreaOfLoop:
        """Return the film near the discrete minimal surface next to that on this loop.

        The film itself where there is none, and where it is flat: then its vertices may
        lie anywhere.
        """
        tiling, x = self.local.tiling, self.shape(x_loop).x
        if is_flat(tiling, x):
            return self
        found = find_minimal_surface(tiling, x)
        if found is None:
            return self
        return AreaOfLoop(self.film, local_film(*found, free=True))

    def kept(self, x_loop: FloatArray) -> Mapping[str, NDArray[Any]]:
        """Return where it was made, and the film on this loop: later ones begin there."""
        found = self.local.relax(x_loop)
        return {
            "reference": self.local.x,
            "triangles": self.local.tiling.triangles,
            "free": np.array(self.local.is_free),
            "x": found.x,
            "u": found.u,
        }

    def restored(self, kept: Mapping[str, NDArray[Any]]) -> AreaOfLoop:
        """Return the film near the shape it was kept of."""
        tiling, x = self.film.tiling(kept["triangles"]), kept["reference"]
        sides = tiling.sides(x)
        local = _local(tiling, x, sides, follower(tiling, sides), bool(kept["free"]))
        local.begin_at(kept["x"], kept["u"])
        return AreaOfLoop(self.film, local)


def local_film(tiling: Tiling, x: FloatArray, free: bool = False) -> LocalFilm:
    """Return the film near a shape (n_v, 3), which is brought near to rest first.

    free : whether vertices inside may move freely, which takes a discrete minimal surface
    (minimal_surface.py): on another film not all displacements are resisted.

    Re-weighting: the film that is harmonic with the cotangent weights of the last one has
    no more area (Pinkall and Polthier 1993).
    """
    sides = tiling.sides(x)
    for _ in range(_REWEIGHTINGS):
        following = follower(tiling, sides)
        after = following.extend(x[tiling.loop])
        if tiling.change(x, after) > -_NEAR * sides.areas.sum():
            break
        x, sides = after, tiling.sides(after)
    else:
        following = follower(tiling, sides)
    return _local(tiling, x, sides, following, free)


def _local(
    tiling: Tiling,
    x: FloatArray,
    sides: TriangleGeometry,
    following: Follower,
    free: bool,
) -> LocalFilm:
    normals = tiling.vertex_normals(sides)[tiling.interior]
    if free:
        return FreeFilm(tiling, x, sides, normals, following, FreeInterior(tiling))
    heights = normal_heights(tiling, x, normals)
    return HeightsFilm(tiling, x, sides, normals, following, heights)
