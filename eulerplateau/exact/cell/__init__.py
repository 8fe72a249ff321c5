"""Exact cells: contractile films whose edge is free in length and held by adhesions.

    spreading.py       `cell_radius`: a round cell on a continuous adhesion
    area_fit.py        `fit_areas`: contractility and bending from measured areas;
                       area_model.py: the areas expected
    regular.py         `regular_cell`: on a regular polygon of adhesions, from the
                       boundary-value problem; side.py: half a side, by polynomials
    tethered.py        all shapes of a regular cell on one curve
    transitions.py     inflection and folds, located on it
    stability.py       against all displacements; breaking.py: where symmetry is lost
    stars.py           concave cells with cusps, and their protrusions
    arcs.py            the limit without bending
    approximations.py  the paper's formulas, to be measured

Spreading and fits are in the caller's own units. Otherwise alpha = R_0 = 1: sigma_hat =
sigma R_0^3 / alpha, ks_hat = k_s R_0^3 / alpha, beta_hat = beta R_0^2 / alpha; see
docs/cells.md.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
