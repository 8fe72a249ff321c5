"""A soap film as a function of its loop: the interior eliminated near one shape.

Sliding inside a flat film costs nothing, so only normal displacements are unknowns there.
Near a reference shape X with vertex normals n, a loop x_b carries the film

    x_i = X_i + G (x_b - X_b) + n_i u_i,

G the harmonic extension, so that the mesh follows its loop, and u the displacements that
make the area stationary: n_i . dA/dx_i = 0. That is one trial space, fixed as long as the
reference is, so the area left over is a smooth function of the loop with the exact gradient

    f = g_b + G^T g_i.

Its second variation with the interior relaxed (by static condensation, as for quadratic
films) is

    S = T^T H T - (T^T H n) (n^T H n)^-1 (n^T H T),

where T may be (1, G), or any other way in which the mesh follows its loop smoothly: that
makes a difference of O(h^2), and none on flat films. See normal_moves.py.

What remains of g_i along a curved film is a discretisation error: the area does depend,
weakly, on where its vertices lie. Near a discrete minimal surface (minimal_surface.py) it
is removed as well: u are then all displacements inside, g_i = 0, f = g_b, and S is exact.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.film import area_kernels
from eulerplateau.film.condensation import Condensation
from eulerplateau.film.harmonic import Follower
from eulerplateau.film.indefinite import IndefiniteFactor
from eulerplateau.film.normal_moves import InteriorUnknowns
from eulerplateau.film.tiling import LIMITS, Tiling, TriangleGeometry
from eulerplateau.film.with_loop import LoopStiffness

# Parts of a predicted change that are tried, as long as triangles fold over.
_PARTS = 1.0, 0.5, 0.25
# Cosine of the tilt of normals beyond which a reference shape gives way to a new one.
_TILT = 0.9


@dataclass(frozen=True)
class FilmAtRest:
    """A film at rest on its loop, near a reference shape.

    Attributes
    ----------
    x : (n_v, 3) float
    u : (n_u,) float, how far the interior has moved from where it follows the loop
    sides : its triangles
    gradient : (n_v, 3) float, of the area
    """

    local: LocalFilm
    x: FloatArray
    u: FloatArray
    sides: TriangleGeometry
    gradient: FloatArray

    @property
    def area(self) -> float:
        """Area of the film, in units of L^2."""
        return float(self.sides.areas.sum())

    @cached_property
    def force(self) -> FloatArray:
        """Gradient of the area with respect to the loop (n_b, 3)."""
        return self.local.carry(self.gradient)

    @property
    def hessian(self) -> FloatArray:
        """Second derivative of the area with respect to the loop (3 n_b, 3 n_b)."""
        stiffness = self.condensed.stiffness
        return 0.5 * (stiffness + stiffness.T)

    @cached_property
    def condensed(self) -> Condensation:
        """The second variation with the interior eliminated."""
        return self.local.variations.condense(self.second)

    @cached_property
    def inside(self) -> Condensation:
        """The interior factorised: that of `condensed` if it has been asked for."""
        return self.__dict__.get("condensed") or self.local.stiffness(self.sides)

    @property
    def factorised(self) -> Condensation | None:
        """The factorised interior if it has been asked for, else None."""
        return self.__dict__.get("condensed") or self.__dict__.get("inside")

    @property
    def central(self) -> bool:
        """Whether the film rests where the reference lies that it is known near."""
        return self.local.is_central(self.sides)

    def displacement(self, moved: FloatArray) -> FloatArray:
        """Return how the film (n_v, 3) follows a small move of its loop (n_b, 3)."""
        result = self.local.follow(moved)
        result[self.local.tiling.interior] += self.local.variations.displaced(
            self.response(result)
        )
        return result

    def response(self, followed: FloatArray) -> FloatArray:
        """Return how u changes (n_u,) on a film whose mesh has moved (n_v, 3)."""
        return self.answered(followed, self.inside)

    def answered(self, followed: FloatArray, inverse: Condensation) -> FloatArray:
        """Return the same by a factorised interior, which may be that of a film near by."""
        return -inverse.solve(self.local.variations.work(self._pull(followed)))

    def product(self, moved: FloatArray) -> FloatArray:
        """Return `hessian` times a displacement of the loop (n_b, 3), without making it."""
        variations = self.local.variations
        pull = self._pull(variations.followed(moved))
        inside = np.zeros_like(pull)
        inside[self.local.tiling.interior] = variations.displaced(
            -self.inside.solve(variations.work(pull))
        )
        return variations.carried(pull + self._pull(inside))

    def _pull(self, moved: FloatArray) -> FloatArray:
        return self.local.tiling.pull(self.second, moved)

    @cached_property
    def second(self) -> FloatArray:
        """The whole Hessian, a block (3, 3) for each of the tiling's pairs (m, 3, 3)."""
        return self.local.tiling.hessian(self.sides)


@dataclass(frozen=True)
class LocalFilm(ABC):
    """Where the interior of a film is sought.

    Attributes
    ----------
    film : the film
    x : (n_v, 3) float, the reference shape
    sides : its triangles
    normals : (n_i, 3) float
    follower : how its mesh follows the loop, harmonic on the reference shape
    variations : how interior vertices move: along these normals, or freely
    """

    tiling: Tiling
    x: FloatArray
    sides: TriangleGeometry
    normals: FloatArray
    follower: Follower
    variations: InteriorUnknowns
    # The last films asked for, by their loops: a solver comes back to them for force,
    # energy and Hessian.
    _recent: list[tuple[FloatArray, FilmAtRest]] = field(
        default_factory=list, init=False, repr=False
    )
    # The last interior that was factorised on the way to rest, kept for films near by.
    _inverse: list[Condensation] = field(default_factory=list, init=False, repr=False)
    # The last film that was factorised with its loop: its load and strip, the loop's chain.
    _factors: list[tuple[FilmAtRest, tuple[float, bool], FloatArray, IndefiniteFactor]] = (
        field(default_factory=list, init=False, repr=False)
    )

    @cached_property
    def alone(self) -> LocalFilm:
        """The same without what was asked for: films know this one.

        A cycle would keep films of gigabytes until garbage is collected.
        """
        return replace(self)

    @property
    @abstractmethod
    def is_free(self) -> bool:
        """Whether its vertices are free to move, as on a discrete minimal surface."""

    @abstractmethod
    def is_central(self, sides: TriangleGeometry) -> bool:
        """Return whether a film at rest is where this one was made."""

    @abstractmethod
    def stiffness(self, sides: TriangleGeometry) -> Condensation:
        """Return the factorised interior of a film."""

    @abstractmethod
    def _settled(self, base: FloatArray, state: FilmAtRest) -> FilmAtRest:
        """Return the film at rest, its mesh at `base` (n_v, 3), next to a state."""

    def follow(self, moved: FloatArray) -> FloatArray:
        """Return how the mesh (n_v, 3) follows a displacement of the loop (n_b, 3)."""
        return self.follower.extend(moved)

    def carry(self, gradient: FloatArray) -> FloatArray:
        """Return g_b + G^T g_i (n_b, 3): what a gradient (n_v, 3) comes to on the loop."""
        return self.follower.carry(gradient)

    def upright(self, sides: TriangleGeometry, cosine: float) -> bool:
        """Return whether all a film's normals are closer than that to the reference's."""
        now = self.tiling.vertex_normals(sides)[self.tiling.interior]
        return area_kernels.are_near(now, self.normals, cosine)

    def holds(self, sides: TriangleGeometry) -> bool:
        """Return whether a film is so near that neither it nor triangles turned far."""
        angle = sides.smallest_angle
        thin = angle < LIMITS.thin and angle < LIMITS.thinned * self.sides.smallest_angle
        return not thin and self.unfolded(sides) and self.upright(sides, _TILT)

    def relax(self, x_loop: FloatArray) -> FilmAtRest:
        """Return the film of least area on a loop (n_b, 3).

        Raises LinAlgError if there is none near the reference: it has torn or folded.
        """
        for its_loop, known in self._recent:
            if (its_loop == x_loop).all():
                return known
        loop = self.tiling.loop
        base = self.x + self.follow(x_loop - self.x[loop])
        base[loop] = x_loop
        found = self._settled(base, self._begun(base))
        # A copy: who asks may go on with the array.
        self._recent[:] = [(x_loop.copy(), found), *self._recent[:1]]
        return found

    def rests_at(self, x: FloatArray) -> bool:
        """Return whether these very vertices are those of a film asked for, not tilted."""
        return any(known.x is x and known.central for _, known in self._recent)

    def begin_at(self, x: FloatArray, u: FloatArray) -> None:
        """Forget the films asked for but one at rest, x (n_v, 3): the next begins there."""
        sides = self.tiling.sides(x)
        gradient = self.tiling.gradient(sides)
        found = FilmAtRest(self.alone, x, u, sides, gradient)
        self._recent[:] = [(x[self.tiling.loop], found)]

    def _at(self, base: FloatArray, u: FloatArray) -> FilmAtRest | None:
        """Return the film displaced by u from a mesh (n_v, 3); None if it folds over."""
        x = base.copy()
        x[self.tiling.interior] += self.variations.displaced(u)
        before = self.sides.normals
        standing = self.tiling.standing(x, before, LIMITS.folded)
        return None if standing is None else FilmAtRest(self.alone, x, u, *standing)

    def _begun(self, base: FloatArray) -> FilmAtRest:
        """Return the film to begin with: the last, and its response as far as it goes."""
        last = self._recent[0][1] if self._recent else None
        u = np.zeros(self.variations.size) if last is None else last.u
        inverse = self._known()
        if last is not None and inverse is not None:
            moved = base - last.x
            moved[self.tiling.interior] += self.variations.displaced(u)
            response = last.answered(moved, inverse)
            for part in _PARTS:
                state = self._at(base, u + part * response)
                if state is not None:
                    return state
        state = self._at(base, u)
        if state is None:
            raise LinAlgError("a triangle of the film has folded over")
        return state

    def with_loop(
        self, found: FilmAtRest, load: float, loop: LoopStiffness, strip: bool
    ) -> IndefiniteFactor:
        """Factorise `load` times the Hessian of a film with what its loop adds.

        See AreaOfLoop.with_loop. The last is kept: what is solved for first is asked for a
        spectrum, and corrected, afterwards. So is a factorised interior for films near by.
        """
        if not self._inverse:
            self._inverse.append(found.inside)
        for known, asked, chain, factor in self._factors:
            same = known is found and asked == (load, strip)
            if same and np.array_equal(chain, loop.chain):
                return factor
        self._factors.clear()
        factor = self.variations.with_loop(found.second, load, loop, strip)
        self._factors.append((found, (load, strip), loop.chain, factor))
        return factor

    def _known(self) -> Condensation | None:
        """Return a factorised interior of the last film, or of one near it, if there is."""
        own = self._recent[0][1].factorised if self._recent else None
        return self._inverse[0] if own is None and self._inverse else own

    def unfolded(self, sides: TriangleGeometry) -> bool:
        """Return whether every triangle shows the side that the reference shows."""
        # A triangle without area has no normal: the cosine is 0.
        return area_kernels.are_near(sides.normals, self.sides.normals, LIMITS.folded)
