"""True films without a mesh: to rounding in elliptic functions, or to spectral accuracy.

planar/ has the equilibria of a film in its plane, contact of the loop's sides included
(docs/planar.md); tangent_angle/ finds those without contact from a start; conformal/ films
in space, their branches and their stability (docs/true-film.md). Lengths are in units of L,
energies in alpha/L; a tension is sigma_hat = sigma L^3 / alpha.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
