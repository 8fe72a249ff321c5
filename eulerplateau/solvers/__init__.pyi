from .acceptance import change_of_energy as change_of_energy, noise_of as noise_of
from .contact.keeping import Keeping as Keeping, Touching as Touching
from .contact.program import CLOSED as CLOSED, Program as Program
from .contact.record import contacts_at as contacts_at
from .contact.separation import separated as separated
from .correction import Corrected as Corrected, corrected as corrected
from .descent import Descent as Descent
from .equilibrium import (
    LARGEST_LOAD as LARGEST_LOAD,
    RESIDUAL_TOLERANCE as RESIDUAL_TOLERANCE,
    RESOLVED_TURNING as RESOLVED_TURNING,
    SOFTEST_BENDING as SOFTEST_BENDING,
    Equilibrium as Equilibrium,
    Stability as Stability,
    Status as Status,
    with_stability as with_stability,
)
from .models import DenseModels as DenseModels
from .newton import lowest_modes as lowest_modes
from .problem import Problem as Problem
from .second_variation import (
    TangentModel as TangentModel,
    loosened as loosened,
    spectrum_of as spectrum_of,
    stability as stability,
    tangent_model as tangent_model,
)
from .solving import (
    SOLVERS as SOLVERS,
    check_values as check_values,
    follow_steps as follow_steps,
    solve as solve,
    sweep as sweep,
)
from .start import (
    coarse as coarse,
    displaced as displaced,
    smooth_kick as smooth_kick,
)
from .tangent_coordinates import Columns as Columns
from .tangent_space import Directional as Directional, directional as directional
