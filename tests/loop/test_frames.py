"""The material frame of a rod: across it, evenly twisted, and closed up to its link."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import directors
from eulerplateau.loop.loop import differences
from eulerplateau.loop.writhe_kernels import transported, writhe
from tests.loop.test_writhe import tangle


def _angle(first: FloatArray, then: FloatArray, axis: FloatArray) -> float:
    return float(np.arctan2(np.cross(first, then) @ axis, first @ then))


@pytest.mark.parametrize("link", [0.0, 0.25, 1.0, -1.7])
def test_round_the_loop_a_rod_turns_by_its_link(
    link: float, rng: np.random.Generator
) -> None:
    """White: twist and writhe make link, whatever the loop."""
    for _ in range(3):
        x = tangle(60, rng=rng)
        edges = differences(x)
        lengths = np.linalg.norm(edges, axis=1)
        tangents = edges / lengths[:, None]
        found = directors(x, link - writhe(x))
        np.testing.assert_allclose((found * tangents).sum(axis=1), 0, atol=1e-12)
        np.testing.assert_allclose(np.linalg.norm(found, axis=1), 1, rtol=1e-12)
        # Back to the first edge: carried on, and turned by the twist that is left.
        ends = np.stack([tangents[-1], tangents[0]])
        carried = transported(ends, found[-1])[1]
        twist = 2 * np.pi * (link - writhe(x))
        last = twist * 0.5 * (lengths[-1] + lengths[0]) / lengths.sum()
        missing = _angle(found[0], carried, tangents[0]) + last
        whole = (missing - 2 * np.pi * link) / (2 * np.pi)
        assert whole == pytest.approx(round(whole), abs=1e-9)


def test_twist_is_even_along_the_rod(rng: np.random.Generator) -> None:
    x, link = tangle(60, rng=rng), 1.3
    edges = differences(x)
    lengths = np.linalg.norm(edges, axis=1)
    tangents, found = edges / lengths[:, None], directors(x, link - writhe(x))
    rate = 2 * np.pi * (link - writhe(x)) / lengths.sum()
    for v in range(59):
        carried = transported(tangents[v : v + 2], found[v])[1]
        turned = _angle(carried, found[v + 1], tangents[v + 1])
        assert turned == pytest.approx(0.5 * rate * (lengths[v] + lengths[v + 1]))
