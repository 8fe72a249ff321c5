from .area import AreaFilm as AreaFilm
from .area_energy import AreaEnergy as AreaEnergy
from .condensation import Condensation as Condensation, condense as condense
from .harmonic import balance as balance
from .interior import THIN as THIN, Chart as Chart, chart_at as chart_at
from .load import (
    FILM_LOADS as FILM_LOADS,
    LOADS as LOADS,
    SPRING_LOAD as SPRING_LOAD,
    TENSION as TENSION,
    Load as Load,
)
from .minimal_surface import is_flat as is_flat, minimal as minimal
from .plane import (
    PlaneFilm as PlaneFilm,
    plane_film as plane_film,
    polygon_gradient as polygon_gradient,
)
from .plane_energy import PlaneEnergy as PlaneEnergy
from .plane_mesh import carried_in_plane as carried_in_plane
from .quadratic import FILMS as FILMS, Film as Film
from .repair import carried as carried, repaired as repaired
