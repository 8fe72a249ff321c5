"""Pictures of tests are coarse, and a text is parsed once for all of them."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

import pytest
from matplotlib import rc_context
from matplotlib.mathtext import MathTextParser

from eulerplateau.pictures import figure

# Of PDF and SVG; a text is parsed anew for each resolution.
_DPI = 72


@pytest.fixture(scope="package", autouse=True)
def _coarse() -> Iterator[None]:
    """What is seen of a picture depends neither on its pixels nor on matplotlib's cache.

    That holds 50 texts, which are those of two or three figures.
    """
    parsed = lru_cache(None)(MathTextParser._parse_cached.__wrapped__)
    with pytest.MonkeyPatch.context() as patch, rc_context({"figure.dpi": _DPI}):
        patch.setattr(figure, "_DPI", _DPI)
        patch.setattr(MathTextParser, "_parse_cached", parsed)
        yield
