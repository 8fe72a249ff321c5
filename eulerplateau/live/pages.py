"""The pages that are open, which share one film: what each is told, and when."""

from __future__ import annotations

import asyncio
import json
import time
from collections import deque
from collections.abc import Sequence
from contextlib import suppress
from itertools import count
from typing import TYPE_CHECKING, Any

import numpy as np

from eulerplateau.live.answers import Stage, opening, point_told
from eulerplateau.live.worker import Done, Worker
from eulerplateau.pictures.gallery import base64_of
from eulerplateau.runs import Varied, Visited

if TYPE_CHECKING:
    from aiohttp import web

# Points that are remembered: the diagram forgets the oldest.
_REMEMBERED = 3000
_CLICKS = "kick", "other", "begin", "save"
# Lines for people that may wait for a page.
_SAID = 8


class Pages:
    """All open pages, the points visited, and the shape that is shown now.

    `seen_last` is when the last page closed, None while one is open or none was yet.
    """

    def __init__(self, name: str, varied: Sequence[Varied], first: Visited) -> None:
        self._name, self._varied = name, varied
        self._keys = {each.key for each in varied}
        self._stage, self._pages = Stage(), dict[int, _Page]()
        self._page_numbers, self._numbers = count(1), count(1)
        self._points: deque[dict[str, Any]] = deque(maxlen=_REMEMBERED)
        self._triangles, self._tiling = first.shape.triangles, 0
        self._loop_shape = first.shape
        self.seen_last: float | None = None
        self._take(first)

    def tell(self, done: Done) -> None:
        """Let all pages know what the film has come to."""
        if done.found is not None:
            self._take(done.found)
        for page in self._pages.values():
            page.answered = done.answered.get(page.number, page.answered)
            if done.said:
                page.said.append(done.said)
            page.news.set()

    async def serve(self, socket: web.WebSocketResponse, worker: Worker) -> None:
        """Stay with one page until it closes."""
        number = next(self._page_numbers)
        page = self._pages[number] = _Page(number)
        self.seen_last = None
        first = opening(self._name, self._varied, self._loop_shape)
        teller = asyncio.create_task(self._keep_telling(page, socket, first))
        try:
            async for message in socket:
                asked = _asked(message.data, self._keys)
                if asked is None:
                    break  # no page of ours says this
                self._heed(page, asked, worker)
        finally:
            teller.cancel()
            with suppress(asyncio.CancelledError, ConnectionError):
                await teller
            del self._pages[number]
            if not self._pages:
                self.seen_last = time.monotonic()

    def _heed(self, page: _Page, asked: dict[str, Any], worker: Worker) -> None:
        if "follow" in asked:
            worker.follow(asked["follow"], page.number, asked["asked"])
        elif "click" in asked:
            worker.click(asked["click"], page.number, asked["asked"])
        else:
            page.drawn = True
            page.news.set()

    def _take(self, found: Visited) -> None:
        if not np.array_equal(found.shape.triangles, self._triangles):
            self._triangles, self._tiling = found.shape.triangles, self._tiling + 1
        point = point_told(next(self._numbers), found)
        self._points.append(point)
        self._shape = self._stage.shape(found)

    async def _keep_telling(
        self, page: _Page, socket: web.WebSocketResponse, first: dict[str, Any]
    ) -> None:
        """Tell a page what is new, as soon as it has drawn what it was told before."""
        with suppress(ConnectionError):
            await socket.send_str(json.dumps(first, allow_nan=False))
            while True:
                await page.news.wait()
                page.news.clear()
                if page.drawn and (told := self._news(page)):
                    page.drawn = False
                    await socket.send_str(json.dumps(told, allow_nan=False))

    def _news(self, page: _Page) -> dict[str, Any]:
        told: dict[str, Any] = {}
        if page.said:
            told["said"] = [page.said.popleft() for _ in range(len(page.said))]
        new = self._points[-1]["number"] - page.told
        if new > 0:
            points = list(self._points)[-min(new, len(self._points)) :]
            told |= {"points": points, "shape": self._shape}
            page.told = self._points[-1]["number"]
            if page.tiling != self._tiling:
                page.tiling = self._tiling
                told["triangles"] = base64_of(self._triangles.astype("<u4"))
        return told | {"answered": page.answered} if told else told


class _Page:
    """One open page.

    Attributes
    ----------
    drawn : bool, whether it has drawn all it was told
    told : int, the number of the last point it was told
    tiling : int, the number of the triangles it has
    answered : int, the number of the last wish of its own that was carried out
    said : lines for people that it was not told yet
    """

    def __init__(self, number: int) -> None:
        self.number = number
        self.news = asyncio.Event()
        self.news.set()
        self.drawn = True
        self.told = 0
        self.tiling = -1
        self.answered = 0
        self.said: deque[str] = deque(maxlen=_SAID)


def _asked(text: Any, keys: set[str]) -> dict[str, Any] | None:
    """Return what a page says, checked; None if no page of ours would say it."""
    try:
        said = json.loads(text)
        asked = {"asked": int(said.get("asked", 0))}
        if "follow" in said:
            values = {str(key): float(value) for key, value in said["follow"].items()}
            if not values or not values.keys() <= keys:
                return None
            return (
                asked | {"follow": values}
                if np.isfinite([*values.values()]).all()
                else None
            )
        if "click" in said:
            return asked | {"click": said["click"]} if said["click"] in _CLICKS else None
        return asked if said.get("drawn") is True else None
    except (ValueError, TypeError, AttributeError, RecursionError, OverflowError):
        return None
