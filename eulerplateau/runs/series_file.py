"""Series of a run's shapes for ParaView (.pvd), and where in its folder each shape lies."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from eulerplateau.mesh import write_whole

# The folders of a run that hold its shapes; what else belongs to its special points.
SHAPES, LOOPS = "shapes", "loops"
SPECIAL, SPECIAL_SHAPES = "special_points.csv", "special_points.pvd"


def shape_name(step: int) -> str:
    """Return the path of a step's shape inside the run folder."""
    return f"{SHAPES}/shape_{step:04d}.vtp"


def loop_name(step: int) -> str:
    """Return the path of a step's loop inside the run folder, of a film."""
    return f"{LOOPS}/loop_{step:04d}.vtp"


@dataclass(frozen=True)
class Listed:
    """A shape in a series.

    Attributes
    ----------
    step, load : of its row
    files : (f,) str, inside the run folder: the shape, and its loop by itself
    """

    step: int
    load: float
    files: tuple[str, ...]

    @classmethod
    def of(cls, folder: Path, step: int, load: float) -> Listed:
        """Return what there is of a step in a run folder."""
        loop = loop_name(step)
        more = (loop,) if (folder / loop).exists() else ()
        return cls(step, load, (shape_name(step), *more))


def write_shapes(path: Path, shapes: Sequence[Listed], load: str) -> None:
    """Write the series `path` over the shapes of a run, `load` being what that is called.

    The time ParaView shows is the load if the loads only rise or only fall,
    and the step otherwise: a sweep up and down meets each load twice, and ParaView shows
    one shape per time. Raises OutputError if the file cannot be written.
    """
    change = np.diff([shape.load for shape in shapes])
    by_load = bool((change > 0).all() or (change < 0).all())
    timed = [(shape.load if by_load else shape.step, shape.files) for shape in shapes]
    write_series(path, sorted(timed), f"load {load}" if by_load else "step")


def write_series(
    path: Path, shapes: Iterable[tuple[float, Sequence[str]]], time_is: str
) -> None:
    """Write a series over `shapes`: (time, files relative to `path`), the film's first.

    Raises OutputError if the file cannot be written.
    """
    lines = [
        f'    <DataSet timestep="{time!r}" part="{part}" file="{file}"/>'
        for time, files in shapes
        for part, file in enumerate(files)
    ]
    content = "\n".join(
        [
            '<?xml version="1.0"?>',
            f"<!-- timestep is the {time_is} -->",
            '<VTKFile type="Collection" version="0.1">',
            "  <Collection>",
            *lines,
            "  </Collection>",
            "</VTKFile>",
            "",
        ]
    )
    write_whole(path, content.encode("utf-8"))
