"""From a polygon, or from a file made elsewhere, to a checked `DiskMesh`.

Gmsh, meshio, trimesh and VTK are loaded by the call that needs them.
"""

from eulerplateau.meshing.files import load_mesh, read_mesh, write_mesh
from eulerplateau.meshing.generate import MissingLibraryError, generate
from eulerplateau.meshing.spec import ALGORITHMS, MeshSpec

__all__ = [
    "ALGORITHMS",
    "MeshSpec",
    "MissingLibraryError",
    "generate",
    "load_mesh",
    "read_mesh",
    "write_mesh",
]
