from .area_fit import draw_area_fit as draw_area_fit
from .branch_diagram import draw_branches as draw_branches
from .catalogue_picture import draw_catalogue as draw_catalogue
from .comparison import check_plot as check_plot, draw_comparison as draw_comparison
from .locus_picture import draw_locus as draw_locus
from .of_run import pictures_of as pictures_of
from .onset import fit_onset as fit_onset
from .outline_fit import draw_outline_fit as draw_outline_fit
from .phase_diagram import (
    PHASE_DIAGRAM as PHASE_DIAGRAM,
    draw_phase_diagram as draw_phase_diagram,
)
from .planar import ENERGY as ENERGY, GALLERY as GALLERY, draw_figures as draw_figures
from .sweep_diagram import draw_diagram as draw_diagram
