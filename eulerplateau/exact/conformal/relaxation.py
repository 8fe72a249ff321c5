"""The true film of least energy downhill from a start, by Newton on its shape and grid.

The loop's size is free: F = l b + sigma_hat D / l^2 is the energy of the loop of length 1
of its shape. So there is no constraint, and a step is a linear solve. The grid's nome is an
unknown like the others: D is at least the area whatever the grid, so that the better grid
has the lower F.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.linalg import eigh
from numpy.typing import ArrayLike
from scipy.linalg.lapack import dposv

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError
from eulerplateau.exact.checks import finite, points, whole_number
from eulerplateau.exact.conformal.basis import Basis
from eulerplateau.exact.conformal.equilibrium import ConformalFilm
from eulerplateau.exact.conformal.kernels import loop_derivatives, loop_energy
from eulerplateau.exact.conformal.sector import Sector, crowding_of, make_sector

# Harmonics to begin with; each further level has this many times as many.
_FEWEST, _FINER = 8, 2
_STEPS, _HALVINGS = 1000, 40
# A start that the grid cannot follow is rounded off, by exp(-corners (k^2 - 1)).
_CORNERS = (0.0, 0.03, 0.3)
# What Newton's step would still gain, over the energy, at which a level is done.
_COARSE, _DONE = 1e-6, 1e-15
# Largest change of the loop in a step, as a sum of k |dc| in lengths, and of the nome.
_TRUST, _TRUST_NOME = 0.25, 0.2
# A nome of 0.9 crowds the lobes' ends to 1e-20 of the circle.
_MOST_NOME = 0.9
# Armijo's share of the predicted decrease, and rounding of an energy.
_SHARE, _ROUNDING = 1e-4, 1e-13
# Curvatures are taken to be at least this part of the largest where one is negative.
_FLATTEST = 1e-5
# Negative curvature smaller than this part of the largest is rounding.
_FLAT = 1e-12
# Width of a waist, in the length of a loop over its harmonics, that they do not resolve.
_PINCHED = 0.2
# At a saddle, where there is no slope, the step along its lowest mode.
_KICK = 1e-3


@dataclass(frozen=True)
class _State:
    """A loop of length 1 on a sector, with its grid and its energies."""

    c: FloatArray
    nome: float
    energy: float
    bending: float
    area: float

    @classmethod
    def at(cls, sector: Sector, c: FloatArray, nome: float, load: float) -> _State:
        energy, length, bending, area = loop_energy(*sector.columns, load, c, nome)
        return cls(c / length, nome, energy, length * bending, area / length**2)


def relax(
    start: ArrayLike, tension: float, harmonics: int, lobes: int = 2
) -> ConformalFilm | None:
    """Return the film of least energy downhill from a start, or None if none is reached.

    It keeps the start's symmetry, and is a minimum among films that have it; two lobes lie
    along x afterwards. A start with corners is rounded off until the way down shows no bend
    too sharp for the grid; if none helps, more harmonics may.

    None too if the film of two lobes pinches on its way down: where the strands of its
    waist come closer than harmonics resolve, no disk spans what is between them.

    Parameters
    ----------
    start : (points, 3) float
        The loop's vertices, of any size, equidistant in arc length or any other parameter;
        more than two for each of the harmonics. It must have `lobes` lobes alike, the first
        vertex at a tip on the axis x > 0 (the half-turns of sector.py).
    tension : float
        sigma_hat = sigma L^3 / alpha, finite and not negative.
    harmonics : int
        4 or more, of the whole loop.
    lobes : int
        n >= 2.

    Raises
    ------
    SpecError
        For numbers out of range or too few points, and for a start without the symmetry.
    """
    harmonics = whole_number("harmonics", harmonics, 4)
    lobes, load = whole_number("lobes", lobes, 2), finite("tension", tension)
    x = points("start", start, (3,))
    if len(x) <= 2 * harmonics:
        should = f"should have more than {2 * harmonics}, two for each of the harmonics"
        raise SpecError("start", f"found {len(x)} points; {should}")
    levels = [harmonics]
    while levels[0] >= _FEWEST * _FINER:
        levels.insert(0, -(-levels[0] // _FINER))
    sectors = [make_sector(level, lobes) for level in levels]
    c = sectors[0].project(x)
    damping = sectors[0].k ** 2 - 1
    for corners in _CORNERS:
        film = _through(sectors, c * np.exp(-corners * damping), load)
        if film is not None:
            return film
    return None


def _through(sectors: list[Sector], c: FloatArray, load: float) -> ConformalFilm | None:
    """Return the film downhill from a loop on the first sector, from coarse to fine."""
    coarse, steps = sectors[0], 0
    state = _State.at(coarse, c, 0.0, load)
    if not np.isfinite(state.energy):
        return None
    for sector in sectors:
        if sector is not coarse:
            wider = sector.widen(coarse, state.c)
            state = _State.at(sector, wider, state.nome, load)
        free_nome = sector.lobes == 2
        state, taken, _ = _descend(sector, state, load, _COARSE, free_nome)
        coarse, steps = sector, steps + taken
    state, taken, found = _descend(coarse, state, load, _DONE, free_nome=False)
    return _as_film(coarse, state, load, steps + taken) if found else None


def _descend(
    sector: Sector, state: _State, load: float, settled: float, free_nome: bool
) -> tuple[_State, int, bool]:
    """Return a minimum downhill of a loop, the steps to it, and whether it is one.

    With a free nome steps end where they gain little: what is left of the energy is then a
    valley along which loop and grid slide together, which changes nothing.
    """
    scale = np.append(1 / (sector.k * np.sqrt(1 + sector.k**2)), float(free_nome))
    little = settled * abs(state.energy)
    for taken in range(_STEPS):
        gradient, hessian = _derivatives(sector, state, load, scale)
        step, certain = _newton_step(gradient, hessian)
        gain = -float(gradient @ step)
        step *= scale
        after = _downhill(sector, state, load, step, gain)
        if certain and gain <= little:
            return after or state, taken, True
        if after is None:
            return state, taken, False
        if free_nome and certain and state.energy - after.energy <= little:
            return after, taken + 1, True
        state = after
    return state, _STEPS, False


def _downhill(
    sector: Sector, state: _State, load: float, step: FloatArray, gain: float
) -> _State | None:
    """Return the state after the longest part of a step that goes down, or None."""
    change = float(sector.k @ np.abs(step[:-1]))
    short = 1 / max(1.0, change / _TRUST, abs(step[-1]) / _TRUST_NOME)
    for _ in range(_HALVINGS):
        nome = state.nome + short * step[-1]
        if abs(nome) < _MOST_NOME:
            after = _State.at(sector, state.c + short * step[:-1], nome, load)
            least = _SHARE * short * gain - _ROUNDING * abs(state.energy)
            if state.energy - after.energy >= least:
                return after
        short *= 0.5
    return None


def _derivatives(
    sector: Sector, state: _State, load: float, scale: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return gradient and Hessian by the preconditioned coefficients and the nome.

    The energy does not see the loop's size; a stiffness against that is added.
    """
    m = len(state.c)
    gradient, hessian = np.empty(m + 1), np.empty((m + 1, m + 1))
    beta = state.bending - 2 * load * state.area
    loop_derivatives(
        *sector.columns,
        load,
        state.c,
        state.nome,
        beta,
        state.area,
        gradient,
        hessian,
    )
    hessian *= scale[:, None]
    hessian *= scale
    size = state.c / scale[:-1]
    stiffness = np.trace(hessian) / (m * (size @ size))
    hessian[:-1, :-1] += stiffness * size[:, None] * size
    if scale[-1] == 0.0:  # the nome is held
        hessian[-1, -1] = 1.0
    gradient *= scale
    return gradient, hessian


def _newton_step(gradient: FloatArray, hessian: FloatArray) -> tuple[FloatArray, bool]:
    """Return a step downhill (m,), and whether it is Newton's towards a minimum."""
    _, step, failed = dposv(hessian, -gradient)
    if not failed:
        return step, True
    curvatures, modes = eigh(hessian)
    sizes = np.abs(curvatures)
    along = -(modes.T @ gradient) / np.maximum(sizes, _FLATTEST * sizes.max())
    if curvatures[0] < -_FLAT * sizes.max() and abs(along[0]) < _KICK:
        along[0] = np.copysign(_KICK, along[0])
    return modes @ along, False


def _as_film(
    sector: Sector, state: _State, load: float, steps: int
) -> ConformalFilm | None:
    """Return the film of a minimum, in the basis that holds its loop; two lobes along x.

    None if it has pinched.
    """
    gradient, _ = _derivatives(sector, state, load, np.ones(len(state.c) + 1))
    k = sector.k
    scale = 1 / (k * np.sqrt(1 + k**2))
    pull = load * sector.stiffness(state.nome) * state.c
    residual = float(np.abs(scale * gradient[:-1]).max() / np.abs(scale * pull).max())
    c = state.c if state.nome >= 0 else sector.turned(state.c)
    if sector.lobes == 2 and sector.waist(c) < _PINCHED / sector.harmonics:
        return None
    crowding = 1.0 if sector.lobes > 2 else crowding_of(abs(state.nome))
    basis = Basis(sector.harmonics, sector.family, crowding)
    return ConformalFilm(
        basis=basis,
        coefficients=sector.into(basis, c),
        beta=state.bending - 2 * load * state.area,
        load=load,
        energy=state.energy,
        area=state.area,
        bending=state.bending,
        residual=residual,
        corrections=steps,
    )
