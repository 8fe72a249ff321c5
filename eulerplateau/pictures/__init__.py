"""Pictures: what a run looks like, as diagrams, prints, renders, and a page to browse.

    sweep_diagram.py, branch_diagram.py   diagram.png and branches.png, on panels.py:
                     quantities over the load, of any number of runs, legs or branches
    comparison.py    figures for print, of one run or of several; onset.py: scaling laws
    film_pictures.py, cell_pictures.py   what all of these show, by what a run follows:
                     of_run.py tells which, kinds.py what there is to be told
    portraits.py     shapes above a diagram: films by vector_film.py, cells by outlines.py;
                     layers.py: what hides what
    planar.py        figures of the exact planar films
    area_fit.py      cell areas over stiffness, with what was fitted to them
    figure.py        labels, colours, sizes, saving: what all figures have in common
    looks.py         how curves are told apart, and legends; coincidence.py: dashes of
                     curves that coincide; numbers.py: where shapes' numbers have room
    alignment.py     shapes turned to lie alike
    render/          stills and animations by VTK, in a child process (child.py)
    gallery/         a run as one page to browse

A picture that fails is a warning and costs no run.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
