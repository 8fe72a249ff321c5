"""Branches of equilibria, stable or not, through folds and bifurcations.

    films.py        branches of a film: `explore`, and how one starts from a shape
    film_family.py  a film at one load, or link, after another, near one shape
    exploration.py  the order in which all branches that hang together are followed
    continuation.py one branch, point by point (point.py); the step's length (control.py)
    between.py      where between two points something vanishes
    special.py      what a fold or a bifurcation is, and the branches that leave it
    kinks.py        where what bounds a loop changes; of strands that touch: gap_bounds.py,
                    contact.py, places.py; everywhere.py and exchange.py: without overlaps
    locus.py        folds and bifurcations in two parameters, point by point
                    (locus_ahead.py, locus_point.py, normal_form.py), what is special on
                    them (locus_between.py); film_locus.py: those of a film
    family.py       what is varied: energies of a loop that differ in one parameter
    catalogue.py    the distinct equilibria at a load: from random loops (loop_starts.py),
                    and by deflation (deflation.py), told apart by likeness.py; where
                    strands touch, by contact_search.py
    symmetry.py     which symmetries a mode breaks; scaling.py: exponents at an onset

Only film*.py, contact*.py and catalogue.py know films: any `Family` of energies of a loop
can be followed.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
