from .checks import finite as finite
from .conformal.equilibrium import ConformalFilm as ConformalFilm
from .conformal.relaxation import relax as relax
from .planar.film import (
    PlanarFilm as PlanarFilm,
    planar_film as planar_film,
)
from .planar.limits import thresholds as thresholds
from .tangent_angle.relaxation import (
    PlaneLoop as PlaneLoop,
    relax_in_plane as relax_in_plane,
)
