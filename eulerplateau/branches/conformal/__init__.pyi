from .by_writhe import (
    RIGID as RIGID,
    critical_moment as critical_moment,
    films_by_writhe as films_by_writhe,
)
from .family import SmoothFamily as SmoothFamily
