from .energy import (
    DENSE_LOOP as DENSE_LOOP,
    CondensedEnergy as CondensedEnergy,
    SoapEnergy as SoapEnergy,
    stress_stiffness as stress_stiffness,
)
from .lengths import (
    LengthMetric as LengthMetric,
    close_with_lengths as close_with_lengths,
    jacobian as jacobian,
    length_metric as length_metric,
    project_lengths as project_lengths,
)
from .loop import (
    Loop as Loop,
    backward_differences as backward_differences,
    differences as differences,
)
from .motions import (
    RIGID_MOTIONS as RIGID_MOTIONS,
    TURNS as TURNS,
    free_motions as free_motions,
    rigid_motions as rigid_motions,
    sliding as sliding,
    without as without,
)
