from .catalogue import run_catalogue as run_catalogue
from .catalogue_table import Catalogue as Catalogue, read_catalogue as read_catalogue
from .cell_kind import cell_state as cell_state
from .cell_runs import (
    CellRun as CellRun,
    cell_conflict as cell_conflict,
    run_cell_branches as run_cell_branches,
    run_cell_sweep as run_cell_sweep,
)
from .cell_spec import CellRunSpec as CellRunSpec, load_cell_run as load_cell_run
from .cell_table import CellBranchRow as CellBranchRow, CellRow as CellRow
from .examples import write_examples as write_examples
from .exploration import Exploration as Exploration, run_branches as run_branches
from .kinds import Kind as Kind
from .live_film import LiveFilm as LiveFilm
from .live_values import Varied as Varied
from .locus import run_locus as run_locus
from .locus_record import Asked as Asked, Locus as Locus
from .noise import FLAT_ERRORS as FLAT_ERRORS, without_noise as without_noise
from .phase_diagram import run_phase_diagram as run_phase_diagram
from .phases import REGIONS as REGIONS, PhaseDiagram as PhaseDiagram
from .plan import load_with as load_with, planned as planned, run_name as run_name
from .record import Run as Run, read_run as read_run, read_runs as read_runs
from .rows import (
    COLUMNS as COLUMNS,
    BranchRow as BranchRow,
    CatalogueRow as CatalogueRow,
    Row as Row,
)
from .running import run as run
from .series import (
    Branch as Branch,
    Leg as Leg,
    Quantity as Quantity,
    Series as Series,
    energy_above as energy_above,
)
from .series_file import shape_name as shape_name
from .shape_files import (
    ShapeSequence as ShapeSequence,
    StoredShape as StoredShape,
    read_shape as read_shape,
)
from .spec import RunSpec as RunSpec, load_run as load_run
from .states import distinct_steps as distinct_steps, is_planar as is_planar
from .sweep import (
    RunResult as RunResult,
    conflict as conflict,
    run_sweep as run_sweep,
)
from .visited import Visited as Visited
