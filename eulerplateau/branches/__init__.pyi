from .catalogue import Entry as Entry, Plan as Plan, catalogue_at as catalogue_at
from .continuation import follow as follow
from .control import StepControl as StepControl
from .exploration import (
    DiagramPoint as DiagramPoint,
    Limits as Limits,
    explore_from as explore_from,
    explore_on as explore_on,
)
from .family import Family as Family, UnboundedFamily as UnboundedFamily
from .film_family import (
    FilmFamily as FilmFamily,
    equilibrium as equilibrium,
    likeness_of as likeness_of,
)
from .film_locus import (
    Known as Known,
    energy_at as energy_at,
    locus_of_film as locus_of_film,
)
from .films import (
    FilmPoint as FilmPoint,
    equilibrium_near as equilibrium_near,
    explore as explore,
    film_point as film_point,
    first_equilibrium as first_equilibrium,
    where_from as where_from,
)
from .locus import (
    End as End,
    follow_locus as follow_locus,
    locus_start as locus_start,
    special_at as special_at,
)
from .locus_between import Resolution as Resolution, Special as Special
from .locus_point import LocusPoint as LocusPoint
from .point import (
    BranchPoint as BranchPoint,
    first_point as first_point,
    point_near as point_near,
)
from .progress import Arrays as Arrays, progress_from as progress_from
from .scaling import PowerLaw as PowerLaw, fit_power as fit_power
from .special import (
    BIFURCATION as BIFURCATION,
    CONTACT as CONTACT,
    FOLD as FOLD,
    SpecialPoint as SpecialPoint,
    branches_from as branches_from,
    multiple as multiple,
)
