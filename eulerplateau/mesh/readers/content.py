"""What a mesh file holds: points and polygons; and what is said of files that hold less."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import EulerPlateauError, MeshError, OutputError

_LONGEST_REASON = 200


@dataclass(frozen=True)
class Content:
    """Points and polygons, as a file has them.

    Attributes
    ----------
    points : (n, 3) float
    corners : (m,) int, the vertices of all polygons, one polygon after the other
    sizes : (n_f,) int, how many corners each polygon has
    curved : how many polygons are of higher order and are taken by their corners
    beside : (k,) int, points of what was left out: of lines, of curved sides
    """

    points: FloatArray
    corners: IntArray
    sizes: IntArray
    curved: int = 0
    beside: IntArray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))


class NotWholeError(ValueError):
    """A file ends before it has what it promises; the text says what is missing."""


class ForeignError(ValueError):
    """A file is something else than a surface; the text goes on after the file's name."""


@contextmanager
def one_line(path: Path) -> Iterator[None]:
    """Turn whatever comes up while `path` is read into one line that says what it is.

    Raises OutputError if it cannot be opened, MeshError if it holds no surface.
    """
    try:
        yield
    except EulerPlateauError:
        raise
    except OSError as error:
        raise OutputError(path, f"cannot be read: {error.strerror}") from None
    except NotWholeError as error:
        problem = f"is not a whole {path.suffix} file: {_reason(error)}"
        raise _mesh_error(path, problem) from None
    except ForeignError as error:
        raise _mesh_error(path, _reason(error)) from None
    # A damaged file: numbers that are none, counts below zero, unknown types.
    except Exception as error:
        problem = f"cannot be read as a {path.suffix} file: {_reason(error)}"
        raise _mesh_error(path, problem) from error


def _reason(error: Exception) -> str:
    """Return the first line of what an error says, as far as a line goes."""
    return (str(error).splitlines() or [type(error).__name__])[0][:_LONGEST_REASON]


def _mesh_error(path: Path, problem: str) -> MeshError:
    return MeshError("mesh", None, f"{path} {problem}")


def promise(kept: bool, what: str) -> None:
    """Raise NotWholeError unless a promise is `kept`: "it promises " and `what`."""
    if not kept:
        raise NotWholeError(f"it promises {what}")


class Words:
    """The words of a text, taken from its beginning."""

    def __init__(self, words: Sequence[bytes]) -> None:
        self._words = words
        self._taken = 0

    @property
    def left(self) -> int:
        """How many words are left."""
        return len(self._words) - self._taken

    def take(self, count: int, what: str) -> Sequence[bytes]:
        """Return the next `count` words, numbers of `what`; raises NotWholeError."""
        if count < 0:
            raise ValueError(f"it counts {count} {what}")
        promise(count <= self.left, f"more {what} than it holds")
        start, self._taken = self._taken, self._taken + count
        return self._words[start : self._taken]

    def whole(self, what: str) -> int:
        """Return the next word, a whole number."""
        return int(self.take(1, what)[0])


def rows(flat: Iterable[float] | FloatArray) -> FloatArray:
    """Return coordinates, one after the other, as points (n, 3)."""
    values = flat if isinstance(flat, np.ndarray) else list(flat)
    return np.asarray(values, dtype=np.float64).reshape(-1, 3)


def polygons(faces: Sequence[Sequence[int]]) -> tuple[IntArray, IntArray]:
    """Return the corners and sizes of `faces`, each a list of vertices."""
    sizes = np.array([len(face) for face in faces], dtype=np.int64)
    flat = [corner for face in faces for corner in face]
    return np.array(flat, dtype=np.int64), sizes


def strips(faces: Sequence[Sequence[int]]) -> list[list[int]]:
    """Return the triangles of strips, in which each vertex makes one with the two before.

    One that names a vertex twice only leads to the next.
    """
    every = (
        [strip[i + i % 2], strip[i + 1 - i % 2], strip[i + 2]]
        for strip in faces
        for i in range(len(strip) - 2)
    )
    return [triangle for triangle in every if len({*triangle}) == 3]
