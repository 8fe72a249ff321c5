"""What reads which mesh file: each reader returns polygons as the file has them, unchecked.

`content` is what they return, and what they raise; `off`, `ply`, `wavefront`, `stl`,
`legacy_vtk` and `xml_vtk` (`vtk_cells` for both) read the formats of their names, `shapes`
what a run has written, fields included, and `gmsh_files` has Gmsh read .msh in a child
process, which is `__main__`.

No one library reads these as it should (VTK 9.7, meshio 5.3, trimesh 5.2): VTK rounds .ply
and .obj to single precision, reads a cut legacy file as a smaller one, and a count that a
file does not keep can kill it; meshio knows no legacy polygons, no .off with its header on
one line, no texture list; trimesh splits polygons as they come. Only Gmsh reads all of
.msh. What is read here cannot kill the program: a count is compared with what the file
holds before it takes memory.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
