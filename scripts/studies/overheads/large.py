"""A true film of 50,000 vertices: seconds of CPU and peak memory of a warm step, as JSON.

In a process of its own, whose peak memory it says: python -m ...large [VERTICES]
"""

from __future__ import annotations

import json
import sys
import time

import numpy as np

from eulerplateau.solvers import Problem, solve
from scripts.studies.common import make_mesh, peak_memory

VERTICES = 50_000
# Loads at which the film lies in two lobes, a step apart.
LOADS = 1500.0, 1510.0, 1520.0, 1530.0, 1540.0, 1550.0


def steps(vertices: int) -> dict[str, object]:
    """Return what each step takes from one load to the next, stability included."""
    polygon = {"kind": "stretched-hexagon", "factor": 2.0}
    disk = make_mesh(polygon=polygon, vertices=vertices)
    problem = Problem(disk, "area")
    seconds, found = [], None
    for load in LOADS:
        began = time.process_time()
        found = solve(problem, load, found)
        seconds.append(time.process_time() - began)
        if not found.converged or found.n_unstable != 0:
            raise SystemExit(f"at {load:g} it is {found.status.value}")
    cold, *warm = seconds
    return {
        "vertices": disk.n_v,
        "loop": disk.n_b,
        "cold": cold,
        "warm": [float(f(warm)) for f in (np.median, np.min, np.max)],
        "memory": peak_memory(),
    }


if __name__ == "__main__":
    wanted = int(sys.argv[1]) if sys.argv[1:] else VERTICES
    sys.stdout.write(json.dumps(steps(wanted)))
