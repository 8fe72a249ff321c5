from .branches import (
    SpecialPoint as SpecialPoint,
    explore as explore,
    fit_power as fit_power,
)
from .errors import EulerPlateauError as EulerPlateauError
from .exact import (
    planar_film as planar_film,
    relax as relax,
    relax_in_plane as relax_in_plane,
)
from .mesh import (
    Disk as Disk,
    Measures as Measures,
    Shape as Shape,
    measure as measure,
    mesh_polygon as mesh_polygon,
    read_disk as read_disk,
)
from .runs import read_run as read_run, read_shape as read_shape, run as run
from .solvers import (
    Corrected as Corrected,
    Equilibrium as Equilibrium,
    Problem as Problem,
    Status as Status,
    corrected as corrected,
    solve as solve,
    sweep as sweep,
)

__version__: str
