"""The page's own files, and numbers and arrays as its data hold them."""

from __future__ import annotations

import base64
import math
from importlib.resources import files
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eulerplateau.mesh.drawing import BACK, FRONT, LOOP

# Of numbers: beyond what is shown.
DIGITS = 10


def part(name: str) -> str:
    """Return one of the files that lie here: a script, a style, a library."""
    return files("eulerplateau.pictures.gallery").joinpath(name).read_text(encoding="utf-8")


def cell_of(value: Any) -> Any:
    """Return a cell as JSON has it: null for what is not computed or not finite."""
    if isinstance(value, float):
        return float(f"{value:.{DIGITS}g}") if math.isfinite(value) else None
    return getattr(value, "value", value)


def film_colours() -> list[str]:
    """Return the colours of a film's front and back and of its loop, as HTML has them."""
    colours = (FRONT, BACK, LOOP)
    return ["#" + "".join(f"{round(255 * part):02x}" for part in one) for one in colours]


def base64_of(array: NDArray[Any]) -> str:
    """Return the bytes of an array, in base 64."""
    return base64.b64encode(np.ascontiguousarray(array).tobytes()).decode("ascii")
