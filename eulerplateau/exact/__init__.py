"""True films without a mesh: to rounding in elliptic functions, or to spectral accuracy.

    planar/         `planar_film`: equilibria of a film in its plane, contact of the loop's
                    sides included (docs/planar.md)
    cell/           `regular_cell`: cells on adhesions, their transitions (docs/cells.md)
    tangent_angle/  `relax_in_plane`: those without contact, downhill from a start
    conformal/      `relax`: films in space, downhill from a start; their branches and
                    their stability (docs/true-film.md)
    cell/           round cells on a continuous adhesion, and their fit (docs/cells.md)
    bench.py        a loop of a real line, in SI units: its load; bench_changes.py: where
                    it changes
    outline/        `fit_outline`: planar films fitted to measured outlines; profiles.py,
                    estimates.py: intervals of what is fitted, here and of cells
    checks.py       what is asked of their arguments

Of films, lengths are in units of L, energies in alpha/L; a tension is sigma_hat =
sigma L^3 / alpha.
Of the other rooms this one knows nothing: it is the referee of everything on a mesh.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
