"""All figures here are coarse."""

from __future__ import annotations

import pytest


@pytest.fixture(scope="package", autouse=True)
def _coarse(coarse_pictures: None) -> None:
    """What is asked of them is not how fine they are."""
