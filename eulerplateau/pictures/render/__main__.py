"""The child that renders, started by `draw_shapes`.

Its arguments are `DIR OUT KIND FORMAT COLOUR STEP...`: the run, and where pictures go.
"""

from __future__ import annotations

import sys
from pathlib import Path

from eulerplateau.pictures.render import STILLS, TURN, RunPictures

if __name__ == "__main__":
    folder, out, kind, form, colour, *steps = sys.argv[1:]
    shown = [int(step) for step in steps]
    pictures = RunPictures.read(Path(folder), shown, colour or None, Path(out))
    if kind == STILLS:
        pictures.stills()
    elif kind == TURN:
        pictures.turns(form)
    else:
        pictures.sweep(form)
