"""What pictures show of cells: their outlines, tractions, whether their sides curve in."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.mesh import Shape
from eulerplateau.mesh.drawing import ABOVE, View, view_from
from eulerplateau.pictures.figure import FieldLook
from eulerplateau.pictures.kinds import KindPictures, Stage
from eulerplateau.pictures.outlines import outlines
from eulerplateau.pictures.panels import Panel, panel
from eulerplateau.runs import Branch, Series, cell_state, energy_above

PERIMETER = panel("perimeter $P/R_0$", lambda row: row.perimeter)
KAPPA_MID = panel(
    r"least curvature" "\n" r"mid-side $\kappa R_0$", lambda row: row.kappa_mid, zero=True
)
TRACTION = panel(r"traction $T R_0^2/\alpha$", lambda row: row.traction)
AREA = panel("area $A/R_0^2$", lambda row: row.area)
ENERGY = panel(r"energy $E R_0/\alpha$", lambda row: row.energy)
EIGENVALUE = panel(
    r"smallest eigenvalue $\lambda_1 R_0^4/\alpha$",
    lambda row: row.lowest_eigenvalue,
    logarithmic=True,
)

# The circumference of a round cell of radius R_0.
_SIZE = 2 * np.pi


def _branches(branches: Sequence[Branch]) -> tuple[Panel, ...]:
    """Return the panels of branches.png; the first branch may go both ways.

    Where it is the only one, its energy is shown itself.
    """
    first = [branch for branch in branches if branch.origin is None]
    if len(first) == len(branches):
        return PERIMETER, KAPPA_MID, ENERGY
    excess = energy_above(*first)
    above = Panel(
        r"$(E-E_0)\,R_0/\alpha$", lambda branch: [excess(branch)], solid_only=True
    )
    return PERIMETER, KAPPA_MID, above


def _centred(
    runs: Sequence[tuple[Sequence[Series], FloatArray]], loop: IntArray
) -> list[FloatArray]:
    """Return the shapes of runs, all moved alike, so that the middle of all is the origin.

    Nothing is turned: adhesions hold a cell.
    """
    x = np.concatenate([shapes.reshape(-1, 3) for _, shapes in runs])
    middle = 0.5 * (x.min(axis=0) + x.max(axis=0))
    return [shapes - middle for _, shapes in runs]


def _from_above(shapes: Sequence[Shape]) -> View:
    return view_from(shapes, ABOVE)


def _all_from_above(shapes: Sequence[Shape]) -> list[View]:
    """Return one view for all: a cell's adhesions keep their places."""
    return [_from_above(shapes)] * len(shapes)


def _is_inflected(row: Any) -> bool:
    return bool(row.kappa_mid < 0)


CELL = KindPictures(
    sweep=(PERIMETER, KAPPA_MID, TRACTION, AREA, ENERGY),
    portrayed=True,
    banded=_is_inflected,
    band="inflected",
    branches=_branches,
    plots={
        "diagram": (PERIMETER, TRACTION),
        "energy": (ENERGY,),
        "curvature": (KAPPA_MID,),
        "eigenvalue": (EIGENVALUE,),
    },
    has_onset=False,
    numbered=lambda row: float(row.perimeter),
    flat=lambda row: False,
    portraits=outlines,
    state=lambda row: cell_state(row) or row.status.value.replace("_", " "),
    stage=Stage(
        eye=ABOVE,
        size=_SIZE,
        settled=_centred,
        aligned=lambda shapes: shapes,
        view=_from_above,
        views=_all_from_above,
        length="R₀",
        bar=(1.0 / _SIZE, "$R_0$"),
        colour="kappa",
        fields={"kappa": FieldLook(r"$\kappa R_0$", signed=True)},
    ),
)
