"""Renders: stills, contact sheets, animations of films, always in a child process.

    drawing.py   `draw_shapes` starts the child, which begins in __main__.py
    choice.py    which shapes of a run; fields.py: what a shape can be coloured by
    pictures.py  the kinds of pictures; scene.py: the window VTK draws in; colours.py;
    captions.py  what stands below a picture: its scale, its view, a colour bar
    pages.py     PNGs and contact sheets; animations.py: GIFs and MP4

A graphics driver may crash, so nothing is rendered in the program's own process.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
