from .adhesions import Adhesions as Adhesions
from .bending import Bending as Bending, inextensible as inextensible
from .contacts import Contacts as Contacts
from .curved_rod import CurvedRod as CurvedRod
from .edges import Edges as Edges, edges_of as edges_of
from .energy import Constraint as Constraint, LoopEnergy as LoopEnergy
from .equal_edges import EqualEdges as EqualEdges
from .frames import Frame as Frame, directors as directors
from .free_bending import FreeBending as FreeBending
from .gaps import NEGATIVE as NEGATIVE, NO_GAPS as NO_GAPS, Gaps as Gaps
from .held_gaps import HeldGaps as HeldGaps, with_gaps_held as with_gaps_held
from .lengths import (
    FilmLengths as FilmLengths,
    Lengths as Lengths,
    Unconstrained as Unconstrained,
    close_with_lengths as close_with_lengths,
    project_lengths as project_lengths,
    quickly_projected as quickly_projected,
)
from .line_tension import LineTension as LineTension
from .loop import (
    Loop as Loop,
    backward_differences as backward_differences,
    differences as differences,
    largest_turning as largest_turning,
    strands_meet as strands_meet,
)
from .motions import (
    RIGID_MOTIONS as RIGID_MOTIONS,
    TURNS as TURNS,
    free_motions as free_motions,
    orthonormal_motions as orthonormal_motions,
    remove_sliding as remove_sliding,
    rigid_motions as rigid_motions,
    sliding as sliding,
)
from .rod import Rod as Rod
from .spline import SplineLoop as SplineLoop, Splines as Splines
from .spreads import contact_spreads as contact_spreads
from .strands import Strands as Strands, strands_of as strands_of
from .stretches import ALONG as ALONG, from_one_strand as from_one_strand
from .term import LEAST as LEAST, MOST as MOST, OwnTerm as OwnTerm, Term as Term
from .turns import (
    EdgeTurns as EdgeTurns,
    LengthMetric as LengthMetric,
    edge_turns as edge_turns,
    length_metric as length_metric,
)
from .twist import (
    EvenTwist as EvenTwist,
    PlaneTwist as PlaneTwist,
    Twist as Twist,
    passed as passed,
    polygon_writhe as polygon_writhe,
)
