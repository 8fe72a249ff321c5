"""A film that is known near one shape at a time, sought near one shape after another."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.film import Film, FilmOfLoop
from eulerplateau.mesh import Shape
from eulerplateau.solvers.equilibrium import Equilibrium, Status
from eulerplateau.solvers.models import Model

# A film is sought near the last shape at most so many times in one solve.
_SHAPES = 60
# The residual at which a film that has tilted from where it was made is made anew: one
# more step brings it to rest.
_CLOSE = 1e-5


@dataclass(frozen=True)
class Reached:
    """What a descent of a film near one shape has come to.

    Attributes
    ----------
    x : (n, d) float, its loop
    holds : bool, whether the film's energy is still good there
    lost : of the film's shape there, whether another film would come no further
    record : of shape, iterations in all and status, what is said of it
    """

    x: FloatArray
    iterations: int
    status: Status
    holds: bool
    lost: Callable[[Shape], bool]
    record: Callable[[Shape, int, Status], Equilibrium]


def near_shapes(
    film: Film,
    shape: Shape,
    loop: FloatArray,
    max_iterations: int,
    descend: Callable[[FilmOfLoop, int], Reached],
) -> Equilibrium | None:
    """Return what a film comes to that begins near a shape, on a loop (n_b, 3).

    The descent, of a film by so many iterations at most, begins again at each shape it
    comes to, until it is at rest near its own. None if no film is spanned there.
    """
    spent, found = 0, None
    for _ in range(_SHAPES):
        try:
            near = film.of_loop(film.prepared(film.carried(shape, loop)))
            reached = descend(near, max_iterations - spent)
        except LinAlgError:
            return None if found is None else found(Status.STALLED)
        spent += reached.iterations
        shape, loop = near.shape(reached.x), near.lift(reached.x)
        found = partial(reached.record, shape, spent)
        own = reached.holds and near.made_at(reached.x)
        if own or reached.lost(shape) or spent >= max_iterations:
            return found(reached.status)
    return None if found is None else found(reached.status)


def elsewhere(film: FilmOfLoop, model: Model) -> bool:
    """Return whether a film nearly at rest is not where it was made: it is made anew."""
    return model.residual < _CLOSE and not film.made_at(model.x)
