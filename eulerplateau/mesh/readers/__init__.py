"""What reads which mesh file: each reader returns polygons as the file has them, unchecked.

`content` is what they return, and what they raise; `off`, `ply`, `wavefront`, `stl`,
`legacy_vtk` and `xml_vtk` (`vtk_cells` for both) read the formats of their names, and
`gmsh_files` has Gmsh read .msh in a child process, which is `__main__`.

No library reads these as it should (July 2026): VTK rounds .ply and .obj to single
precision, splits vertices at the seams of a texture and is killed by a count that its file
does not keep; meshio knows no legacy polygons, no .off with its header on one line, no
texture list; trimesh splits polygons as they come, and none but Gmsh reads all of .msh. Text
and numbers, read here, cannot kill anything; what takes memory is compared with the file's
size first.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
