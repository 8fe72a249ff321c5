"""Error against run time: films, solvers and meshes, and Surface Evolver beside them.

Every scene (scenes.py) is computed on meshes of growing fineness by every solver that
can, from the same start. A point is repeated in one process, whose peak memory it is;
making the problem (set-up, with the film's condensation) and solving it are timed apart.
Not counted for ours: the interpreter's start, imports and compiled kernels (start_up), and
making the mesh. Evolver is charged for its whole process, reading its datafile included,
but not for writing it nor for carrying a shape from mesh to mesh.
"""
