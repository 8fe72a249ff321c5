"""Shapes of cells as .vtp files: the edge as a closed line, the film as triangles."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.cells import CellEquilibrium
from eulerplateau.loop import edges_of
from eulerplateau.mesh import fill_polygon, write_vtp
from eulerplateau.runs.cell_table import CellRow
from eulerplateau.runs.shape_files import of_row

_OF_ITS_ROW = "step", "sigma_hat", "ks_hat", "beta_hat", "energy"


def write_cell_shape(
    path: Path,
    found: CellEquilibrium,
    row: CellRow,
    modes: Mapping[str, FloatArray] | None = None,
) -> None:
    """Write a cell to `path` (.vtp), exactly and whole, in the plane z = 0.

    Point fields: kappa; adhesion (1 where it adheres, else 0); force, of an adhesion on
    the substrate, and rest_place, where the adhesion is at rest, both zero elsewhere; the
    vectors `modes`, (n, 2) each. Field data, of its `row`: step, sigma_hat, ks_hat,
    beta_hat, energy, status and n_unstable, and of a branch its number. Raises
    OutputError if the file cannot be written.
    """
    n, vertices = len(found.x), found.cell.vertices
    edges = edges_of(found.x)
    adhesion = np.zeros(n, dtype=np.uint8)
    adhesion[vertices] = 1
    force, rest = np.zeros((n, 2)), np.zeros((n, 2))
    force[vertices], rest[vertices] = found.forces, found.cell.sites.points
    vectors = {"force": force, "rest_place": rest, **(modes or {})}
    write_vtp(
        path,
        in_space(found.x),
        fill_polygon(found.x),
        loop=np.arange(n),
        point_fields={
            "kappa": edges.turning / edges.means,
            "adhesion": adhesion,
            **{name: in_space(values) for name, values in vectors.items()},
        },
        field_data=of_row(row, *_OF_ITS_ROW),
    )


def in_space(flat: FloatArray) -> FloatArray:
    """Return vectors (n, 2) as (n, 3), their third part zero."""
    return np.column_stack([flat, np.zeros(len(flat))])
