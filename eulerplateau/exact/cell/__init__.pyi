from .approximations import (
    constant_width as constant_width,
    errors as errors,
    parabola as parabola,
    parabola_kappa_adhesion as parabola_kappa_adhesion,
    parabola_traction as parabola_traction,
    quartic_side as quartic_side,
)
from .arcs import ArcCell as ArcCell, arc_cell as arc_cell
from .area_fit import AreaFit as AreaFit, Estimate as Estimate, fit_areas as fit_areas
from .breaking import (
    SymmetryBreaking as SymmetryBreaking,
    symmetry_breaking as symmetry_breaking,
    symmetry_lost as symmetry_lost,
)
from .regular import (
    CellStatus as CellStatus,
    RegularCell as RegularCell,
    regular_cell as regular_cell,
)
from .side import HalfSide as HalfSide
from .spreading import (
    RadiusSlopes as RadiusSlopes,
    cell_radius as cell_radius,
    interpolated_radius as interpolated_radius,
    radius_slopes as radius_slopes,
)
from .stars import Star as Star, star as star
from .transitions import (
    Transition as Transition,
    fold_line as fold_line,
    fold_stiffness as fold_stiffness,
    folds as folds,
    inflection_onset as inflection_onset,
    inflection_stiffness as inflection_stiffness,
    inflections as inflections,
    reconnection as reconnection,
    rigid_fold as rigid_fold,
    smooth_cells as smooth_cells,
    strongest_pull as strongest_pull,
)
