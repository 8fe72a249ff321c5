from .curvature import angle_defects as angle_defects, loop_frame as loop_frame
from .disk import DiskMesh as DiskMesh
from .files import load_mesh as load_mesh, read_mesh as read_mesh, write_mesh as write_mesh
from .generation import MissingLibraryError as MissingLibraryError, generate as generate
from .measures import Measurer as Measurer, Measures as Measures, measure as measure
from .shape import Shape as Shape
from .spec import ALGORITHMS as ALGORITHMS, MeshSpec as MeshSpec
from .triangles import (
    neighbours as neighbours,
    smallest_angle as smallest_angle,
    unit as unit,
)
from .waist import waist_path as waist_path
