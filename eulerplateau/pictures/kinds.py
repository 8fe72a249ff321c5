"""What there is to be told of how a kind of run is pictured; of_run.py knows the kinds."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.mesh import Shape
from eulerplateau.mesh.drawing import View
from eulerplateau.pictures.figure import FieldLook, Portraits
from eulerplateau.pictures.panels import Panel
from eulerplateau.runs import Branch, Series


@dataclass(frozen=True)
class Stage:
    """How shapes are placed and seen in renders and in the gallery.

    Attributes
    ----------
    eye : (3,) float, where the camera of the page stands at first
    size : float, about the length of a loop, in the unit of the shapes
    settled : of curves with their shapes (n, n_v, 3) on one loop, the shapes turned to
        follow each other, for animations
    aligned : shapes turned to lie alike, for prints
    view, views : from where shapes are seen together, and each by itself at one scale
    length : the unit of the shapes
    bar : how long a scale bar is, in lengths of a loop, and what it is called
    colour : str, what renders colour by if nothing is said
    fields : how fields are shown, by name
    """

    eye: FloatArray
    size: float
    settled: Callable[
        [Sequence[tuple[Sequence[Series], FloatArray]], IntArray], list[FloatArray]
    ]
    aligned: Callable[[Sequence[Shape]], Sequence[Shape]]
    view: Callable[[Sequence[Shape]], View]
    views: Callable[[Sequence[Shape]], Sequence[View]]
    length: str
    bar: tuple[float, str]
    colour: str
    fields: Mapping[str, FieldLook]


@dataclass(frozen=True)
class KindPictures:
    """What the pictures of one kind of run show.

    Attributes
    ----------
    sweep : the panels of diagram.png
    portrayed : bool, whether the distinct states stand above them
    banded, band : of a row, whether its load is shaded there; what that means
    branches : the panels of branches.png
    plots : by their names, the panels of `eulerplateau plot`; the shapes stand above those
        of "diagram"
    has_onset : bool, whether `plot --what onset` asks where it leaves its plane
    numbered : the quantity at which a shape's number stands there
    flat : of a row, whether its curve is flat there, so that the number stands below
    portraits : the portraits of shapes, from each run's files
    state : of a row, its state in a word; empty if the shape says it
    stage : how shapes are seen in renders and in the gallery
    errors : by columns, what rounding and residuals can make of a flat shape's value
    needs : by the names of plots, a column without which there is nothing to be seen
    """

    sweep: tuple[Panel, ...]
    portrayed: bool
    banded: Callable[[Any], bool]
    band: str
    branches: Callable[[Sequence[Branch]], tuple[Panel, ...]]
    plots: Mapping[str, tuple[Panel, ...]]
    has_onset: bool
    numbered: Callable[[Any], float]
    flat: Callable[[Any], bool]
    portraits: Callable[[Sequence[Sequence[Path]]], Portraits]
    state: Callable[[Any], str]
    stage: Stage
    errors: Mapping[str, Callable[[Any], float]] = field(default_factory=dict)
    needs: Mapping[str, str] = field(default_factory=dict)
