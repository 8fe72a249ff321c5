from .adhesion_sites import (
    Sites as Sites,
    read_sites as read_sites,
    regular_sites as regular_sites,
)
from .cell import Cell as Cell
from .equilibrium import CellEquilibrium as CellEquilibrium
from .family import (
    CellFamily as CellFamily,
    CellPoint as CellPoint,
    cell_near as cell_near,
    explore_cell as explore_cell,
)
from .regular import (
    symmetric_index as symmetric_index,
    symmetric_part as symmetric_part,
)
from .solving import ENDS as ENDS, solve_cell as solve_cell, sweep_cell as sweep_cell
from .touching import crosses_itself as crosses_itself, strands_near as strands_near
