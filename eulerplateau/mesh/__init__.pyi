from .crossings import crossing_pairs as crossing_pairs
from .curvature import Curvatures as Curvatures
from .disk import Disk as Disk
from .files import (
    read_disk as read_disk,
    read_mesh as read_mesh,
    write_mesh as write_mesh,
)
from .filling import fill_polygon as fill_polygon
from .film_contact import film_touches as film_touches
from .generation import generate as generate
from .making import mesh_polygon as mesh_polygon
from .measures import Measurer as Measurer, Measures as Measures, measure as measure
from .polygon import polygon_area as polygon_area, polygon_gradient as polygon_gradient
from .readers.shapes import VtpFile as VtpFile, read_vtp as read_vtp
from .shape import Shape as Shape
from .spec import ALGORITHMS as ALGORITHMS, MeshSpec as MeshSpec
from .triangles import (
    cotangents as cotangents,
    neighbours as neighbours,
    smallest_angle as smallest_angle,
    unit as unit,
)
from .waist import waist_path as waist_path
from .whole_files import (
    TEMPORARY as TEMPORARY,
    sync as sync,
    write_whole as write_whole,
)
from .writing import write_vtp as write_vtp
