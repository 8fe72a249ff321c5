"""The child that renders, started by `draw_shapes`.

Its arguments are `DIR KIND FORMAT COLOUR STEP...`.
"""

from __future__ import annotations

import sys
from pathlib import Path

from eulerplateau.pictures.render import STILLS, TURN, RunPictures

if __name__ == "__main__":
    folder, kind, form, colour, *steps = sys.argv[1:]
    pictures = RunPictures.read(Path(folder), [int(step) for step in steps], colour or None)
    if kind == STILLS:
        pictures.stills()
    elif kind == TURN:
        pictures.turns(form)
    else:
        pictures.sweep(form)
