"""Exact planar films bounded by an elastic loop, by elliptic functions (docs/planar.md).

    film.py      `planar_film` at any tension; limits.py: `thresholds` between its regimes
    elastica.py  one solution of the shape equation; halves.py: half a lobe of it
    buckled.py   loops without contact; contact.py: in one point, or along a line
    thickness.py which loops are too thick for how they bend

A film knows its energy, its area, and its curvature and position at any arc length.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
