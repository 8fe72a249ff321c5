"""Read a field of a shape file, such as a curvature, to colour the film by."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError
from eulerplateau.mesh import read_vtp


def read_field(path: Path, name: str) -> FloatArray:
    """Return the values (n_v,) of a scalar field of a shape file that `read_shape` reads.

    Raises SpecError naming the fields there are if this is none of them.
    """
    fields = read_vtp(path).point_fields
    scalars = {key: values for key, values in fields.items() if values.ndim == 1}
    if name not in scalars:
        known = ", ".join(sorted(scalars))
        raise SpecError("--colour", f"{name} is no field of {path}: sides, soap, {known}")
    return scalars[name].astype(np.float64)
