"""Elastic loops spanned by soap films: the Euler-Plateau problem on triangulated disks.

    import eulerplateau as ep

Here is what one calls from Python; each name is loaded when it is first used. The rooms
behind it, from the ground up: `exact` (films without a mesh), `loop`, `mesh`, `film`,
`solvers`, `branches`, `cells`, `runs`, `pictures`, `cli`.
"""

import lazy_loader

__version__ = "0.1.0"

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
