"""Triangulated disks: read or made, checked, moved, and measured.

    disk.py      the mesh at rest, checked; shape.py: a surface of its vertices anywhere
    making.py    `mesh_polygon`; spec.py: what a file of meshes/ may say; polygon.py: the
                 kinds of polygons, to which another is added; generation.py: Gmsh
    files.py     mesh files, formats.py: what reads which; writing.py: what writes
    readers/     what a file holds, format by format; mending.py: a disk made of it, by the
                 steps of cleaning.py
    measures.py  the numbers of a shape that become columns of sweep.csv, on curvature.py,
                 waist.py (twist) and crossings.py (self-intersections);
                 film_contact.py: whether a film comes against its rod
    drawing/     how a film is drawn, in a child process: one shape, or those of a run
    triangles.py areas, angles, neighbours; whole_files.py: a whole file or none

A disk's lengths are in units of L, the length of its loop.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
