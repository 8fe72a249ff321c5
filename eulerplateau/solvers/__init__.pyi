from .condensed import loop_energy as loop_energy
from .equilibrium import (
    RESIDUAL_TOLERANCE as RESIDUAL_TOLERANCE,
    Equilibrium as Equilibrium,
    Status as Status,
)
from .modes import lowest_modes as lowest_modes
from .newton import solve as solve
from .problem import Problem as Problem, make_problem as make_problem
from .second_variation import TangentModel as TangentModel, tangent_model as tangent_model
from .spectrum import Stability as Stability, stability as stability
from .start import displaced as displaced
