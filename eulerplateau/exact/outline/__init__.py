"""Fits of exact planar films to measured outlines (docs/bench.md).

fit.py       `fit_outline`: lobes, load and size of a film; `fit_racket`: a racket's head
least.py     least squares beside one kind of curve
curves.py    the curves; matching.py: distances of points from one
starts.py    where a fit begins; noise.py: noise that is alike along the outline
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
