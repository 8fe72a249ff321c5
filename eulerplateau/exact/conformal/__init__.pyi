from .basis import (
    Basis as Basis,
    Curve as Curve,
    make_basis as make_basis,
)
from .branch import (
    BETTER as BETTER,
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
from .columns import waves as waves
from .eight import FlatEight as FlatEight, flat_eight as flat_eight
from .energy import (
    Blocks as Blocks,
    bending_blocks as bending_blocks,
    bending_energy as bending_energy,
    bending_gradient as bending_gradient,
    bending_hessian as bending_hessian,
    length_blocks as length_blocks,
    length_gradient as length_gradient,
    length_hessian as length_hessian,
    loop_length as loop_length,
)
from .equilibrium import (
    ConformalFilm as ConformalFilm,
    correct as correct,
    disk as disk,
    precondition as precondition,
)
from .families import (
    GENERAL as GENERAL,
    HALF_TURNS as HALF_TURNS,
    LOBED as LOBED,
    PLANAR as PLANAR,
    TWISTED as TWISTED,
    Family as Family,
)
from .finer import finer_bases as finer_bases
from .gauge import (
    gauge_fields as gauge_fields,
    gauge_modes as gauge_modes,
    independent as independent,
    kept_fields as kept_fields,
)
from .geometry import (
    Edge as Edge,
    Surface as Surface,
    edge as edge,
    surface as surface,
    waist as waist,
)
from .jets import Jet as Jet, dot as dot, variables as variables
from .lobes import (
    BUCKLING as BUCKLING,
    first_lobes as first_lobes,
    lobes_twist as lobes_twist,
    two_lobes as two_lobes,
)
from .opening import (
    quick_opening_load as quick_opening_load,
    quick_opening_load_by_width as quick_opening_load_by_width,
    twisted_film as twisted_film,
    twisted_films as twisted_films,
)
from .relaxation import relax as relax
from .second_variation import (
    Mode as Mode,
    modes as modes,
    morse_index as morse_index,
    spectrum as spectrum,
)
from .strands import (
    Crossing as Crossing,
    crossing as crossing,
    nearest_strands as nearest_strands,
)
from .welded import WeldedBasis as WeldedBasis, welded_basis as welded_basis
from .writhe import (
    smooth_writhe as smooth_writhe,
    writhe_blocks as writhe_blocks,
    writhe_gradient as writhe_gradient,
    writhe_hessian as writhe_hessian,
)
