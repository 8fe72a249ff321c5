"""Where a branch of films begins: the family that is good near a shape."""

from __future__ import annotations

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.film_family import FilmFamily
from eulerplateau.film import FilmOfLoop
from eulerplateau.loop import Contacts
from eulerplateau.mesh import Shape
from eulerplateau.solvers import Problem


def family_near(
    problem: Problem,
    shape: Shape,
    parameter: str = "load",
    load: float = 0.0,
    contacts: Contacts | None = None,
) -> tuple[FilmFamily, FloatArray]:
    """Return the family good near a shape, and the shape's loop in its coordinates.

    Of a loop with a diameter it is the equilibrium next to that with its contacts, if those
    are not known; `load` is the shape's.
    """
    film = problem.film.of_loop(problem.film.prepared(shape))
    family = FilmFamily(problem, film, parameter, load)
    x = film.project(shape.x_loop)
    if problem.loop.diameter is None:
        return family, x
    # Loaded for such loops only.
    from eulerplateau.branches.contact_family import touching

    places = None if contacts is None else contacts.places
    return touching(family, x, problem.value(parameter, load), places)


def family_on(
    problem: Problem, film: FilmOfLoop, parameter: str, load: float
) -> FilmFamily:
    """Return a family on any film of a problem: what a kept one is restored from."""
    family = FilmFamily(problem, film, parameter, load)
    if problem.loop.diameter is None:
        return family
    from eulerplateau.branches.contact_family import ContactFamily
    from eulerplateau.loop import strands_of

    return ContactFamily(**vars(family), strands=strands_of(problem.loop))
