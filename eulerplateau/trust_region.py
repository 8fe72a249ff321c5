"""The trust-region subproblem in the Hessian's eigenbasis (More and Sorensen 1983)."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from eulerplateau.mesh import FloatArray


def trust_region_step(
    eigenvalues: FloatArray, gradient: FloatArray, radius: float
) -> FloatArray:
    """Minimise g.p + p.diag(w).p / 2 over |p| <= radius, the global minimum.

    eigenvalues : (m,) ascending; gradient : (m,), in the eigenbasis. Where the gradient
    has no part along the most negative eigenvector (the hard case, e.g. at a saddle), the
    step goes along that eigenvector, towards its positive side.
    """
    w, g = eigenvalues, gradient
    if w[0] > 0 and np.linalg.norm(g / w) <= radius:
        newton: FloatArray = -g / w
        return newton
    lowest = max(0.0, -float(w[0]))
    size = float(np.linalg.norm(g))
    # A shift that bounds the step from below: relative, so that w + shift > 0 in floats.
    floor = lowest + np.finfo(np.float64).eps * max(float(np.abs(w).max()), 1e-300)

    def excess(shift: float) -> float:
        return float(np.linalg.norm(g / (w + shift))) - radius

    if excess(floor) <= 0.0:
        step: FloatArray = -g / (w + floor)
        step[0] = 0.0
        rest = np.sqrt(max(radius**2 - float(step @ step), 0.0))
        step[0] = -rest if g[0] > 0 else rest
        return step
    shift = brentq(excess, floor, lowest + size / radius + floor, rtol=1e-10)
    bounded: FloatArray = -g / (w + shift)
    return bounded
