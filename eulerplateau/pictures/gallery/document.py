"""The gallery as one HTML file: data, style, scripts and libraries, all inside it."""

from __future__ import annotations

import html
import json
import re
from collections.abc import Sequence
from operator import attrgetter
from typing import Any

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh import Shape
from eulerplateau.mesh.drawing import ABOVE, is_flat, mean_normal
from eulerplateau.pictures.gallery.collection import Exhibit, Gallery, Mesh
from eulerplateau.pictures.gallery.parts import (
    DIGITS,
    base64_of,
    cell_of,
    film_colours,
    part,
)
from eulerplateau.pictures.of_run import pictures_of
from eulerplateau.pictures.wire import Wire, read_wire
from eulerplateau.runs import Run, Series, without_noise

# Beyond what is drawn, and at most 1e-5 L away from it: 16 bits for a loop of length 1.
_INT16 = 32767
# A mark's direction, to half a degree round the wire.
_INT8 = 127
# To less than a tenth of a degree.
_NORMAL_DIGITS = 4
_SCRIPTS = ("quantities", "data", "film", "diagram", "main")


def page(gallery: Gallery) -> bytes:
    """Return the page, UTF-8; with 474 vertices a shape takes 4 kB and the rest 0.8 MB.

    Positions are rounded to 16 bits: by less than 1e-5 of a loop's length. The page's
    content policy forbids the browser to load anything from anywhere.
    """
    title = ", ".join(shown.run.name for shown in gallery.exhibits)
    parts = {
        "title": html.escape(title),
        "licences": part("vendor/LICENSES.txt"),
        "style": part("style.css"),
        "libraries": part("vendor/libraries.min.js"),
        # "<" could end the script it stands in; in JSON it occurs inside texts only.
        "data": json.dumps(_data(gallery), allow_nan=False).replace("<", "\\u003c"),
        "scripts": "".join(part(f"{name}.js") for name in _SCRIPTS),
    }
    template = part("page.html")
    return re.sub(r"\{\{(\w+)\}\}", lambda found: parts[found[1]], template).encode()


def _data(gallery: Gallery) -> dict[str, Any]:
    first = gallery.exhibits[0].run
    stage = pictures_of(first.kind).stage
    size = max(float(np.abs(shown.x).max()) for shown in gallery.exhibits)
    eye = _first_eye(gallery, stage.eye)
    # Across and up the first view, in which z points up.
    across = np.cross([0.0, 0.0, 1.0], eye)
    screen = np.stack([across, np.cross(eye, across)], axis=1)
    screen /= np.linalg.norm(screen, axis=0)
    seen = [np.abs(shown.x @ screen).max(axis=(0, 1)) for shown in gallery.exhibits]
    unit = size / _INT16 or 1.0
    runs = [shown.run for shown in gallery.exhibits]
    columns = dict.fromkeys(name for run in runs for name in run.kind.columns)
    columns["special"] = None
    made = [_run(shown, unit, stage.size, list(columns)) for shown in gallery.exhibits]
    return {
        "kind": first.kind.name,
        "columns": list(columns),
        "load": first.load.column,
        "loadUnit": first.load.unit,
        "unit": unit,
        "size": stage.size,
        "eye": eye.tolist(),
        "length": stage.length,
        "colours": film_colours(),
        "halfSize": np.max(seen, axis=0).tolist(),
        "meshes": [_mesh(mesh) for mesh in gallery.meshes],
        "radius": max(max(run["radii"]) for run in made),
        "runs": made,
    }


def _first_eye(gallery: Gallery, eye: FloatArray) -> FloatArray:
    """Return from where shapes are seen at first: from above if all are flat."""
    flat = all(
        is_flat(Shape(x, shown.shapes.triangles(place), shown.shapes.loop))
        for shown in gallery.exhibits
        for place, x in enumerate(shown.x)
    )
    return ABOVE if flat else eye


def _mesh(mesh: Mesh) -> dict[str, Any]:
    return {
        "vertices": mesh.n_v,
        "triangles": base64_of(mesh.triangles.astype("<u4")),
        "loop": base64_of(mesh.loop.astype("<u4")),
    }


def _run(
    shown: Exhibit, unit: float, size: float, columns: Sequence[str]
) -> dict[str, Any]:
    run, shapes, wires = shown.run, shown.shapes, _wires(shown)
    return {
        "name": run.name,
        "mesh": shown.mesh,
        "tilings": [
            [first, base64_of(tiles.astype("<u4"))] for first, tiles in shapes.tilings[1:]
        ],
        "shapes": base64_of(np.rint(shown.x / unit).astype("<i2")),
        "marks": _marks(wires),
        "radii": [float(f"{size * wire.radius:.{DIGITS}g}") for wire in wires],
        "series": [_series(series) for series in run.series],
        "special": run.special,
        "normals": [
            np.round(mean_normal(x[shapes.loop]), _NORMAL_DIGITS).tolist() for x in shown.x
        ],
        "rows": [
            [cell_of(cells[name]) for name in columns] for cells in _cells(run, columns)
        ],
    }


def _cells(run: Run, columns: Sequence[str]) -> list[dict[str, Any]]:
    """Return the cells of every row, by column; what is noise of a flat shape is zero."""
    kind = pictures_of(run.kind)
    cells = [{name: _shown(row, name) for name in columns} for row in run.rows]
    for name, error in kind.errors.items():
        for series in run.series:
            values = without_noise(series.rows, series.values(attrgetter(name)), error)
            borrowed = series.start is not None
            for place, value in enumerate(values[borrowed:], series.first):
                row = run.rows[place]
                noise = kind.flat(row) and abs(value) <= error(row)
                cells[place][name] = 0.0 if noise else float(value)
    return cells


def _shown(row: Any, name: str) -> Any:
    """Return a cell of a row; of what is varied in the unit in which that is shown."""
    return row.load if name == row.load_name.column else getattr(row, name, None)


def _wires(shown: Exhibit) -> list[Wire]:
    """Return the wires of every shape, as it lies on the page."""
    found = []
    for place, row in enumerate(shown.run.rows):
        triangles, loop = shown.shapes.triangles(place), shown.shapes.loop
        shape = Shape(shown.x[place], triangles, loop)
        found.append(read_wire(shown.run.shape_path(row), shape))
    return found


def _marks(wires: Sequence[Wire]) -> str | None:
    """Return which way the wire is marked on the edges of every shape's loop, 8 bits each.

    None of a run without marks. The positions they belong to are those on the page, turned.
    """
    drawn = [wire.marks for wire in wires if wire.marks is not None]
    if len(drawn) < len(wires):
        return None
    return base64_of(np.rint(_INT8 * np.stack(drawn)).astype("i1"))


def _series(series: Series) -> dict[str, Any]:
    return {
        "name": series.name,
        "group": series.group,
        "first": series.first,
        "last": series.last,
        "origin": series.start,
    }
