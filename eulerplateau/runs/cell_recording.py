"""What all runs of cells write: a row and a shape for each, and what run.json says."""

from __future__ import annotations

from collections.abc import Mapping
from hashlib import sha256
from typing import Any

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.cells import CellEquilibrium
from eulerplateau.loop import edges_of
from eulerplateau.runs.cell_shapes import write_cell_shape
from eulerplateau.runs.cell_spec import CellRunSpec
from eulerplateau.runs.recording import OpenRun
from eulerplateau.runs.spec_files import described


def describe(spec: CellRunSpec) -> dict[str, Any]:
    """Return what run.json says before anything is computed."""
    sites = spec.cell.sites()
    places = sha256(sites.points.tobytes() + sites.weights.tobytes()).hexdigest()
    return {
        "kind": "cell",
        "spec": described(spec),
        "mesh": {"sha256": places},
    }


def record_cell(
    run: OpenRun[Any],
    row_type: type[Any],
    varied: str,
    found: CellEquilibrium,
    modes: Mapping[str, FloatArray] | None = None,
    **columns: Any,
) -> Any:
    """Write a cell's shape and its row, of which `varied` names what is varied."""
    row = row_type(
        step=len(run.rows),
        quantity=varied,
        **_columns(found),
        **columns,
    )
    run.folder.add(row, lambda path: write_cell_shape(path, found, row, modes))
    run.rows.append(row)
    return row


def _columns(found: CellEquilibrium) -> dict[str, Any]:
    """Return all columns of a cell but its step."""
    stability = found.stability
    return {
        "sigma_hat": found.sigma_hat,
        "ks_hat": found.ks_hat,
        "beta_hat": found.beta_hat,
        "energy": found.energy,
        "bending_energy": found.bending_energy,
        "film_energy": found.film_energy,
        "adhesion_energy": found.adhesion_energy,
        "line_energy": found.line_energy,
        "perimeter": found.perimeter,
        "area": found.area,
        "kappa_adhesion": float(found.kappa_adhesion.mean()),
        "kappa_mid": float(found.kappa_mid.min()),
        "extension": float(found.extensions.mean()),
        "traction": float(found.traction.mean()),
        "largest_traction": float(found.traction.max()),
        "tangential": float(np.abs(found.tangential).max()),
        "n_unstable": found.n_unstable,
        "lowest_eigenvalue": None if stability is None else stability.lowest,
        "residual": found.residual,
        "iterations": found.iterations,
        "seconds": found.seconds,
        "status": found.status,
        "max_turning": float(np.degrees(np.abs(edges_of(found.x).turning).max())),
    }
