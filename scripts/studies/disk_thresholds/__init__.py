"""Where a disk loses stability, of each film on many meshes, against analysis.

The disk is the planar equilibrium, stable or not, that Newton's method in the plane reaches
from the circle. Its second variation falls apart into displacements in the plane and across
it; a threshold is the load at which the lowest eigenvalue of one part vanishes.
"""
