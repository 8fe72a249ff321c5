"""Parametrised tests of which some parameters are quick tests, and the others slow ones."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest


def quick_with(quick: Iterable[Any], values: Iterable[Any]) -> list[Any]:
    """Return a test's parameters, marked as slow but for those that are `quick`.

    A tuple is a row of several parameters.
    """
    kept = list(quick)
    return [
        value
        if value in kept
        else pytest.param(
            *(value if isinstance(value, tuple) else (value,)), marks=pytest.mark.slow
        )
        for value in values
    ]
