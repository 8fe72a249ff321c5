"""How films are drawn, for one shape and for the pictures of whole runs.

`picture` draws a shape in a child process, which is `__main__`; `film` is what pyvista
draws there; `view` is the camera, `alignment` turns shapes to lie alike, `child` starts
processes that may crash.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
