"""The child process that draws: `python -m eulerplateau.pictures WHAT FILE DIR...`."""

import sys
from pathlib import Path

from eulerplateau.pictures.comparison import plot_runs
from eulerplateau.pictures.curves import read_runs

plot_runs(read_runs([Path(name) for name in sys.argv[3:]]), sys.argv[1], Path(sys.argv[2]))
