from .by_writhe import (
    RIGID as RIGID,
    critical_moment as critical_moment,
    film_of as film_of,
    films_by_writhe as films_by_writhe,
    stiffness as stiffness,
)
from .contact_eight import ThickEight as ThickEight, thick_eight as thick_eight
from .contact_limits import (
    opening_load as opening_load,
    splitting_load as splitting_load,
)
from .curved import NoFilmError as NoFilmError
from .curved_family import CurvedFamily as CurvedFamily
from .family import SmoothFamily as SmoothFamily, smooth_family as smooth_family
from .films import (
    RodFilm as RodFilm,
    Start as Start,
    rod_film as rod_film,
)
from .locus_harmonics import Harmonics as Harmonics
from .pinched import PinchedEight as PinchedEight, pinched_eight as pinched_eight
from .resolution import in_basis as in_basis, resolved as resolved, tail as tail
from .touching import TouchingFamily as TouchingFamily
