"""Bases that resolve a film better."""

from __future__ import annotations

from collections.abc import Iterator

from eulerplateau.exact.conformal.basis import Basis

# How far a basis is refined.
MOST_HARMONICS = 288
_MOST_CROWDED = 1e-12


def finer_bases(basis: Basis, most_harmonics: int = MOST_HARMONICS) -> Iterator[Basis]:
    """Yield bases that may resolve a film better."""
    for harmonics, sharper in basis.refinements():
        crowding = basis.crowding / sharper
        if harmonics <= most_harmonics and crowding >= _MOST_CROWDED:
            yield basis.like(harmonics, basis.family, crowding)
