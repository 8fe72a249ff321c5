"""What tests of loops share."""

from __future__ import annotations

import numpy as np
import pytest


@pytest.fixture
def rng() -> np.random.Generator:
    """Random numbers of the test's own: what it draws depends on no other test."""
    return np.random.default_rng(4)
