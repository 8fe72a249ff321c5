"""The trust-region subproblem in the Hessian's eigenbasis (More and Sorensen 1983)."""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray

# The radius that a descent begins with.
FIRST_RADIUS = 0.05
# As long as the radius is a step that exceeds it by no more than this part of it.
_ROUNDING = 1e-12


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
    # Unknown is the gap between the shift and the least shift that is allowed, not the
    # shift: in the nearly hard case the gap is small and the step goes with its inverse.
    lifted = w + max(0.0, -float(w[0]))
    least = np.finfo(np.float64).eps * max(float(np.abs(w).max()), 1e-300)

    def length(gap: float) -> float:
        return float(np.linalg.norm(g / (lifted + gap)))

    if length(least) <= radius:
        step: FloatArray = -g / (lifted + least)
        step[0] = 0.0
        rest = np.sqrt(max(radius**2 - float(step @ step), 0.0))
        step[0] = -rest if g[0] > 0 else rest
        return step
    # No part of the step is longer than the radius: a least gap, and no more than the gap.
    gap = max(least, float((np.abs(g) / radius - lifted).max()))
    while True:
        bounded: FloatArray = -g / (lifted + gap)
        excess = float(np.linalg.norm(bounded)) / radius - 1
        # By Newton's method for 1 / |p|, concave and nearly linear in the gap, unlike |p|:
        # the gap rises and never too far (Nocedal and Wright 2006, section 4.3).
        slope = float(bounded @ (bounded / (lifted + gap)))
        further = gap + excess * float(bounded @ bounded) / slope
        if excess <= _ROUNDING or further == gap:
            return bounded
        gap = further
