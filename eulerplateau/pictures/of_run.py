"""Which pictures a run has: the one place that tells kinds of runs apart."""

from __future__ import annotations

from eulerplateau.pictures.film_pictures import FILM
from eulerplateau.pictures.kinds import KindPictures
from eulerplateau.runs import Kind


def pictures_of(kind: Kind) -> KindPictures:
    """Return what the pictures of a kind of run show."""
    if kind.name == "cell":
        # Loaded for cells only.
        from eulerplateau.pictures.cell_pictures import CELL

        return CELL
    return FILM
