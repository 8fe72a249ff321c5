"""Numbers of shapes can all be read: none on another, none on a mark, all in the panel."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.pictures.numbers import HIGH, MARK, WIDE, joined, spread

ROOM = np.array([240.0, 150.0])
DOWN = np.array([0.0, -1.0])


def boxes(middles: FloatArray, letters: list[int]) -> FloatArray:
    half = 0.5 * np.stack([WIDE * np.array(letters), np.full(len(letters), HIGH)], axis=1)
    return np.stack([middles - half, middles + half], axis=1)


def overlap(one: FloatArray, other: FloatArray) -> bool:
    return bool((np.minimum(one[1], other[1]) - np.maximum(one[0], other[0]) > 1e-9).all())


@pytest.mark.parametrize("seed", range(20))
def test_no_number_is_on_another_or_on_a_mark_or_outside(seed: int) -> None:
    rng = np.random.default_rng(seed)
    places = rng.uniform(0.1, 0.9, (12, 2)) * ROOM
    places[6:] = places[:6] + rng.normal(0.0, 3.0, (6, 2))
    letters = rng.integers(1, 8, 12).tolist()
    middles = spread(places, letters, np.tile(DOWN, (12, 1)), ROOM)
    labels = boxes(middles, letters)
    marks = np.stack([places - MARK, places + MARK], axis=1)
    for number, label in enumerate(labels):
        assert not any(overlap(label, other) for other in labels[:number])
        assert not any(overlap(label, mark) for mark in marks)
        assert (label[0] >= 0).all()
        assert (label[1] <= ROOM).all()


def test_a_number_alone_is_where_it_is_wished() -> None:
    place = 0.5 * ROOM
    for wish in np.array([[0.0, -1.0], [0.0, 1.0], [1.0, 0.0]]):
        (middle,) = spread(place[None], [2], wish[None], ROOM)
        assert float(np.linalg.det([middle - place, wish])) == pytest.approx(0.0, abs=1e-9)
        assert (middle - place) @ wish > 0


def test_places_closer_than_a_mark_are_named_together() -> None:
    places = np.array(
        [[10.0, 10.0], [100.0, 10.0], [10.5, 11.0], [100.0, 20.0], [10.0, 9.0]]
    )
    assert joined(places) == [[0, 2, 4], [1], [3]]
