"""What a loop's energy has beside its bending, as conjugate gradients see it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import Loop
from eulerplateau.mesh import Shape

# Energy, alpha / L: of a circle it is 40.
_TOO_FAR = 1e6


def beyond_linear(loop: Loop, shape: Shape) -> Callable[[FloatArray, FloatArray], float]:
    """Return a function of a displacement (n_v, 3) from a shape, and of a gradient.

    It returns what the terms gain, their linear part left out, and adds the gradient of
    that to `gradient` (n_v, 3). Where a strand would pass through another it is more than
    any step gains, and finite, for line searches interpolate.
    """
    x = shape.x_loop
    terms = [(term, term.force(x)) for term in loop.terms.values()]

    def gained(moved: FloatArray, gradient: FloatArray) -> float:
        step, value = moved[shape.loop], 0.0
        for term, force in terms:
            try:
                value += term.change(x, step) - float(np.vdot(force, step))
            except LinAlgError:
                return _TOO_FAR
            gradient[shape.loop] += term.force(x + step) - force
        return value

    return gained
