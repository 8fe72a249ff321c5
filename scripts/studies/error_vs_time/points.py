"""A point of a scene: where it is computed, its records and what it came to."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import click
import numpy as np

from scripts.studies.error_vs_time.records import Measurement
from scripts.studies.error_vs_time.scenes import Scene

# Seconds beyond ENOUGH after which a solver is given up, on finer meshes too: 20 s in all.
TOO_SLOW = 10.0


class Place(NamedTuple):
    """Where a point is computed: see Measurement."""

    kind: str
    loop_edges: int
    vertices: int


def as_measurement(
    scene: Scene, solver: str, place: Place, record: dict[str, Any]
) -> Measurement:
    """Return a record with the point it belongs to; its error is not known yet."""
    return Measurement(
        scene=scene.name,
        film=scene.film,
        solver=solver,
        mesh=place.kind,
        loop_edges=place.loop_edges,
        vertices=place.vertices,
        error=math.nan,
        **record,
    )


def summarise(
    scene: Scene, solver: str, place: Place, records: list[dict[str, Any]]
) -> None:
    """Tell what a point came to, on standard error."""
    cost = f"{np.median([r['cpu'] for r in records]):.4f} s" if records else "too slow"
    state = records[-1]["status"] if records else "given up"
    where = f"{solver}, {place.kind}, {place.loop_edges} edges, {place.vertices} vertices"
    click.echo(f"{scene.name}: {where}: {cost}, {state}", err=True)
