"""How the energy of a soap film with a large loop is looked at: film and loop together.

Condensed to its loop, a film couples each vertex of it to every other. With its heights
left in, and the tensions of the edges as unknowns beside the displacements they hold, the
second variation is one sparse matrix, which costs as little to factorise as the film alone
(film/with_loop.py). A Newton step is one solve with it, its negative pivots count the ways
down, and its inverse finds the lowest modes. What that does not do, steps where there is a
way down and the spectrum next to a transition, is left to the dense model.

For steps no strip of the film follows its loop: on a curved film the matrix is then off by
O(h), which costs part of a step. The spectrum is that of the film with its strip.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy.linalg import LinAlgError
from scipy.linalg.lapack import dgeqrf, dorgqr

from eulerplateau.arrays import FloatArray
from eulerplateau.film import AreaOfLoop, IndefiniteFactor, LoopStiffness
from eulerplateau.loop import (
    RIGID_MOTIONS,
    Loop,
    LoopEnergy,
    orthonormal_motions,
    slide_kernels,
)
from eulerplateau.solvers.equilibrium import Stability
from eulerplateau.solvers.models import DenseModels, Model
from eulerplateau.solvers.second_variation import (
    NewtonStep,
    TangentModel,
    stability,
    tangent_model,
)

# Loops of so few vertices are soon looked at as a whole, where a way leads down: one shift
# is tried, and that farther from rest.
_SMALL, _FARTHER = 48, 0.1
# The residual from which on a loop is far from rest, and shifts that are tried there: the
# first is as large as the softest bending mode of a bare loop.
_FAR = 1e-2
_SHIFT, _LARGER, _LARGEST = 2e4, 3.0, 1e12
# The residual below which a step by the matrix of the loop before leaves but rounding.
_AT_REST = 1e-8
# Vectors of which the inverse's Krylov space is made, and how often it is applied.
_BLOCK, _ROUNDS = 3, 12


@dataclass(frozen=True)
class FilmModel:
    """The second-order model of a soap film at a loop x (n, 3): see TangentModel.

    motions : (3 n, m) float, those that cost nothing, orthonormal
    unbalanced : (n, 3) float, what tensions do not balance of the force
    near : the model of a loop so near that its factorised matrix will do for a step
    """

    film: AreaOfLoop
    load: float
    loop: Loop
    energy: LoopEnergy
    x: FloatArray
    motions: FloatArray
    tensions: FloatArray
    unbalanced: FloatArray
    residual: float
    rounding: float
    near: FilmModel | None = None
    # Steps that have been asked for, by the shift of the Hessian.
    _steps: dict[float, FloatArray | None] = field(
        default_factory=dict, init=False, repr=False
    )

    @cached_property
    def dense(self) -> TangentModel:
        """The model on all of the tangent space."""
        return tangent_model(self.energy, self.x)

    @cached_property
    def stiffness(self) -> LoopStiffness:
        """What the loop adds to the matrix of its film."""
        pinned = np.arange(3) * len(self.x) // 3
        chain = self.loop.chain(self.tensions)
        scale = float(chain[0].max())
        along = scale * self.loop.chords(self.x) / self.loop.rest_lengths[:, None]
        # As many columns whether sliding is a rotation or not: matrices of one pattern.
        held = np.zeros((self.motions.shape[0], RIGID_MOTIONS + 1))
        held[:, : self.motions.shape[1]] = self.motions
        return LoopStiffness(chain, along, held, pinned, scale)

    @cached_property
    def bare(self) -> IndefiniteFactor | None:
        """The factorised matrix without a strip; None if a pivot vanishes."""
        return self.factorised(strip=False)

    def n_below(self, factor: IndefiniteFactor) -> int:
        """Return how many directions in the tangent space lead down."""
        return factor.n_negative - len(self.x) - int(self.motions.shape[1])

    def newton_step(self, radius: float) -> NewtonStep | None:
        """Return the Newton step, cut short at the radius.

        Far from rest, where a way leads down, the Hessian is shifted until none does. None
        near rest, where such a step need not lead away from a saddle.
        """
        far, most = (_FARTHER, _SHIFT) if len(self.x) <= _SMALL else (_FAR, _LARGEST)
        shift = 0.0
        moved = self._newton(shift)
        while moved is None:
            if self.residual < far or shift >= most:
                return None
            shift = max(_SHIFT, _LARGER * shift)
            moved = self._newton(shift)
        size = float(np.sqrt(self.energy.weights @ np.square(moved).sum(axis=1)))
        part = min(1.0, radius / size) if size > 0 else 1.0
        slope = float(np.vdot(self.unbalanced, moved))
        curvature = -slope - shift * size**2
        promised = part * slope + 0.5 * part**2 * curvature
        return NewtonStep(part * moved, part * size, promised)

    def _newton(self, shift: float) -> FloatArray | None:
        """Return the step (n, 3) with a shifted Hessian; None where a way leads down."""
        if shift not in self._steps:
            model = self if self.near is None or shift else self.near
            factor = model.factorised(strip=False, shift=shift) if shift else model.bare
            moved = None
            if factor is not None and model.n_below(factor) == 0:
                moved = model.moved(factor, -self.unbalanced.reshape(-1, 1))
            self._steps[shift] = None if moved is None else moved.reshape(self.x.shape)
        return self._steps[shift]

    def spectrum(self) -> Stability:
        """Return the lowest eigenvalue if it is positive beyond doubt, else all of them."""
        factor = self.bare if self.film.flat_at(self.x) else self.factorised(strip=True)
        if factor is not None and self.n_below(factor) == 0:
            sizes = np.abs(self.stiffness.chain) / self.energy.weights
            rows = sizes[0] + sum(sizes[k] + np.roll(sizes[k], k) for k in (1, 2))
            bound = 10 * float(np.finfo(np.float64).eps * rows.max())
            lowest = self._lowest(factor, bound)
            if lowest > bound:
                return Stability(np.array([lowest]), bound)
        return stability(self.dense)

    def factorised(self, strip: bool, shift: float = 0.0) -> IndefiniteFactor | None:
        """Factorise the matrix, a strip following or not; None if a pivot vanishes.

        shift : what is added to all eigenvalues of the second variation
        """
        stiffness = self.stiffness
        if shift:
            chain = stiffness.chain.copy()
            chain[0] += shift * self.energy.weights
            stiffness = replace(stiffness, chain=chain)
        try:
            return self.film.with_loop(self.x, self.load, stiffness, strip)
        except LinAlgError:
            return None

    def moved(self, factor: IndefiniteFactor, forces: FloatArray) -> FloatArray:
        """Return the displacements (3 n, m) of least energy under forces (3 n, m)."""
        n = len(self.x)
        return self._answer(factor, forces, np.zeros((n, forces.shape[1])))[: 3 * n]

    def answered(
        self, factor: IndefiniteFactor, forces: FloatArray, stretches: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return how a loop (n, 3) and its tensions (n,) answer to forces (n, 3).

        While each edge gets longer by its `stretches` (n,).
        """
        n = len(self.x)
        found = self._answer(factor, forces.reshape(-1, 1), stretches[:, None])[:, 0]
        return found[: 3 * n].reshape(n, 3), self.stiffness.stiffness * found[3 * n :]

    def _answer(
        self, factor: IndefiniteFactor, forces: FloatArray, stretches: FloatArray
    ) -> FloatArray:
        """Return displacements and tensions, over the matrix's scale, as rows (4 n, m)."""
        n, n_i = len(self.x), len(self.film.film.interior)
        rhs = np.zeros((n_i + 4 * n + self.stiffness.n_held, forces.shape[1]))
        rhs[n_i : n_i + 3 * n] = forces
        rhs[n_i + 3 * n : n_i + 4 * n] = self.stiffness.stiffness * stretches
        return factor.solve(rhs)[n_i : n_i + 4 * n]

    def _lowest(self, factor: IndefiniteFactor, bound: float) -> float:
        """Return the lowest eigenvalue, to `bound` or ten digits, of a positive spectrum.

        By Rayleigh and Ritz among what the inverse makes of random vectors.
        """
        root = np.sqrt(np.repeat(self.energy.weights, 3))[:, None]
        block = np.random.default_rng(len(self.x)).standard_normal((len(root), _BLOCK))
        basis = np.zeros((len(root), 0))
        images = np.zeros((len(root), 0))
        lowest = np.inf
        for _ in range(_ROUNDS):
            for _ in range(2):
                block = block - basis @ (basis.T @ block)
            block = orthonormal_columns(block)
            image = root * self.moved(factor, root * block)
            basis, images = np.hstack([basis, block]), np.hstack([images, image])
            compliance = basis.T @ images
            softest = float(np.linalg.eigvalsh(0.5 * (compliance + compliance.T))[-1])
            before, lowest = lowest, 1 / softest
            if abs(before - lowest) <= max(0.1 * bound, 1e-10 * abs(lowest)):
                break
            block = image
        return lowest


def orthonormal_columns(columns: FloatArray) -> FloatArray:
    """Return columns (n, m) made orthonormal; numpy takes longer over three of them."""
    factor, tau, _, _ = dgeqrf(columns)
    found: FloatArray = dorgqr(factor, tau)[0]
    return found


@dataclass(frozen=True)
class FilmModels(DenseModels):
    """Film and loop together."""

    film: AreaOfLoop
    loop: Loop
    load: float

    def at(self, x: FloatArray, before: Model | None = None) -> FilmModel:
        """Return the model at a loop (n, 3)."""
        forces, means = self.energy.forces(x), self.loop.mean_lengths
        total = sum(forces[1:], start=forces[0])
        motions = orthonormal_motions(self.loop, x)
        tensions, unbalanced = np.empty(len(x)), np.empty_like(x)
        directions = self.loop.chords(x) / self.loop.rest_lengths[:, None]
        pull = slide_kernels.balance(
            directions, means, motions, total, tensions, unbalanced
        )
        largest = max(pull, *(float(np.abs(force).max()) for force in forces))
        residual, near = float(np.abs(unbalanced).max()) / largest, None
        if residual < _AT_REST and isinstance(before, FilmModel):
            near = before if before.near is None else before.near
        return FilmModel(
            film=self.film,
            load=self.load,
            loop=self.loop,
            energy=self.energy,
            x=x,
            motions=(means[:, None] * motions).reshape(len(motions), -1).T,
            tensions=tensions,
            unbalanced=unbalanced,
            residual=residual,
            rounding=self.energy.rounding * float(np.abs(x).max()) / largest,
            near=near,
        )

    def spectrum(self, model: Model) -> Stability:
        """Return the lowest eigenvalue, or the whole spectrum."""
        assert isinstance(model, FilmModel)
        return model.spectrum()
