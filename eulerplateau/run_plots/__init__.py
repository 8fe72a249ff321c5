"""Figures for print of one run or several, compared.

`curves` reads run folders as curves over the load, `films` draws shapes, `panels` draws
quantities over the load, `onset` the scaling laws where a film leaves its plane; `figures`
puts them together. `python -m eulerplateau.run_plots WHAT FILE DIR...` draws one.
"""

from eulerplateau.run_plots.curves import Run, read_runs
from eulerplateau.run_plots.figures import WHAT, draw_plot, plot_runs, runs_figure

__all__ = ["WHAT", "Run", "draw_plot", "plot_runs", "read_runs", "runs_figure"]
