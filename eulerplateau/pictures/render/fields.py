"""The fields a shape file holds beside its positions."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError


def read_field(path: Path, name: str) -> FloatArray:
    """Return the values (n_v,) of a scalar field of a shape file that `read_shape` reads.

    Raises SpecError naming the fields there are if this is none of them.
    """
    from vtkmodules.util import numpy_support
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    reader: Any = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    data = reader.GetOutput().GetPointData()
    arrays = [data.GetArray(number) for number in range(data.GetNumberOfArrays())]
    scalars = {a.GetName(): a for a in arrays if a.GetNumberOfComponents() == 1}
    if name not in scalars:
        known = ", ".join(sorted(scalars))
        raise SpecError("--colour", f"{name} is no field of {path}: sides, soap, {known}")
    to_numpy: Any = numpy_support.vtk_to_numpy
    values: FloatArray = to_numpy(scalars[name]).astype(np.float64)
    return values
