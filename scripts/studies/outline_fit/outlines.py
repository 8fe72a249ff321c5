"""Synthetic outlines: points of exact films, displaced by noise of several kinds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.exact import planar_film

Random = np.random.Generator

FILMS = ((2, 1520.0), (2, 1700.0), (2, 2300.0), (2, 4000.0), (2, 7000.0), (3, 5000.0))
LENGTH = 180.0


@dataclass(frozen=True)
class Outline:
    """Points (n, 2) of a film, and the truth about it."""

    points: FloatArray
    lobes: int
    sigma_hat: float
    kind: str


def white(t: FloatArray, random: Random) -> FloatArray:
    """Return noise (n, 2) of variance 1 that differs from point to point."""
    return random.normal(size=(len(t), 2))


def exponential(t: FloatArray, random: Random) -> FloatArray:
    """Return noise that is forgotten exponentially along the loop, and some white noise."""
    apart = np.abs(t[:, None] - t)
    length = random.uniform(0.01, 0.04)
    cover = 0.8 * np.exp(-np.minimum(apart, 1 - apart) / length) + 0.2 * np.eye(len(t))
    return np.asarray(np.linalg.cholesky(cover) @ random.normal(size=(len(t), 2)))


def smooth(t: FloatArray, random: Random) -> FloatArray:
    """Return noise that varies smoothly: of another kind than the fit takes it to be."""
    apart = np.abs(t[:, None] - t)
    length = random.uniform(0.01, 0.03)
    cover = np.exp(-(np.minimum(apart, 1 - apart) ** 2) / 2 / length**2)
    values, vectors = np.linalg.eigh(cover)
    root = vectors * np.sqrt(np.maximum(values, 0.0))
    return np.asarray(root @ random.normal(size=(len(t), 2)))


KINDS: dict[str, Callable[[FloatArray, Random], FloatArray]] = {
    "white": white,
    "exponential": exponential,
    "smooth": smooth,
}


def outline(number: int, random: Random) -> Outline:
    """Return one outline; kinds of noise and films take turns."""
    kind = list(KINDS)[number % len(KINDS)]
    lobes, load = FILMS[number // len(KINDS) % len(FILMS)]
    count = int(random.integers(100, 301))
    even = (np.arange(count) + random.uniform()) / count
    t = np.sort(random.uniform(size=count)) if random.uniform() < 0.5 else even
    angle = random.uniform(0, 2 * np.pi)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    deviation = LENGTH * np.exp(random.uniform(np.log(3e-4), np.log(3e-3)))
    points = LENGTH * planar_film(lobes, load).positions(t) @ turn.T
    points += deviation * KINDS[kind](t, random) + random.normal(size=2) * LENGTH
    return Outline(points, lobes, load, kind)
