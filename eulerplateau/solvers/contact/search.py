"""Newton for a loop with a diameter, whatever film it bounds."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from functools import partial
from math import isinf

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.film import EdgeSizes, FilmOfLoop, Finer
from eulerplateau.loop import LoopEnergy, Strands, close_with_lengths, strands_of
from eulerplateau.mesh import Shape
from eulerplateau.solvers.acceptance import at_rounding
from eulerplateau.solvers.contact.descent import ContactDescent
from eulerplateau.solvers.contact.everywhere import OVERLAP, Everywhere
from eulerplateau.solvers.contact.keeping import Keeping, Touching
from eulerplateau.solvers.contact.record import contacts_of
from eulerplateau.solvers.contact.separation import separated
from eulerplateau.solvers.equilibrium import Equilibrium, Status, with_stability
from eulerplateau.solvers.problem import Problem
from eulerplateau.solvers.renewal import Reached, elsewhere, near_shapes
from eulerplateau.solvers.second_variation import stability
from eulerplateau.solvers.start import coarse
from eulerplateau.threads import one_thread

# How long edges may be where strands cross. Those of the loop: in diameters, or in units of
# L if that is more, since rounding leaves short ones no equilibrium; farther away in
# proportion.
_LOOP_OF_DIAMETER, _LOOP_LEAST, _LOOP_GROWTH = 1.5, 1.5e-3, 0.35
# By how much they are too long where they are cut.
_SLACK = 1.3
# Those of the film: in diameters, or in edges of the loop there if that is more.
_OF_DIAMETER, _OF_LOOP = 1 / 4, 1 / 5
# How many vertices a film may come to, over those of its mesh.
_MOST = 3
# A film is refined once in one solve, and laid on its mesh again where its strands part.
_TIMES = 2


def search(
    problem: Problem,
    start: Shape,
    tensions: FloatArray | None,
    load: float,
    max_iterations: int,
    observe: Callable[[FloatArray], None],
) -> Equilibrium | None:
    """Return what a film comes to; None if no loop without overlaps is near the start.

    It is as fine as its contacts need it, and where strands have parted that of the mesh
    again; what has not converged is as it was, and what has, if a film that is finer has
    not. Tensions are of no use: they follow from the loop.
    """
    more = load, max_iterations, observe
    with one_thread():
        found = _found(problem, start, *more)
        if _is_lost(found) and len(start.x) > problem.disk.n_v:
            start = coarse(problem.tied_film(), problem.disk, start)
            found = _found(problem, start, *more)
        for _ in range(_TIMES if problem.refines else 0):
            if found is None or not found.converged:
                break
            shape, spent = _fit(problem, found), found.iterations
            if shape is found.shape:
                break
            other = _found(problem, shape, load, max_iterations - spent, observe)
            if other is None or not other.converged:
                break
            found = replace(other, iterations=spent + other.iterations)
        return found


def _is_lost(found: Equilibrium | None) -> bool:
    return found is None or found.status is Status.STALLED


def _found(
    problem: Problem,
    start: Shape,
    load: float,
    max_iterations: int,
    observe: Callable[[FloatArray], None],
) -> Equilibrium | None:
    """Return what a film on the loop of a shape comes to."""
    strands = strands_of(problem.loop_of(start))
    film = problem.film.of_loop(start)
    x_loop = close_with_lengths(strands.loop, film.project(start.x_loop))
    if x_loop is None:
        return None
    x_loop = separated(strands, x_loop)
    if x_loop is None:
        return None
    more = load, max_iterations, observe
    found = _near(problem, strands, start, film.lift(x_loop), x_loop, *more)
    if _is_lost(found) and problem.film.dimension != 2:
        other = _from_tied(problem, strands, x_loop, *more)
        if found is None or _is_better(problem, start, x_loop, load, other):
            found = other
    return found


def _is_better(
    problem: Problem,
    start: Shape,
    x_loop: FloatArray,
    load: float,
    other: Equilibrium | None,
) -> bool:
    """Return whether a film has converged to one no higher than that at the start."""
    if other is None or not other.converged:
        return False
    film = problem.film
    try:
        shape = film.prepared(film.carried(start, x_loop))
    except LinAlgError:  # none is spanned there
        return True
    return other.energy <= problem.energy(shape, load)


def _from_tied(
    problem: Problem,
    strands: Strands,
    x_loop: FloatArray,
    load: float,
    max_iterations: int,
    observe: Callable[[FloatArray], None],
) -> Equilibrium | None:
    """Return what a film comes to from where one goes that is tied to its mesh.

    That can be spanned across any loop with the mesh's edges. None if there is none even
    then.
    """
    tied = problem.tied_film()
    if tied is None or len(x_loop) != problem.disk.n_b:
        return None
    energy = tied.energy(strands.loop, load)
    try:
        last = Everywhere(energy, strands, at_rounding)
        descent = ContactDescent(energy, strands, max_iterations, last=last)
        state, _ = descent.run(x_loop)
    except LinAlgError:
        return None
    x, more = state.model.x, (load, max_iterations, observe)
    return _near(problem, strands, tied.shape(x), tied.lift(x), x, *more)


def _near(
    problem: Problem,
    strands: Strands,
    shape: Shape,
    lifted: FloatArray,
    x_loop: FloatArray,
    load: float,
    max_iterations: int,
    observe: Callable[[FloatArray], None],
) -> Equilibrium | None:
    """Return what a film near a shape, on a loop (n_b, d), comes to; None if there is none.

    lifted : (n_b, 3) float, that loop in space
    """
    state: Touching | None = None

    def descend(film: FilmOfLoop, left: int) -> Reached:
        nonlocal state, x_loop
        energy = film.energy(strands.loop, load)
        ends = partial(elsewhere, film)
        last = Everywhere(energy, strands, at_rounding)
        descent = ContactDescent(energy, strands, left, observe, ends, last)
        state, status = descent.run(x_loop, state)
        x_loop = state.model.x
        # A film that gets stuck away from where it was made may not, made anew.
        stuck = status is Status.STALLED and state.iteration == 0
        return Reached(
            x=x_loop,
            iterations=state.iteration,
            status=status,
            holds=energy.holds(x_loop),
            lost=lambda shape: stuck,
            record=partial(_record, problem, strands, load, film, state),
        )

    return near_shapes(problem.film, shape, lifted, max_iterations, descend)


def _record(
    problem: Problem,
    strands: Strands,
    load: float,
    film: FilmOfLoop,
    state: Touching,
    shape: Shape,
    spent: int,
    status: Status,
) -> Equilibrium:
    energy = film.energy(strands.loop, load)
    if status is not Status.CONVERGED:
        state = _apart(strands, energy, state)
        shape = film.shape(state.model.x)
    tensions = state.model.tensions
    contacts = contacts_of(strands, film, energy, state)
    on_edges = tensions[: len(state.model.x)]
    found = problem.equilibrium(shape, on_edges, load, status, contacts.pushes)
    found = replace(found, iterations=spent, contacts=contacts)
    found = with_stability(found, stability(state.model))
    if contacts.forces.min(initial=0.0) < -state.uncertain:
        return replace(found, status=Status.STALLED)
    return found


def _apart(strands: Strands, energy: LoopEnergy, state: Touching) -> Touching:
    """Return a state that is no equilibrium on a loop without overlaps, if one is near."""
    x = state.model.x
    if strands.smallest_gap(x, 0.0) >= -OVERLAP * strands.diameter:
        return state
    with suppress(LinAlgError):
        parted = separated(strands, x)
        if parted is not None:
            held, _ = strands.at(parted, state.gaps)
            near = strands.nearest(parted, OVERLAP * strands.diameter)
            touching = held.joined(near[strands.unlike(near, held)])
            after = Keeping(energy, strands).at(parted, touching, state.radius)
            return replace(after, risen=state.risen)
    return state


def _fit(problem: Problem, found: Equilibrium) -> Shape:
    """Return the shape of an equilibrium with edges as its contacts need them."""
    shape, contacts, diameter = found.shape, found.contacts, problem.loop.diameter
    assert contacts is not None
    assert diameter is not None
    crossing = contacts.at_a_point
    # The mesh of a thicker line is fine enough.
    if crossing.any() and diameter < float(problem.loop.rest_lengths.mean()):
        places = np.concatenate([contacts.s[crossing], contacts.t[crossing]])
        parts = _parts(problem, shape, places, diameter)
        loop = problem.loop_of(shape)
        lengths = loop.cut(parts).rest_lengths
        finest = max(_OF_DIAMETER * diameter, _OF_LOOP * float(lengths.min()))
        x_loop = strands_of(loop).curve(shape.x_loop)(np.cumsum(lengths) - lengths)
        points = contacts.points.mean(axis=0)[crossing]
        sizes, most = EdgeSizes(points, finest), _MOST * problem.disk.n_v
        return problem.film.refined(shape, Finer(sizes, parts, x_loop, most))
    parted = len(contacts) == 0 and isinf(contacts.smallest_gap)
    return (
        coarse(problem.tied_film(), problem.disk, shape)
        if parted and len(shape.x) > problem.disk.n_v
        else shape
    )


def _parts(problem: Problem, shape: Shape, places: FloatArray, diameter: float) -> IntArray:
    """Return into how many parts each edge of a shape's loop is to be cut: powers of 2.

    Edges of the mesh are cut as wholes: how many parts each is in tells how long they are.
    """
    lengths, cut = problem.loop.rest_lengths, problem.disk.parts(shape.loop)
    off = np.abs((np.cumsum(lengths) - 0.5 * lengths)[:, None] - places) % 1.0
    away = np.minimum(off, 1.0 - off).min(axis=1)
    finest = max(_LOOP_OF_DIAMETER * diameter, _LOOP_LEAST)
    many = lengths / np.maximum(finest, _LOOP_GROWTH * away)
    if (many <= _SLACK * cut).all():
        return np.ones(len(shape.loop), dtype=np.int64)
    wanted = 2 ** np.ceil(np.log2(np.maximum(many, 1.0))).astype(np.int64)
    return np.repeat(np.maximum(wanted // cut, 1), cut)
