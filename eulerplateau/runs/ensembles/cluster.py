"""Tasks carried out by the workers of a Dask cluster."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from threading import Lock
from typing import TypeVar

from eulerplateau.errors import MissingLibraryError, SpecError
from eulerplateau.interruption import heed
from eulerplateau.runs.ensembles.workers import Died

T = TypeVar("T")
R = TypeVar("R")

# Gmsh and the number of BLAS's threads belong to a process: one task at a time in each.
_ALONE = Lock()


def on_dask(
    function: Callable[[T], R], tasks: Sequence[T], address: str
) -> Iterator[tuple[T, R | Died]]:
    """Yield each task with its result, as they come, of the cluster at an address.

    The scheduler gives the task of a worker that dies to another one; how often is its
    own setting, `distributed.scheduler.allowed-failures`. Raises MissingLibraryError
    without Dask, SpecError where there is no cluster.
    """
    try:
        from distributed import Client, as_completed
    except ImportError:
        problem = "--dask needs Dask: pip install 'eulerplateau[dask]'"
        raise MissingLibraryError(problem) from None
    for name in ("distributed", "distributed.client"):
        # Of workers that die it says how it mends that.
        logging.getLogger(name).setLevel(logging.ERROR)
    try:
        client = Client(address)
    except (OSError, ValueError) as error:
        raise SpecError("--dask", f"no scheduler answers at {address}: {error}") from None
    with client:
        futures = client.map(partial(_alone, function), tasks, pure=False)
        ours = dict(zip(futures, tasks, strict=True))
        try:
            for future in as_completed(futures):
                heed()
                if future.status == "finished":
                    yield ours[future], future.result()
                else:
                    yield ours[future], Died(str(future.exception()))
        finally:
            client.cancel(futures)


def _alone(function: Callable[[T], R], task: T) -> R:
    """Return a function's result, found while no other is in this process."""
    with _ALONE:
        return function(task)
