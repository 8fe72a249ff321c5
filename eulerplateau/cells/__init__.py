"""Adherent cells: contractile films in the plane with a free edge, held at a few points.

    adhesion_sites.py  where a cell adheres: `regular_sites`, `read_sites`
    cell.py         the cell: its energy, and where to start from
    solving.py      `solve_cell` and `sweep_cell`; equilibrium.py: what comes out
    touching.py     where a cell ends: its edge meets itself, or two adhesions meet
    family.py       branches in the contractility or the stiffness: `explore_cell`
    regular.py      what is symmetric of a cell on a regular polygon

Units: lengths R0, energies alpha / R0. The contractility is sigma_hat = sigma R0^3 / alpha,
the stiffness of the adhesions ks_hat = k_s R0^3 / alpha (an energy k_s |r - r0|^2 each),
the line tension beta_hat = beta R0^2 / alpha. The edge runs counter-clockwise.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
