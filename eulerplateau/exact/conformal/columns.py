"""Cosines and sines as columns, with their derivatives."""

from __future__ import annotations

from math import pi

import numpy as np

from eulerplateau.arrays import FloatArray

Columns = tuple[tuple[str, int], ...]  # ("cos" or "sin", k) of each
Waves = tuple[FloatArray, FloatArray, FloatArray]  # (n, columns): values, two derivatives


def waves(columns: Columns, phi: FloatArray) -> Waves:
    """Return the columns' values and first two derivatives, each (n, columns)."""
    k = np.array([k for _, k in columns], dtype=np.float64)
    # sin = cos shifted by a quarter turn.
    shift = np.array([0.0 if kind == "cos" else pi / 2 for kind, _ in columns])
    angle = np.outer(phi, k) - shift
    cosine, sine = np.cos(angle), np.sin(angle)
    return cosine, -k * sine, -(k**2) * cosine
