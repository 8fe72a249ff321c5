"""Where the planar two-lobed soap film loses stability to twist, on ever finer meshes.

In its plane the film is a polygon. Across it, at a flat shape, the second variation of the
area is the cotangent Laplacian of the mesh as it lies there, condensed onto the loop: one
n_b x n_b matrix, so meshes of any size will do. The threshold is the load at which its
lowest eigenvalue vanishes on displacements that are no rigid motion.
"""
