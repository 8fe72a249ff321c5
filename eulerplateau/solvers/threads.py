"""One thread for matrices as large as a loop: a second one waits more than it works."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from functools import cache
from typing import TypeVar

import scipy.linalg  # noqa: F401 - brings a BLAS of its own, which is to be found too
from threadpoolctl import ThreadpoolController

T = TypeVar("T")


@cache
def _controller() -> ThreadpoolController:
    return ThreadpoolController()


def one_thread() -> AbstractContextManager[object]:
    """Return a context in which BLAS has one thread; it costs some microseconds."""
    context: AbstractContextManager[object] = _controller().limit(limits=1, user_api="blas")
    return context


def stepwise(make: Callable[[], Iterator[T]]) -> Iterator[T]:
    """Yield what an iterator yields, each item computed with one thread."""
    with one_thread():
        items = make()
    while True:
        with one_thread():
            try:
                item = next(items)
            except StopIteration:
                return
        yield item
