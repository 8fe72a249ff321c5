"""Equilibria: the problem, film and loop on a disk, and the minima of its energy.

    solving.py    `solve` and `sweep`, and the solvers by name, to which one adds
    problem.py    what is solved; start.py: where from; equilibrium.py: what comes out,
                  when it counts as converged, and what each status advises
    newton.py     by Newton on the loop; chooses among quadratic.py, soap.py, in_plane/
    descent.py    downhill to a minimum, on trust_region.py; acceptance.py: which steps are
                  taken; primal_dual.py: the fast end
    second_variation.py  Hessian and spectrum at one loop, by tangent_coordinates.py;
                  models.py, quadratic_models.py: of which part, large_loops/ for large ones
    correction.py  an equilibrium to a higher order than its mesh's
    conjugate_gradient.py  the paper's method, by augmented_lagrangian.py, in the unknowns
                  of trial_space.py and variables.py; plain_gradient.py: the paper's;
                  saddles.py: whether what it comes to is one

A solver sees an energy of loops with its constraint, no mesh and no file. Which film it
is is asked in newton.py and in trial_space.py, nowhere else.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
