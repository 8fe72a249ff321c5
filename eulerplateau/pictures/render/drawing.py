"""Have shapes of a run rendered, as stills or animations, by a child process.

A film is blue on the side its normal points to and orange on the other, so that it is
seen to turn over; the loop is a tube. All pictures of a run have one view and one scale.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from eulerplateau.mesh.drawing import draw_in_child
from eulerplateau.pictures.render.animations import GIF

STILLS, TURN, SWEEP = "stills", "turn", "sweep"
# A driver that hangs is given up after this, and so much per frame.
_SECONDS, _SECONDS_PER_STEP = 120.0, {STILLS: 2.0, TURN: 60.0, SWEEP: 2.0}


def pictures_folder(folder: Path) -> Path:
    """Return where the pictures of a run folder go unless something else is said."""
    return folder / "pictures"


def draw_shapes(
    folder: Path,
    steps: Sequence[int],
    kind: str = STILLS,
    colour: str | None = None,
    form: str = GIF,
    out: Path | None = None,
) -> bool:
    """Draw the shapes of `steps` in a child process; return whether all were drawn.

    `kind` is STILLS, TURN (an animation of each shape) or SWEEP (one of all shapes) and
    `colour` SIDES, SOAP or a scalar field of the shape files; by default what such runs
    are coloured by, films by SIDES. An animation is of a format `form`, GIF or MP4.
    Pictures go to the folder `out`, by default `pictures_folder`. A child that fails or
    crashes is logged and never raises here.
    """
    if not steps:
        return True
    chosen = [str(step) for step in steps]
    timeout = _SECONDS + _SECONDS_PER_STEP[kind] * len(steps)
    return draw_in_child(
        "eulerplateau.pictures.render",
        str(folder),
        str(out or pictures_folder(folder)),
        kind,
        form,
        colour or "",
        *chosen,
        timeout=timeout,
    )
