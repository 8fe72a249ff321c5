"""What pictures show of films: their curvature, the waist's twist, energies."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from math import pi
from pathlib import Path
from typing import Any, cast

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh import Shape
from eulerplateau.mesh.drawing import (
    EYE,
    View,
    aligned,
    common_view,
    is_flat,
    own_views,
)
from eulerplateau.pictures.alignment import settled_runs
from eulerplateau.pictures.figure import ABS_KAPPA_N, MINUS_K, FieldLook, Portraits
from eulerplateau.pictures.kinds import KindPictures, Stage
from eulerplateau.pictures.panels import Panel, panel
from eulerplateau.pictures.vector_film import draw_film, room
from eulerplateau.runs import (
    FLAT_ERRORS,
    Branch,
    Row,
    Series,
    energy_above,
    is_planar,
    read_shape,
)

# The length of a scale bar, in L.
_BAR = 0.1
# A planar film's twist jumps by half turns where its rim passes through itself.
_JUMP = 90.0

_BENT = panel(ABS_KAPPA_N, lambda row: row.abs_kappa_n, error=FLAT_ERRORS["abs_kappa_n"])
_CURVED = panel(
    MINUS_K,
    lambda row: -row.total_gauss_curvature,
    error=FLAT_ERRORS["total_gauss_curvature"],
)
_TWISTED = panel(
    "waist twist (deg)",
    lambda row: abs(row.waist_twist),
    error=FLAT_ERRORS["waist_twist"],
    ticks=(0, 90, 180),
)


def _over_disk(row: Row) -> float:
    return row.energy / (row.sigma_hat / (4 * pi) + 4 * pi**2)


_OVER_DISK = panel(r"$E\,/\,(\hat\sigma/4\pi+4\pi^2)$", _over_disk)
_SWEEP = (
    _BENT,
    _CURVED,
    _TWISTED,
    panel("short / long axis", lambda row: row.aspect, limits=(0, 1.05)),
    _OVER_DISK,
)


def _said(column: str) -> Callable[[Row], float | None]:
    """Return the quantity of a column that only rows of thick loops have."""
    return lambda row: getattr(row, column, None)


_PLOTS: dict[str, tuple[Panel, ...]] = {
    "diagram": (_BENT,),
    "energy": (
        panel(r"$E\,L/\alpha$", lambda row: row.energy),
        _OVER_DISK,
    ),
    "curvature": (_CURVED,),
    "eigenvalue": (
        panel(
            r"smallest eigenvalue $\lambda_1 L^4/\alpha$",
            lambda row: row.lowest_eigenvalue,
            logarithmic=True,
        ),
    ),
    "contact": (
        panel(r"contact force $F\,L^2/\alpha$", _said("contact_force")),
        panel("crossing angle (deg)", _said("crossing_angle")),
    ),
}


def _branches(branches: Sequence[Branch]) -> tuple[Panel, ...]:
    """Return the panels of branches.png.

    The loop's total normal curvature is the order parameter of the paper, in which mirror
    images coincide; in the twist of the film's normal across the waist they do not.
    """
    excess = energy_above(*(branch for branch in branches if branch.origin is None))

    def twists(series: Series) -> Sequence[Any]:
        return signed_twists(cast(Branch, series))

    return (
        _BENT,
        Panel(
            "waist twist (deg)",
            twists,
            error=FLAT_ERRORS["waist_twist"],
            jump=_JUMP,
            solid_only=True,
        ),
        Panel(r"$(E-E_0)\,L/\alpha$", lambda branch: [excess(branch)], solid_only=True),
    )


def signed_twists(branch: Branch) -> list[FloatArray]:
    """Return the waist twist (n,) in degrees, of both sides if the branch is planar.

    A planar film is its own mirror image, and its twist, 0 or a number of half turns, has
    no sign: on a branch that leaves the plane it is that of the side the branch is on.
    """
    twist = np.array([row.waist_twist for row in branch.rows])
    planar = np.array([is_planar(row) for row in branch.rows])
    if planar.all():
        return [np.abs(twist), -np.abs(twist)]
    bent = np.argmax([row.abs_kappa_n for row in branch.rows])
    side = np.sign(twist[bent])
    return [np.where(planar, side * np.abs(twist), twist)]


def _portraits(paths: Sequence[Sequence[Path]]) -> Portraits:
    """Return films as vectors, turned to lie alike, flat ones seen from above."""
    stored = [[read_shape(path) for path in own] for own in paths]
    radii = [0.5 * one.parameters.get("diameter", 0.0) for own in stored for one in own]
    films = [aligned(own) for own in stored]
    every = [shape for shapes in films for shape in shapes]
    views = own_views(every)
    eyes = [view.eye for view in views]
    half = room(every, eyes, max(radii))
    draws = iter(
        [
            partial(draw_film, shape=shape, eye=eye, half=half, radius=radius)
            for shape, eye, radius in zip(every, eyes, radii, strict=True)
        ]
    )
    draw = [[next(draws) for _ in shapes] for shapes in films]
    return Portraits(draw, half, note=_note(every, views), bar=_BAR)


def _note(shapes: Sequence[Shape], views: Sequence[View]) -> str:
    """Return from where films are seen, in a line."""
    heights = {
        view.height(shape)
        for shape, view in zip(shapes, views, strict=True)
        if not is_flat(shape)
    }
    if not heights:
        return "seen from above; bar: $L/10$"
    low, high = min(heights), max(heights)
    others = f"{low}°" if low == high else f"{low}° to {high}°"
    flat = len(shapes) > sum(not is_flat(shape) for shape in shapes)
    which = "flat films are seen from above, others from" if flat else "seen from"
    return f"{which} {others} above their planes; bar: $L/10$"


_FIELDS = {
    "angle_defect": FieldLook("angle defect", signed=True),
    "contact_angle": FieldLook("contact angle"),
    "kappa": FieldLook(r"$\kappa L$"),
    "kappa_n": FieldLook(r"$\kappa_n L$", signed=True),
    "kappa_g": FieldLook(r"$\kappa_g L$", signed=True),
}

FILM = KindPictures(
    sweep=_SWEEP,
    portrayed=False,
    banded=lambda row: not is_planar(row),
    band="not planar",
    branches=_branches,
    plots=_PLOTS,
    errors=FLAT_ERRORS,
    needs={"contact": "contact_force"},
    has_onset=True,
    numbered=lambda row: float(row.abs_kappa_n),
    flat=is_planar,
    portraits=_portraits,
    state=lambda row: "",
    stage=Stage(
        eye=EYE,
        size=1.0,
        settled=settled_runs,
        aligned=aligned,
        view=common_view,
        views=own_views,
        length="L",
        bar=(_BAR, "$L/10$"),
        colour="sides",
        fields=_FIELDS,
    ),
)
