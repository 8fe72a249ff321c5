"""Soap films without a mesh, bounded by a rod that resists twist (docs/welded-loop.md).

    terms.py       the energy's terms for loops that are trigonometric polynomials
    family.py      films that differ in one parameter, for any continuation
    resolution.py  the same film by more harmonics, or another grid
    by_writhe.py   films of given writhe, from flat ones to pinched ones
    curved.py      films of a rod that is curved by nature: curved_family.py, and its frame,
                   frames.py and rod_term.py
    films.py       the film at a load, a twist ratio and a link: what is asked for;
                   with_rod.py: what is said of any film and its rod
    pinched.py     the flat eight, where they end
    touching.py    films whose strands touch: held apart, and the way from one to another
    contact_eight.py  the twisted eight of a loop with a diameter: what is asked for
    contact_limits.py the loads between which it touches in one point

What is exact about loops and films is in exact/conformal; continuation is that of meshes.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
