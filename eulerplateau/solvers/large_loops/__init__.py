"""What makes loops of thousands of vertices affordable, for films of fixed weights.

    coarse_start.py      a rough start on a coarser loop
    subspace_model.py    the second variation on a subspace
    shifted_inverse.py   the structured inverse that spans it

quadratic_models.py chooses them beyond DENSE_LOOP loop vertices.
"""
