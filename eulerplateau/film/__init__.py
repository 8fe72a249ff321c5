"""The films that span a loop, and each as a function of its loop, the inside eliminated.

    protocol.py   what a film has to do; models.py: the films by name, to which one adds
    load.py       what a film is loaded by, and how that is called
    quadratic.py  springs and Dirichlet's energy: fixed weights, eliminated exactly and once
                  (condensation.py; small ones at once, parts.py, others by elimination.py
                  and dissection.py)
    area.py       the true soap film, on the geometry of its triangles (tiling.py)
    interior.py   that film as a function of its loop near one shape, its vertices moving
                  along normals (heights_film.py, normal_moves.py) or freely (free_film.py),
                  to a discrete minimal surface (minimal_surface.py); area_term.py: its
                  energy
    with_loop.py  film and loop in one sparse matrix, factorised by indefinite.py;
                  strip.py: which vertices follow the loop
    curved_film.py  the film on a smooth loop, of curved triangles (curved_triangles.py)
    repair.py     thin triangles replaced (flips.py); harmonic.py: how it follows its loop
    plane.py      a soap film kept in its plane; plane_mesh.py: how its mesh follows

Of a loop each answers with its force, its energy and its shape; nobody above asks which
kind it is, but where a solver is chosen.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
