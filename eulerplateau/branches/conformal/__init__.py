"""Soap films without a mesh, bounded by a rod that resists twist (docs/welded-loop.md).

    terms.py       the energy's terms for loops that are trigonometric polynomials
    family.py      films that differ in one parameter, for any continuation
    resolution.py  the same film by more harmonics, or another grid
    by_writhe.py   films of given writhe, from flat ones to pinched ones
    curved.py      films of a rod that is curved by nature: curved_family.py, and its frame,
                   frames.py and rod_term.py
    films.py       the film at a load, a twist ratio and a link: what is asked for
    pinched.py     the flat eight, where they end

What is exact about loops and films is in exact/conformal; continuation is that of meshes.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
