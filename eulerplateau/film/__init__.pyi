from .area import AreaFilm as AreaFilm, AreaOfLoop as AreaOfLoop
from .curved_film import (
    SmoothFilm as SmoothFilm,
    SmoothFilmAtRest as SmoothFilmAtRest,
    smooth_film as smooth_film,
)
from .indefinite import (
    IndefiniteFactor as IndefiniteFactor,
    negative_pivots as negative_pivots,
)
from .interior import LocalFilm as LocalFilm
from .load import (
    FILM_LOADS as FILM_LOADS,
    LOADS as LOADS,
    SPRING_LOAD as SPRING_LOAD,
    TENSION as TENSION,
    Load as Load,
)
from .models import make_film as make_film
from .plane import PlaneFilm as PlaneFilm, PolygonArea as PolygonArea
from .protocol import Film as Film, FilmOfLoop as FilmOfLoop
from .quadratic import QuadraticFilm as QuadraticFilm, Stiffness as Stiffness
from .refinement import EdgeSizes as EdgeSizes, Finer as Finer
from .with_loop import LoopStiffness as LoopStiffness
