"""Cells from above: their outlines, where they adhere, and how they pull."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import MeshError, OutputError
from eulerplateau.mesh import read_vtp
from eulerplateau.pictures.figure import BLACK, VERMILION, Portraits

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_INSIDE, _EDGE = "#CFE6F5", "#1A1A1A"
# The longest arrow is this part of the field's half width.
_LONGEST = 0.45
_ROOM = 1.1
# Inches.
_WIDEST, _ARROW = 1.7, 0.024


@dataclass(frozen=True)
class Outline:
    """A cell's shape, lengths in R_0 and forces in alpha / R_0^2.

    Attributes
    ----------
    edge : (n, 2) float, cyclic
    held, rest : (N, 2) float, where it adheres, and where its adhesions are at rest
    forces : (N, 2) float, of the adhesions on the substrate
    """

    edge: FloatArray
    held: FloatArray
    rest: FloatArray
    forces: FloatArray


def read_outline(path: Path) -> Outline:
    """Read the shape of a cell; raises OutputError if the file is anything else."""
    try:
        found = read_vtp(path)
        at = found.point_fields["adhesion"] != 0
        vectors = [found.point_fields[name][at, :2] for name in ("rest_place", "force")]
    except (MeshError, KeyError):
        raise OutputError(path, "is not a whole shape file of a cell") from None
    return Outline(found.points[:, :2], found.points[at, :2], *vectors)


def outlines(paths: Sequence[Sequence[Path]]) -> Portraits:
    """Return the outlines of the cells of several runs, and one scale for all arrows."""
    cells = [[read_outline(path) for path in own] for own in paths]
    every = [cell for own in cells for cell in own]
    places = np.concatenate([part for cell in every for part in (cell.edge, cell.rest)])
    low, high = places.min(axis=0), places.max(axis=0)
    middle, half = 0.5 * (low + high), _ROOM * 0.5 * (high - low)
    forces = np.concatenate([cell.forces for cell in every])
    largest = float(np.hypot(*forces.T).max())
    length = _LONGEST * float(half.min()) / (largest or 1.0)
    window = float(half[0]), float(half[1])
    note = (
        "arrows: traction on the substrate, the longest "
        rf"${largest:.3g}\,\alpha/R_0^2$; dots: adhesions at rest; bar: $R_0$"
    )
    draw = [
        [
            partial(draw_outline, cell=cell, middle=middle, half=window, length=length)
            for cell in own
        ]
        for own in cells
    ]
    return Portraits(draw, window, lines=2, widest=_WIDEST, note=note, bar=1.0)


def draw_outline(
    ax: Axes, cell: Outline, middle: FloatArray, half: tuple[float, float], length: float
) -> None:
    """Draw a cell into a field of `half` its width and height about `middle` (2,).

    A force of one is an arrow as long as `length`.
    """
    ax.fill(*cell.edge.T, facecolor=_INSIDE, edgecolor=_EDGE, linewidth=1.0, zorder=2)
    for rest, held in zip(cell.rest, cell.held, strict=True):
        ax.plot(*np.stack([rest, held]).T, color="0.55", linewidth=0.8, zorder=1)
    ax.plot(*cell.rest.T, "o", color=BLACK, markersize=2.8, zorder=3)
    ax.quiver(
        *cell.held.T,
        *(length * cell.forces).T,
        angles="xy",
        scale_units="xy",
        scale=1.0,
        units="inches",
        width=_ARROW,
        headwidth=3.6,
        headlength=4.0,
        headaxislength=3.6,
        minlength=0.5,
        color=VERMILION,
        zorder=4,
    )
    ax.set(
        xlim=(middle[0] - half[0], middle[0] + half[0]),
        ylim=(middle[1] - half[1], middle[1] + half[1]),
        aspect="equal",
    )
    ax.set_axis_off()
