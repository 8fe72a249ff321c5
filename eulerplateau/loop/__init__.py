"""The elastic loop that bounds a film: its energy, its lengths, its free motions.

    loop.py      the loop itself: rest lengths, curvature's weights, how sharply it turns
    energy.py    an energy as a sum of terms, with its constraint and its free motions:
                 write another `Term` (term.py) in a file of its own to add to the physics
    twist.py     of a rod that was turned before it was welded, by its writhe
    curved_rod.py  of one that is curved by nature; framed.py, how its frame gives way
    rod.py       which of these a loop has, by the numbers that one gives
    frames.py    which way its cross-sections point
    bending.py   the bending term, and the energy of a loop that keeps its lengths
    lengths.py   how the lengths of its edges are kept, or not; how a loop is closed again
    free_bending.py, line_tension.py, adhesions.py  terms of a polygon in the plane whose
                 length is free (edges.py); equal_edges.py: pieces of equal edges
    spline.py    the smooth loop through the vertices
    motions.py   what costs no energy: rigid motions, sliding along itself

Of the other rooms this one knows nothing. Loops are arrays (n, 3), or (n, 2) in a plane;
*kernels.py are compiled by numba.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
