"""The films by their names, as film.model in a run's specification has them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from eulerplateau.errors import SpecError
from eulerplateau.film.load import FILM_LOADS

if TYPE_CHECKING:
    from eulerplateau.film.area import AreaFilm
    from eulerplateau.film.protocol import Film
    from eulerplateau.mesh import Disk


def area(disk: Disk) -> AreaFilm:
    """Return the true soap film on a disk."""
    from eulerplateau.film.area import AreaFilm

    return AreaFilm(disk.loop, disk.interior)


def make_film(disk: Disk, model: str = "springs", *, in_plane: bool = False) -> Film:
    """Return the film of a disk: "springs", "dirichlet" or "area".

    Only what that film needs is loaded. `in_plane` keeps a film of true area in the plane
    of its disk. Raises SpecError for another name, or another film kept in its plane;
    MeshError for a disk that cannot carry the film.
    """
    if model not in FILM_LOADS:
        known = ", ".join(repr(name) for name in FILM_LOADS)
        raise SpecError("film", f"found {model!r}; should be one of {known}")
    if in_plane:
        if model != "area":
            raise SpecError("in_plane", f"needs film = 'area'; found {model!r}")
        from eulerplateau.film.plane import plane_film

        return plane_film(disk)
    if model == "area":
        return area(disk)
    from eulerplateau.film.quadratic import dirichlet, springs

    return {"springs": springs, "dirichlet": dirichlet}[model](disk)
