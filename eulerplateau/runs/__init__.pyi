from .exploration import Exploration as Exploration, run_branches as run_branches
from .folder import shape_name as shape_name
from .reading import read_table as read_table, read_tables as read_tables
from .series import (
    Branch as Branch,
    energy_above as energy_above,
    read_branches as read_branches,
    signed_twists as signed_twists,
)
from .shape_files import Shape as Shape, read_shape as read_shape
from .spec import RunSpec as RunSpec, load_run as load_run
from .states import distinct_steps as distinct_steps, is_planar as is_planar, legs as legs
from .sweep import RunResult as RunResult, run_sweep as run_sweep
from .table import COLUMNS as COLUMNS, BranchRow as BranchRow, Row as Row
