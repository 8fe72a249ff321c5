"""Newton for films kept in their plane: the angles of the loop's edges are the unknowns.

    search.py  how a minimum is looked for, and what is done where the chain gets stuck
    newton.py  the iteration; chain.py: one point of it; kernels.py, turn_kernels.py:
               compiled, O(n_b) a step

Such a film needs no interior: its area is its polygon's.
"""
