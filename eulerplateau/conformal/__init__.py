"""True soap films bounded by an elastic loop, to spectral accuracy (docs/true-film.md)."""

from eulerplateau.conformal.basis import PLANAR, TWISTED, Basis, Family, make_basis
from eulerplateau.conformal.branch import (
    BranchError,
    BranchPoint,
    change_basis,
    follow,
    go_to_load,
    locate,
    resolve,
    start,
    switch,
)
from eulerplateau.conformal.eight import FlatEight, flat_eight
from eulerplateau.conformal.equilibrium import ConformalFilm, correct, disk
from eulerplateau.conformal.geometry import Edge, Surface, edge, surface, waist
from eulerplateau.conformal.relaxation import relax
from eulerplateau.conformal.spectrum import Mode, modes, morse_index, spectrum

__all__ = [
    "PLANAR",
    "TWISTED",
    "Basis",
    "BranchError",
    "BranchPoint",
    "ConformalFilm",
    "Edge",
    "Family",
    "FlatEight",
    "Mode",
    "Surface",
    "change_basis",
    "correct",
    "disk",
    "edge",
    "flat_eight",
    "follow",
    "go_to_load",
    "locate",
    "make_basis",
    "modes",
    "morse_index",
    "relax",
    "resolve",
    "spectrum",
    "start",
    "surface",
    "switch",
    "waist",
]
