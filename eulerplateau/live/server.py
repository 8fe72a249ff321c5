"""The server of a live film: what it answers, to whom, and for how long.

It listens on 127.0.0.1 alone. Its address holds a random token, without which it answers
nothing; so it is with a Host that is not its own, which a name that leads here by a trick
brings, and with the Origin of another page.
"""

from __future__ import annotations

import asyncio
import hmac
import secrets
import socket
import time
import webbrowser
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from importlib.resources import files
from threading import Thread
from typing import TYPE_CHECKING

from eulerplateau.errors import MissingLibraryError
from eulerplateau.interruption import heed
from eulerplateau.live.pages import Pages
from eulerplateau.live.worker import Worker
from eulerplateau.pictures.gallery import part

if TYPE_CHECKING:
    from aiohttp import web

HOST = "127.0.0.1"
# Seconds between two looks whether a signal has come, or the last page has closed.
_LOOK = 0.1
# Seconds that what is being solved is waited for in the end.
_PATIENCE = 2.0
# Bytes: a page asks for a few numbers.
_LONGEST_MESSAGE = 4096
_HEARTBEAT = 20.0

_JS, _CSS = "text/javascript", "text/css"
# The gallery's files, and those that lie here.
_OF_GALLERY = {
    "libraries.js": ("vendor/libraries.min.js", _JS),
    "gallery.css": ("style.css", _CSS),
    "quantities.js": ("quantities.js", _JS),
    "data.js": ("data.js", _JS),
    "film.js": ("film.js", _JS),
    "diagram.js": ("diagram.js", _JS),
}
_OWN = {
    "": ("page.html", "text/html"),
    "live.css": ("live.css", _CSS),
    "visited.js": ("visited.js", _JS),
    "live.js": ("live.js", _JS),
}

Handler = Callable[["web.Request"], Awaitable["web.StreamResponse"]]


def check_aiohttp() -> None:
    """Raise MissingLibraryError, which says what to install, where aiohttp is missing."""
    try:
        import aiohttp  # noqa: F401
    except ImportError:
        problem = "live needs aiohttp: pip install 'eulerplateau[live]'"
        raise MissingLibraryError(problem) from None


@dataclass(frozen=True)
class Service:
    """A film that is served.

    Attributes
    ----------
    idle : float, seconds after which it ends when the last page has closed
    open_browser : bool
    say : called with the address, when it can be opened
    """

    pages: Pages
    worker: Worker
    idle: float
    open_browser: bool
    say: Callable[[str], None]


def serve(service: Service) -> None:
    """Serve a film until a signal comes or the last page has closed for long enough.

    Raises Interrupted for a signal.
    """
    try:
        asyncio.run(_served(service))
    finally:
        service.worker.stop(_PATIENCE)


async def _served(service: Service) -> None:
    from aiohttp import web

    loop, worker, pages = asyncio.get_running_loop(), service.worker, service.pages
    listening = socket.create_server((HOST, 0))
    port, token = listening.getsockname()[1], secrets.token_urlsafe(24)
    runner = web.AppRunner(
        application(pages, worker, port, token), access_log=None, shutdown_timeout=1.0
    )
    await runner.setup()
    await web.SockSite(runner, listening).start()
    worker.start(lambda done: loop.call_soon_threadsafe(pages.tell, done))
    address = f"http://{HOST}:{port}/{token}/"
    service.say(address)
    if service.open_browser:
        # A browser that is started here comes back when it is closed, which may be after
        # its last page: no thread of asyncio, for those are waited for in the end.
        Thread(target=webbrowser.open, args=(address,), daemon=True).start()
    try:
        await _until_the_end(service)
    finally:
        await runner.cleanup()


async def _until_the_end(service: Service) -> None:
    while True:
        heed()
        if service.worker.failure is not None:
            raise service.worker.failure
        last = service.pages.seen_last
        if last is not None and time.monotonic() - last >= service.idle:
            return
        await asyncio.sleep(_LOOK)


def application(pages: Pages, worker: Worker, port: int, token: str) -> web.Application:
    """Return what answers requests, to those alone that come from the film's own page."""
    from aiohttp import web

    own = f"{HOST}:{port}"
    sockets: set[web.WebSocketResponse] = set()

    @web.middleware
    async def guard(request: web.Request, handler: Handler) -> web.StreamResponse:
        given = request.path.split("/")[1]
        known = hmac.compare_digest(given.encode(), token.encode())
        origin = request.headers.get("Origin", f"http://{own}")
        if not known or request.host != own or origin != f"http://{own}":
            raise web.HTTPForbidden
        return await handler(request)

    async def talk(request: web.Request) -> web.StreamResponse:
        if "Origin" not in request.headers:  # every browser says it
            raise web.HTTPForbidden
        talking = web.WebSocketResponse(
            heartbeat=_HEARTBEAT, max_msg_size=_LONGEST_MESSAGE, compress=False
        )
        await talking.prepare(request)
        sockets.add(talking)
        try:
            await pages.serve(talking, worker)
        finally:
            sockets.discard(talking)
        return talking

    async def hang_up(_: web.Application) -> None:
        for talking in set(sockets):
            await talking.close(code=1001, message=b"the film is no longer served")

    app = web.Application(middlewares=[guard])
    app.router.add_get(f"/{token}/talk", talk)
    for name, (content, kind) in _contents().items():
        app.router.add_get(f"/{token}/{name}", _file(content, kind, own))
    app.on_shutdown.append(hang_up)
    return app


def _contents() -> dict[str, tuple[str, str]]:
    """Return all that there is to be had, {name: (content, type)}."""
    here = files("eulerplateau.live")
    gallery = {name: (part(file), kind) for name, (file, kind) in _OF_GALLERY.items()}
    own = {
        name: (here.joinpath(file).read_text(encoding="utf-8"), kind)
        for name, (file, kind) in _OWN.items()
    }
    return gallery | own


def _file(content: str, kind: str, own: str) -> Handler:
    """Return what answers with one file, which may load nothing from elsewhere."""
    from aiohttp import web

    policy = (
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src data:; "
        f"connect-src ws://{own}; base-uri 'none'; form-action 'none'; "
        "frame-ancestors 'none'"
    )
    headers = {
        "Content-Security-Policy": policy,
        "Referrer-Policy": "no-referrer",
        "X-Content-Type-Options": "nosniff",
        "Cache-Control": "no-store",
        "Cross-Origin-Resource-Policy": "same-origin",
    }

    async def answer(_: web.Request) -> web.StreamResponse:
        return web.Response(
            text=content, content_type=kind, charset="utf-8", headers=headers
        )

    return answer
