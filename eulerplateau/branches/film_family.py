"""Films as families of energies: one load, or link, after another, near one shape."""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.control import Direction, Hyperplane
from eulerplateau.branches.likeness import Likeness, likeness
from eulerplateau.branches.point import BranchPoint
from eulerplateau.film import FilmOfLoop
from eulerplateau.loop import Loop, LoopEnergy
from eulerplateau.mesh import Shape
from eulerplateau.solvers import (
    RESIDUAL_TOLERANCE,
    Equilibrium,
    Problem,
    Status,
    TangentModel,
    coarse,
)
from eulerplateau.threads import one_thread

if TYPE_CHECKING:
    from eulerplateau.branches.contact import Contact
    from eulerplateau.loop import Contacts


def on_its_mesh(problem: Problem) -> Problem:
    """Return the problem with films that are not refined, as those of a family are not."""
    made = copy(problem)
    object.__setattr__(made, "refines", False)
    return made


class NoContact:
    """Nothing of a loop that has no diameter: what contact.py has for one that has it."""

    def held(self, energy: LoopEnergy, loop: Loop) -> LoopEnergy:
        """Return the energy as it is."""
        return energy

    def near(self, x: FloatArray) -> NoContact:
        """Return itself."""
        return self

    def steady(self, x: FloatArray) -> NoContact:
        """Return itself."""
        return self

    def contacts(
        self, model: TangentModel, loop: Loop, film: FilmOfLoop, energy: LoopEnergy
    ) -> None:
        """Return None."""

    def kept(self) -> Mapping[str, NDArray[Any]]:
        """Return nothing."""
        return {}

    def restored(self, kept: Mapping[str, NDArray[Any]]) -> NoContact:
        """Return itself."""
        return self


NO_CONTACT = NoContact()


@dataclass(frozen=True)
class FilmFamily:
    """A film on its loop at one value of a parameter after another, good near one shape.

    Attributes
    ----------
    parameter : "load", or one of the loop's own, as "link"
    load : float, at which that is varied; of no account where it is the load
    contact : which gaps are closed, of a loop that has a diameter
    """

    problem: Problem
    film: FilmOfLoop
    parameter: str = "load"
    load: float = 0.0
    contact: NoContact | Contact = NO_CONTACT

    def at(self, value: float) -> tuple[Problem, float]:
        """Return the problem and its load at a value of the parameter."""
        return self.problem.at(self.parameter, value, self.load)

    def energy(self, value: float) -> LoopEnergy:
        """Return the energy at a value of the parameter."""
        problem, load = self.at(value)
        return self.contact.held(self.film.energy(problem.loop, load), problem.loop)

    def with_value(self, parameter: str, value: float) -> FilmFamily:
        """Return the family at another value of a parameter that it does not vary."""
        problem, load = self.problem.at(parameter, value, self.load)
        return replace(self, problem=problem, load=load)

    def positions(self, x: FloatArray) -> FloatArray:
        """Return the loop (n_b, 3) as it is."""
        return x

    def near(self, x: FloatArray) -> FilmFamily:
        """Return the film made anew at a loop (n_b, 3), and what touches there."""
        return self.on(self.film.renewed(x), self.contact.near(x))

    def rests(self, model: TangentModel, value: float) -> bool:
        """Return whether forces balance along the film's normals there.

        They do along those of the shape that the film was made near, until it has turned.
        """
        return self._recorded(model, value).converged

    def settled(self, point: BranchPoint, plane: Hyperplane) -> BranchPoint | None:
        """Return the point at which no strands overlap where they touch."""
        if self.problem.loop.diameter is None:
            return point
        # Loaded for such loops only.
        from eulerplateau.branches.everywhere import contacts_settled

        return contacts_settled(point, plane)

    def steady(self, x: FloatArray) -> FilmFamily:
        """Return the family in which steps from a loop x (n, d) are taken."""
        return self.on(self.film, self.contact.steady(x))

    def released(self, x: FloatArray) -> FilmFamily:
        """Return the film as a minimal surface, where it is curved."""
        return self.on(self.film.released(x))

    def kept(self, x: FloatArray) -> Mapping[str, NDArray[Any]]:
        """Return what makes the film again, good near a loop (n_b, 3)."""
        return {**self.film.kept(x), **self.contact.kept()}

    def restored(self, kept: Mapping[str, NDArray[Any]]) -> FilmFamily:
        """Return the film that this was kept of."""
        return self.on(self.film.restored(kept), self.contact.restored(kept))

    def beyond(self, point: BranchPoint, which: int) -> tuple[FilmFamily, str]:
        """Return the family beyond a point where one of its margins vanishes."""
        problem, _ = self.at(point.value)
        assert not isinstance(self.contact, NoContact)
        contact, what = self.contact.beyond(point, problem.loop, which)
        return replace(self, contact=contact), what

    def equilibrium(self, point: BranchPoint) -> Equilibrium:
        """Return the equilibrium at a point of a branch of it."""
        problem, _ = self.at(point.value)
        found = problem.classified(self._recorded(point.model, point.value))
        return replace(found, iterations=point.corrections, stability=point.stability)

    def _recorded(self, model: TangentModel, value: float) -> Equilibrium:
        (problem, load), x = self.at(value), model.x
        energy = self.film.energy(problem.loop, load)
        contacts = self.contact.contacts(model, problem.loop, self.film, energy)
        shape, tensions = self.film.shape(x), model.tensions[: len(x)]
        pushes = None if contacts is None else contacts.pushes
        found = problem.equilibrium(shape, tensions, load, Status.CONVERGED, pushes)
        balanced = found.residual <= RESIDUAL_TOLERANCE
        status = Status.CONVERGED if balanced else Status.STALLED
        return replace(found, status=status, contacts=contacts)

    def on(
        self, film: FilmOfLoop, contact: NoContact | Contact | None = None
    ) -> FilmFamily:
        """Return the family of another film, or with other gaps closed; itself if it is."""
        closed = self.contact if contact is None else contact
        same = film is self.film and closed is self.contact
        return self if same else replace(self, film=film, contact=closed)


def family_of(point: BranchPoint) -> FilmFamily:
    """Return the family of a point of a film's branch: all of them have such a one."""
    return cast(FilmFamily, point.family)


def equilibrium(point: BranchPoint) -> Equilibrium:
    """Return the equilibrium of a film at a point of one of its branches."""
    return family_of(point).equilibrium(point)


def recorded(point: BranchPoint, way: Direction) -> BranchPoint:
    """Return what is recorded of a point: one whose strands overlap nowhere.

    It lies in the hyperplane through it normal to a way. Without a diameter, the point.
    """
    if family_of(point).problem.loop.diameter is None:
        return point
    # Loaded for such loops only.
    from eulerplateau.branches.everywhere import apart_everywhere

    with one_thread():
        return apart_everywhere(point, way)


def family_on(
    problem: Problem, film: FilmOfLoop, parameter: str, load: float
) -> FilmFamily:
    """Return a family on any film of a problem: what a kept one is restored from."""
    family = FilmFamily(problem, film, parameter, load)
    if problem.loop.diameter is None:
        return family
    from eulerplateau.branches.contact import Contact
    from eulerplateau.loop import strands_of

    return replace(family, contact=Contact(strands_of(problem.loop)))


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
    if len(shape.loop) > problem.disk.n_b:
        shape = coarse(problem.tied_film(), problem.disk, shape)
    film = problem.film.of_loop(problem.film.prepared(shape))
    family, x = FilmFamily(problem, film, parameter, load), film.project(shape.x_loop)
    if problem.loop.diameter is None:
        return family, x
    # Loaded for such loops only.
    from eulerplateau.branches.contact import contact_near

    places = None if contacts is None else contacts.places
    value = problem.value(parameter, load)
    contact, x = contact_near(
        problem.loop, x, value, places, lambda touching: replace(family, contact=touching)
    )
    return replace(family, contact=contact), x


def likeness_of(problem: Problem, within: float) -> Likeness:
    """Return which loops of a film are the same, up to a distance at rest: see likeness."""
    rest = problem.disk.x[problem.disk.loop]
    # Of a round loop sliding is a rotation: a long one is asked whether it costs nothing.
    centred = rest - rest.mean(axis=0)
    axis = np.linalg.svd(centred, full_matrices=False)[2][0]
    long = rest + np.outer(centred @ axis, axis)
    slides = problem.film.slide(problem.loop, long) is not None
    return likeness(problem.loop, rest, slides, within)
