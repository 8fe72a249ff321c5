from .film import (
    PlanarFilm as PlanarFilm,
    Regime as Regime,
    planar_film as planar_film,
)
from .limits import (
    LOBES as LOBES,
    Thresholds as Thresholds,
    thresholds as thresholds,
)
from .thickness import TooThickError as TooThickError
