"""One thread for matrices as large as a loop: a second one waits more than it works."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from functools import cache
from typing import Any, TypeVar

from threadpoolctl import ThreadpoolController

from eulerplateau import lapack  # noqa: F401 - brings a BLAS of its own, to be found too

T = TypeVar("T")


@cache
def _controller() -> ThreadpoolController:
    return ThreadpoolController()


def threads(count: int) -> AbstractContextManager[object]:
    """Return a context in which BLAS has `count` threads; it costs some microseconds."""
    pools = _controller()
    context: AbstractContextManager[object] = pools.limit(limits=count, user_api="blas")
    return context


def one_thread() -> AbstractContextManager[object]:
    """Return a context in which BLAS has one thread."""
    return threads(1)


def pools() -> list[dict[str, Any]]:
    """Return what is known of each BLAS that is loaded, its threads as they are now."""
    found: list[dict[str, Any]] = _controller().select(user_api="blas").info()
    return found


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
