"""A number of the paper beside the program's own."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Number:
    """A number the paper gives, and what is found here, with uncertainties if any."""

    name: str
    paper: float
    here: float
    here_error: float = 0.0
    paper_error: float = 0.0
