"""True soap films bounded by an elastic loop, to spectral accuracy (docs/true-film.md).

    relaxation.py   `relax`: downhill from a start to a film, on kernels.py
    basis.py        loops as trigonometric polynomials, of columns.py; families.py: their
                    symmetry; grading.py: grids for narrow waists; finer.py: finer bases;
                    sector.py: the part that symmetry repeats
    welded.py       loops whose curvature jumps at a weld; tails.py: what that leaves
    energy.py       bending, length, area and their derivatives; writhe.py: the writhe
    equilibrium.py  Newton's method to an equilibrium, stable or not; gauge.py: motions that
                    change nothing
    branch.py       branches: followed, located, switched; second_variation.py: stability
    geometry.py     the film as a surface, its edge and its waist
    eight.py        the flat eight, eight_modes.py: its stability; held_waist.py: films
                    whose waist is held; strands.py: where strands are nearest;
                    opening.py: the twisted film of given waist, at which an eight opens

A film is its loop, whose harmonic extension is minimal where it is conformal.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
