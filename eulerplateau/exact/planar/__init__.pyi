from .film import (
    LOBES as LOBES,
    PlanarFilm as PlanarFilm,
    Regime as Regime,
    Thresholds as Thresholds,
    planar_film as planar_film,
    thresholds as thresholds,
)
