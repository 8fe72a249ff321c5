"""Exact planar films piece by piece: interpolants and integrals between their seams."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.polynomial.legendre import leggauss

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.planar import PlanarFilm


def fits(film: PlanarFilm, quantity: Callable[[FloatArray], FloatArray]) -> list[Chebyshev]:
    """Return interpolants of a quantity on the analytic pieces of half a lobe."""
    return [
        Chebyshev.interpolate(quantity, 40, domain=[low, high])
        for low, high in pairwise(film.half_lobe.ends)
    ]


def inside(piece: Chebyshev) -> FloatArray:
    """Return points of a piece, clear of its ends, where differentiation loses digits."""
    low, high = piece.domain
    return np.linspace(low + 0.03 * (high - low), high - 0.03 * (high - low), 50)


def integral(film: PlanarFilm, density: Callable[[FloatArray], FloatArray]) -> float:
    """Return a density's integral over the loop, by Gauss's rule on its pieces."""
    nodes, weights = leggauss(80)
    return (
        2
        * film.lobes
        * sum(
            (high - low)
            / 2
            * float(weights @ density((low + high + (high - low) * nodes) / 2))
            for low, high in pairwise(film.half_lobe.ends)
        )
    )
