"""What run.json says of a film's run, and of where it is carried out."""

from __future__ import annotations

import platform
from functools import cache
from importlib.metadata import version
from typing import Any

from eulerplateau import __version__
from eulerplateau.mesh import Disk
from eulerplateau.runs.inputs import contents
from eulerplateau.runs.parameters import own_parameter
from eulerplateau.runs.spec import RunSpec
from eulerplateau.runs.spec_files import described
from eulerplateau.threads import pools


def blas_threads() -> list[int]:
    """Return the threads of each BLAS that is loaded, as they are now."""
    return [pool["num_threads"] for pool in pools()]


def describe(spec: RunSpec, mesh: Disk, quantity: str) -> dict[str, Any]:
    """Return what run.json says before anything is computed; `quantity` as in an Opening.

    B and E are the loop's and all edges, from which the paper's sigma = 4 sqrt(3) k /
    (2 - B/E) can be had; for springs sigma_hat in sweep.csv is 2 sqrt(3) k L^3 / alpha.
    """
    return {
        "spec": described(spec),
        "mesh": {
            "sha256": mesh.digest,
            "vertices": mesh.n_v,
            "triangles": len(mesh.triangles),
            "loop_edges_B": mesh.n_b,
            "edges_E": len(mesh.edges),
            "length": mesh.length,
        },
        "seed": spec.start.seed,
        "start_sha256": contents(spec.start.file),
        **({} if own_parameter(quantity) is None else {"varied": quantity}),
    }


def surroundings() -> dict[str, Any]:
    """Return what run.json says of machine and libraries."""
    return {"versions": _versions(), "machine": _machine()}


def _machine() -> str:
    """Return the kind of processor, and for which of them BLAS computes."""
    kinds = {pool.get("architecture", "") for pool in pools()}
    return " ".join([platform.machine(), *sorted(kinds - {""})])


@cache
def _versions() -> dict[str, str]:
    return {
        "eulerplateau": __version__,
        "python": platform.python_version(),
        **{name: version(name) for name in ("numpy", "scipy", "numba", "vtk", "gmsh")},
    }
