"""Whether a state that balances is a saddle: told by what is left of a kick.

After a kick a search comes back, the sooner along a motion the stiffer that is. What is
left of the kick is the softest motion, and along that alone the energy is asked: at a
saddle it falls on both sides, though perhaps too slowly for a search to notice.
"""

from __future__ import annotations

import numpy as np
from numpy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import LoopEnergy
from eulerplateau.mesh import Shape
from eulerplateau.solvers.acceptance import change_of_energy, noise_of
from eulerplateau.solvers.equilibrium import Equilibrium
from eulerplateau.solvers.problem import Problem
from eulerplateau.solvers.start import KICK

# How far away, in L, the energy is asked: a straight way leaves a film that turns by the
# square of that, which costs its fourth power, and is to be little beside the turn.
_NEAR = 3e-5


def way_down(
    problem: Problem, found: Equilibrium, again: Equilibrium, load: float
) -> Shape | None:
    """Return a shape on the way down from a state that was found, if that is a saddle.

    again : where a search has come back to after a kick
    The shape is as far away as a kick leads. None where the energy rises along what is left
    of the kick, or where it changes by no more than rounding can show.
    """
    try:
        film = problem.film.of_loop(found.shape)
        energy = film.energy(problem.loop, load)
        x = energy.constraint.project(film.project(found.shape.x_loop))
        if x is None:
            return None
        left = _left_of_kick(energy, x, film.project(again.shape.x_loop))
        largest = float(np.abs(left).max())
        if largest == 0.0:
            return None
        changes = []
        for step in (_NEAR / largest * left, -_NEAR / largest * left):
            change = change_of_energy(energy, x, energy.constraint.project(x + step))
            if change is None:
                return None
            changes.append(change)
        if sum(changes) >= -2 * noise_of(energy, x, step, found.tensions):
            return None
        side = 1 if changes[0] < changes[1] else -1
        reached = energy.constraint.project(x + side * KICK / largest * left)
        return None if reached is None else film.shape(reached)
    except LinAlgError:
        return None


def _left_of_kick(energy: LoopEnergy, x: FloatArray, again: FloatArray) -> FloatArray:
    """Return how a loop (n, d) differs from x (n, d), by what costs something.

    Turned to lie on x best (Kabsch); a small rotation's first order would leave a stretch.
    """
    weights = energy.weights[:, None]
    centred, other = (y - (weights * y).sum(axis=0) / weights.sum() for y in (x, again))
    u, _, v = np.linalg.svd((weights * other).T @ centred)
    u[:, -1] *= np.sign(np.linalg.det(u @ v))
    root = np.repeat(np.sqrt(energy.weights), x.shape[1])
    moved = root * (other @ (u @ v) - centred).ravel()
    free = np.linalg.qr(root[:, None] * energy.free_motions(x))[0]
    left: FloatArray = (moved - free @ (free.T @ moved)) / root
    return left.reshape(x.shape)
