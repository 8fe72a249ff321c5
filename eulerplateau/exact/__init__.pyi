from .bench import (
    Bench as Bench,
    bending_rigidity as bending_rigidity,
    isotropic_twist_ratio as isotropic_twist_ratio,
)
from .bench_changes import Twist as Twist, changes as changes, state as state
from .checks import (
    THICKEST as THICKEST,
    checked_diameter as checked_diameter,
    finite as finite,
)
from .conformal.equilibrium import ConformalFilm as ConformalFilm
from .conformal.relaxation import relax as relax
from .estimates import Estimate as Estimate
from .outline.fit import (
    OutlineFit as OutlineFit,
    fit_outline as fit_outline,
    fit_racket as fit_racket,
)
from .planar.film import (
    PlanarFilm as PlanarFilm,
    planar_film as planar_film,
)
from .planar.limits import thresholds as thresholds
from .tangent_angle.relaxation import (
    PlaneLoop as PlaneLoop,
    relax_in_plane as relax_in_plane,
)
