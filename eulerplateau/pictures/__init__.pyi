from .branch_plots import draw_branches as draw_branches
from .comparison import draw_plot as draw_plot
from .curves import read_runs as read_runs
from .onset import fit_onset as fit_onset
from .planar import ENERGY as ENERGY, GALLERY as GALLERY, draw_figures as draw_figures
from .plots import draw_diagram as draw_diagram
