"""Error against run time of the solvers, on meshes from 474 to 200,000 vertices.

The film is the x2.0 hexagon of Gmsh's Frontal-Delaunay triangulation. Two tasks:

cold  load 700 from the flat polygon with the displacement of runs/elongated.toml (seed 1)
warm  load 710 from the converged shape and tensions of load 700

All solvers get the same start. After every step a solver reports its loop; the clock
stops while the report is judged. The error of a report is the larger of its length error
and the relative error of the energy of the relaxed film on that loop (which is kind to cg,
whose own film is not yet relaxed), against the answer of newton, which balances forces to
rounding. Each case runs in a process of its own, so that its peak memory is its own.
"""
