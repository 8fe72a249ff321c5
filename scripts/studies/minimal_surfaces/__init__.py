"""Curved soap films on meshes: along normals, and as discrete minimal surfaces.

On the branch that leaves the planar two-lobed film, mesh by mesh: what is left of the
area's gradient inside, relative to its largest on the loop, and the worst triangle, with
vertices where the flat mesh carries them and where the area is least. And the load at which
the branch leaves, on the flat film's mesh and from the twisted films (their load is a
quadratic in the square of the twist).
"""
