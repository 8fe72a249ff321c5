"""A film that follows what one drags: an equilibrium at one value after another."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from eulerplateau.branches import likeness_of
from eulerplateau.mesh import Measurer, Shape
from eulerplateau.runs.inputs import make_mesh
from eulerplateau.runs.kinds import film_kind
from eulerplateau.runs.live_shapes import new_shape_file
from eulerplateau.runs.live_values import varied_by
from eulerplateau.runs.parameters import BENCH, LOOP_PARAMETERS
from eulerplateau.runs.recording import Told, tell
from eulerplateau.runs.rows import Row
from eulerplateau.runs.shape_files import write_shape
from eulerplateau.runs.spec import RunSpec
from eulerplateau.runs.start import make_problem, start_shape
from eulerplateau.runs.visited import Visited
from eulerplateau.solvers import Equilibrium, Problem, lowest_modes, smooth_kick, solve

# Of the energy: what rounding, or a mesh that is repaired, may lose without a jump.
_LOST = 1e-4
# Lengths of kicks, and of pushes along modes to find another state, in units of L.
_KICK = 0.03
_PUSHES = 0.03, 0.1, 0.2
_MODES = 2
# So many films that were left are gone back to.
_LEFT = 4
# R.m.s. distance up to which two states are one, as of a catalogue.
_SAME = 0.01


class LiveFilm:
    """The film of a run, which goes on from where it is.

    It is for one thread. Whatever the solver comes to is shown, and gone on from, as in a
    sweep; the status says what it is. Where that is not finite MeshError is raised, and the
    film stays where it is.

    Attributes
    ----------
    varied : what may be varied
    at : where it is
    """

    at: Visited
    _problem: Problem
    _found: Equilibrium
    _rates: _Rates
    _told: Told[Row]

    def __init__(self, spec: RunSpec) -> None:
        """Find the film at the first value of the run; raises SpecError, MeshError."""
        self._spec, self._disk = spec, make_mesh(spec)
        self._rest = make_problem(spec, self._disk)
        self._measurer = Measurer(self._disk)
        self._random = np.random.default_rng(spec.start.seed)
        self.varied = varied_by(spec)
        self._values = {each.key: each.value for each in self.varied}
        self._varied = {each.parameter for each in self.varied}
        self._left: deque[Equilibrium] = deque(maxlen=_LEFT)
        self._steps = 0
        self.begin()

    def begin(self) -> Visited:
        """Return the film at the values there are, from where the run starts."""
        start = start_shape(self._spec, self._disk)
        return self._come_to(self._solved(start), "begin")

    def follow(self, values: Mapping[str, float]) -> Visited:
        """Return the film at other values of what is varied, from where it is.

        values : {column: value as it is shown}; beyond its range it is the end of that
        """
        known = {each.key: each for each in self.varied}
        self._values |= {key: known[key].within(value) for key, value in values.items()}
        return self._come_to(self._solved(self._found), "follow")

    def kick(self) -> Visited:
        """Return where the film goes from a smooth push across its plane, at random."""
        shape = self._found.shape
        push = smooth_kick(shape.x_loop, shape.x, self._random, 2)
        push *= _KICK / np.linalg.norm(push, axis=1).max()
        return self._come_to(self._solved(shape.moved(shape.x + push)), "kick")

    def other(self) -> Visited | None:
        """Return another stable state at the same values, None if none was come to.

        Sought from films that were left at jumps, or when this was asked, the last first;
        then from pushes along the softest modes, either way.
        """
        here, alike = self._found, likeness_of(self._problem, _SAME)
        for start in self._elsewhere():
            found = self._solved(start)
            if not found.is_minimum:
                continue
            if alike.distance(here.shape.x_loop, found.shape.x_loop) > _SAME:
                self._left.appendleft(here)
                return self._come_to(found, "other")
        return None

    def save(self, folder: Path) -> Path:
        """Write the film into live/ of a run folder; return the file.

        It takes the first number that is free, and replaces nothing. A run may start from
        it (start.file). Raises OutputError if it cannot be written.
        """
        told, x, rest = self._told, self.at.shape.x, self._disk.digest
        with new_shape_file(folder) as path:
            known = told.fields, rest, told.state, told.curvatures
            write_shape(path, told.disk, x, told.row, *known)
        return path

    def _elsewhere(self) -> Iterator[Equilibrium | Shape]:
        """Yield starts from which another state may be come to."""
        yield from tuple(self._left)
        here = self._found
        if not here.converged:
            return
        modes = lowest_modes(self._problem, here, _MODES).values()
        for push in _PUSHES:
            for mode in modes:
                for signed in (push, -push):
                    yield here.shape.moved(here.shape.x + signed * mode)

    def _solved(self, start: Equilibrium | Shape) -> Equilibrium:
        problem, load = self._at_values()
        solver = self._spec.solver
        return solve(
            problem, load, start, solver=solver.name, max_iterations=solver.max_iterations
        )

    def _at_values(self) -> tuple[Problem, float]:
        problem, load = self._rest, self._spec.held or 0.0
        for each in self.varied:
            value = each.in_problem(self._values[each.key])
            problem, load = problem.at(each.parameter, value, load)
        return problem, load

    def _come_to(self, found: Equilibrium, way: str) -> Visited:
        problem, _ = self._at_values()
        row_type, own = self._row_type, self._own
        told = tell(problem, found, self._measurer, self._steps, row_type, **own)
        here = _Rates.of(problem, found, told.row, self._varied)
        jumped = False
        if way in ("follow", "kick") and self._found.converged:
            jumped = here.lost_since(self._rates) > _LOST * abs(found.energy)
        if jumped:
            self._left.appendleft(self._found)
        self._problem, self._found, self._rates, self._told = problem, found, here, told
        self._steps += 1
        self.at = self._visited(way, jumped)
        return self.at

    def _visited(self, way: str, jumped: bool) -> Visited:
        loop, shape, told = self._problem.loop, self._found.shape, self._told
        directors = told.fields.get("director")
        return Visited(
            values=dict(self._values),
            row=told.row,
            shape=shape,
            radius=None if loop.diameter is None else loop.diameter / 2,
            directors=None if directors is None else directors[shape.loop],
            way=way,
            jumped=jumped,
        )

    @cached_property
    def _row_type(self) -> type[Row]:
        loop = self._spec.loop
        quantity = self._spec.column(self._spec.sweep.varied)
        kind = film_kind(loop.twist_ratio, loop.rest_curvature, quantity, loop.diameter)
        return kind.row

    @property
    def _own(self) -> dict[str, Any]:
        """The cells of a row that no problem knows: its quantity, and one of the bench."""
        swept = self._spec.sweep.varied
        cells: dict[str, Any] = {"quantity": self._spec.column(swept)}
        if swept in BENCH:
            first = self.varied[0]
            cells[first.key] = self._values[first.key] / first.name.shown(1.0)
        return cells


@dataclass(frozen=True)
class _Rates:
    """The energy of an equilibrium, and how it changes with what is varied.

    Attributes
    ----------
    rates : {parameter: (its value, the derivative of the energy by it)}
    """

    energy: float
    rates: Mapping[str, tuple[float, float]]

    @classmethod
    def of(
        cls, problem: Problem, found: Equilibrium, row: Row, varied: Iterable[str]
    ) -> _Rates:
        """Return those of an equilibrium, by these parameters of its problem.

        The energy of the film is proportional to the load: that by it is the film's at 1.
        """
        rates = {}
        for name in varied:
            if name == "load":
                rate = problem.film.energy_gradient(found.shape, 1.0)[0]
            else:
                rate = LOOP_PARAMETERS[name].energy_rate(row)
            rates[name] = problem.value(name, found.load), rate
        return cls(found.energy, rates)

    def lost_since(self, before: _Rates) -> float:
        """Return the energy lost on the way from another equilibrium.

        On a branch along which the energy's rate goes from one end's to the other's without
        turning, its change lies between what the two rates give. A jump ends below both.
        """
        least = 0.0
        for name, (value, rate) in self.rates.items():
            old, old_rate = before.rates[name]
            least += min(old_rate * (value - old), rate * (value - old))
        return before.energy + least - self.energy
