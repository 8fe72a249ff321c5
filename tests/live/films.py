"""Live films that cost nothing: a shape that grows with the load, and tells what it did."""

from __future__ import annotations

import threading
from collections.abc import Mapping

import numpy as np

from eulerplateau.errors import SpecError
from eulerplateau.film import SPRING_LOAD
from eulerplateau.mesh import measure
from eulerplateau.mesh.disk import Disk
from eulerplateau.runs import Row, Varied, Visited
from eulerplateau.solvers import Status


class StandIn:
    """A film whose solver is asked for a film and waits until it is let go.

    Attributes
    ----------
    did : what it was asked for, in order
    """

    def __init__(self, disk: Disk, *, waits: bool = False) -> None:
        self.varied = (Varied("load", SPRING_LOAD, 1.0, 3000.0, 1.0),)
        self.did: list[object] = []
        self.begun, self.may = threading.Semaphore(0), threading.Semaphore(0)
        self._disk, self._waits, self._load = disk, waits, 1.0
        self._measures = measure(disk, disk.shape)
        self.at = self._visited("begin")

    def follow(self, values: Mapping[str, float]) -> Visited:
        self._do(dict(values))
        self._load = values["kL3_alpha"]
        return self._visited("follow")

    def kick(self) -> Visited:
        self._do("kick")
        return self._visited("kick")

    def begin(self) -> Visited:
        self._do("begin")
        return self._visited("begin")

    def other(self) -> Visited | None:
        self._do("other")
        return None

    def save(self) -> str:
        self._do("save")
        raise SpecError("disk", "is full")

    def _do(self, what: object) -> None:
        self.did.append(what)
        self.begun.release()
        if self._waits:
            assert self.may.acquire(timeout=600)

    def _visited(self, way: str) -> Visited:
        shape = self._disk.shape
        moved = shape.moved(shape.x * np.array([1.0, 1.0 - 1e-4 * self._load, 1.0]))
        numbers = dict.fromkeys(
            ("energy", "film_energy", "bending_energy", "residual", "length_error",
             "film_residual", "seconds", "lowest_eigenvalue"), self._load,
        )  # fmt: skip
        row = Row(
            step=len(self.did),
            kL3_alpha=self._load,
            sigma_hat=self._load,
            n_unstable=0,
            iterations=1,
            status=Status.CONVERGED,
            **numbers,
            **vars(self._measures),
        )
        return Visited({"kL3_alpha": self._load}, row, moved, None, None, way, False)
