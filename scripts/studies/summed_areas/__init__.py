"""Do summed triangle areas decouple a film from its loop? The paper's reason for springs.

The paper (after eq. discrete-energy): with the sum of the triangles' areas in place of
springs, "most standard local optimization algorithms would attempt to reduce the area of
[the boundary] triangles to zero, thus suppressing the interaction between the boundary and
the interior". Tried here with scipy's conjugate gradients on all coordinates, lengths by an
augmented Lagrangian, against the same energy minimised along normals only, and the exact
planar film.
"""
