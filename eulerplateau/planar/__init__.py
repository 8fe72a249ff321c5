"""Exact planar films bounded by an elastic loop (docs/planar.md)."""

from eulerplateau.planar.film import (
    LOBES,
    PlanarFilm,
    Regime,
    Thresholds,
    planar_film,
    thresholds,
)

__all__ = ["LOBES", "PlanarFilm", "Regime", "Thresholds", "planar_film", "thresholds"]
