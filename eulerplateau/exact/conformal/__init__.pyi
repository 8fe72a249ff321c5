from .basis import (
    PLANAR as PLANAR,
    TWISTED as TWISTED,
    Basis as Basis,
    Family as Family,
    make_basis as make_basis,
)
from .branch import (
    BranchError as BranchError,
    BranchPoint as BranchPoint,
    change_basis as change_basis,
    follow as follow,
    go_to_load as go_to_load,
    locate as locate,
    resolve as resolve,
    start as start,
    switch as switch,
)
from .eight import FlatEight as FlatEight, flat_eight as flat_eight
from .equilibrium import ConformalFilm as ConformalFilm, correct as correct, disk as disk
from .geometry import (
    Edge as Edge,
    Surface as Surface,
    edge as edge,
    surface as surface,
    waist as waist,
)
from .relaxation import relax as relax
from .second_variation import (
    Mode as Mode,
    modes as modes,
    morse_index as morse_index,
    spectrum as spectrum,
)
