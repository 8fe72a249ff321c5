"""What tables and shapes say of the strands of a thick loop that touch.

Loaded only for loops that have a diameter.
"""

from __future__ import annotations

from dataclasses import asdict
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray
from eulerplateau.runs.own_columns import OfContact
from eulerplateau.solvers import Equilibrium, Problem


def contact_cells(found: Equilibrium) -> dict[str, Any]:
    """Return the cells of `OfContact` of an equilibrium."""
    contacts, size = found.contacts, len(found.shape.x)
    if contacts is None:  # nothing was found, as where strands cannot be parted
        return asdict(OfContact(None, None, None, None, size))
    strongest = int(np.argmax(contacts.forces)) if len(contacts) else None
    gap = contacts.smallest_gap
    angle = None if strongest is None else float(contacts.angles[strongest])
    near = gap if isfinite(gap) else None
    return asdict(OfContact(len(contacts), contacts.force, near, angle, size))


def contact_forces(problem: Problem, found: Equilibrium) -> FloatArray:
    """Return the pushes (n_v, 3) on the vertices nearest to the contacts, alpha / L^2.

    Each strand is pushed away from the other. NaN inside the film.
    """
    forces = np.full_like(found.shape.x, np.nan)
    forces[found.shape.loop] = _on_loop(problem, found)
    return forces


def _on_loop(problem: Problem, found: Equilibrium) -> FloatArray:
    shape, contacts = found.shape, found.contacts
    pushed = np.zeros_like(shape.x_loop)
    if contacts is None or not len(contacts):
        return pushed
    one, other = contacts.points
    across = one - other
    across /= np.linalg.norm(across, axis=1)[:, None]
    along = np.concatenate([[0.0], np.cumsum(problem.loop_of(shape).rest_lengths)])
    middles = 0.5 * (along[1:] + along[:-1])
    pushes = contacts.forces[:, None] * across
    for places, push in (contacts.s, pushes), (contacts.t, -pushes):
        nearest = np.searchsorted(middles, places % along[-1]) % len(pushed)
        np.add.at(pushed, nearest, push)
    return pushed


def contact_data(problem: Problem, found: Equilibrium) -> dict[str, NDArray[Any]]:
    """Return field data of a shape: thickness, exact places and forces of its contacts.

    contact_points (2k, 3) are on the centrelines, two in a row a contact, in units of L;
    contact_forces (k,) in alpha / L^2.
    """
    contacts = found.contacts
    points, forces = np.zeros((0, 3)), np.zeros(0)
    if contacts is not None:
        points = contacts.points.transpose(1, 0, 2).reshape(-1, 3)
        forces = contacts.forces
    return {
        "diameter": np.array([problem.loop.diameter]),
        "contact_points": points,
        "contact_forces": forces,
    }
