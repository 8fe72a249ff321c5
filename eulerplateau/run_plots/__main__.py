"""The child process that draws: `python -m eulerplateau.run_plots WHAT FILE DIR...`."""

import sys
from pathlib import Path

from eulerplateau.run_plots import plot_runs, read_runs

plot_runs(read_runs([Path(name) for name in sys.argv[3:]]), sys.argv[1], Path(sys.argv[2]))
