"""Who is answered by the server of a live film, what, and for how long."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Any

import aiohttp
import pytest
from aiohttp import web

from eulerplateau.live import Pages, Service, Worker, serve
from eulerplateau.live.server import HOST, application
from eulerplateau.live.worker import Done
from eulerplateau.mesh.disk import Disk
from tests.live.films import StandIn

TOKEN = "the-right-one"


@dataclass
class Served:
    """A film that is served, and who asks for it."""

    film: StandIn
    pages: Pages
    port: int
    session: aiohttp.ClientSession

    @property
    def origin(self) -> str:
        return f"http://{HOST}:{self.port}"

    def address(self, path: str = "", token: str = TOKEN) -> str:
        return f"{self.origin}/{token}/{path}"

    async def status(self, address: str, **headers: str) -> int:
        """Return the answer's status to a request, or to a WebSocket's."""
        async with self.session.get(address, headers=headers) as answer:
            return answer.status

    async def talk_status(self, address: str, **headers: str) -> int:
        try:
            async with self.session.ws_connect(address, headers=headers):
                return 101
        except aiohttp.WSServerHandshakeError as refused:
            return refused.status

    @asynccontextmanager
    async def page(self) -> AsyncIterator[Page]:
        headers = {"Origin": self.origin}
        async with self.session.ws_connect(self.address("talk"), headers=headers) as socket:
            yield Page(socket)


@dataclass
class Page:
    """What a page says and is told."""

    socket: aiohttp.ClientWebSocketResponse

    async def told(self) -> dict[str, Any]:
        found: dict[str, Any] = await self.socket.receive_json(timeout=600)
        return found

    async def news(self) -> dict[str, Any]:
        """Return what is told next, and say that it is drawn."""
        found = await self.told()
        await self.say(drawn=True)
        return found

    async def say(self, **what: Any) -> None:
        await self.socket.send_json(what)

    async def closed(self) -> bool:
        """Whether the server hangs up, whatever it tells before."""
        async for _ in self.socket:
            pass
        return self.socket.closed


def with_served(disk: Disk, act: Callable[[Served], Awaitable[None]]) -> None:
    """Serve a film and act on it."""

    async def served() -> None:
        film = StandIn(disk)
        pages, worker = Pages("oval", film.varied, film.at), Worker(film, film.save)
        loop = asyncio.get_running_loop()
        worker.start(lambda done: loop.call_soon_threadsafe(pages.tell, done))
        # The port is known only when it is listened at: the application is told it then.
        listening = await asyncio.start_server(lambda *_: None, HOST, 0)
        port = listening.sockets[0].getsockname()[1]
        listening.close()
        await listening.wait_closed()
        runner = web.AppRunner(application(pages, worker, port, TOKEN))
        await runner.setup()
        await web.TCPSite(runner, HOST, port).start()
        try:
            async with aiohttp.ClientSession() as session:
                await act(Served(film, pages, port, session))
        finally:
            await runner.cleanup()
            worker.stop(600)

    asyncio.run(served())


def test_only_who_has_the_token_is_answered(oval: Disk) -> None:
    async def act(served: Served) -> None:
        for path in ("", "live.js", "film.js", "talk"):
            for token in ("wrong", TOKEN[:-1], f"{TOKEN}x", "", f"../{TOKEN}x"):
                assert await served.status(served.address(path, token)) == 403
        assert await served.status(served.origin) == 403
        assert await served.talk_status(served.address("talk", "wrong")) == 403
        assert await served.status(served.address()) == 200
        assert await served.status(served.address("no such")) == 404

    with_served(oval, act)


def test_another_host_is_refused(oval: Disk) -> None:
    async def act(served: Served) -> None:
        own = f"{HOST}:{served.port}"
        for host in ("evil.example", f"evil.example:{served.port}", HOST, f"{own}0"):
            assert await served.status(served.address(), Host=host) == 403
            talk = served.address("talk")
            assert await served.talk_status(talk, Host=host, Origin=served.origin) == 403
        assert await served.status(served.address(), Host=own) == 200

    with_served(oval, act)


def test_another_origin_or_none_is_refused(oval: Disk) -> None:
    async def act(served: Served) -> None:
        talk = served.address("talk")
        origins = ("http://evil.example", "null", f"https://{HOST}:{served.port}")
        for origin in (*origins, f"http://{HOST}", f"{served.origin}0"):
            assert await served.talk_status(talk, Origin=origin) == 403
            assert await served.status(served.address("live.js"), Origin=origin) == 403
        assert await served.talk_status(talk) == 403
        assert await served.talk_status(talk, Origin=served.origin) == 101

    with_served(oval, act)


def test_nothing_but_the_pages_own_files_is_given(oval: Disk) -> None:
    async def act(served: Served) -> None:
        for path in ("server.py", "../server.py", "%2e%2e/server.py", "/etc/passwd"):
            assert await served.status(served.address(path)) in (403, 404)
        async with served.session.get(served.address()) as answer:
            assert "default-src 'none'" in answer.headers["Content-Security-Policy"]
            assert answer.headers["Referrer-Policy"] == "no-referrer"

    with_served(oval, act)


@pytest.mark.parametrize(
    "said",
    [
        "no JSON",
        "[]",
        "{}",
        '{"follow": {"kL3_alpha": "much"}}',
        '{"follow": {"kL3_alpha": NaN}}',
        '{"follow": {"another": 1.0}}',
        '{"follow": {}}',
        '{"click": "remove"}',
        '{"drawn": "yes"}',
        '{"click": "kick", "asked": "x"}',
        "[" * 4000,
        f'{{"click": "{"x" * 5000}"}}',
    ],
)
def test_who_says_what_no_page_would_is_hung_up_on(oval: Disk, said: str) -> None:
    async def act(served: Served) -> None:
        async with served.page() as page:
            await page.socket.send_str(said)
            assert await asyncio.wait_for(page.closed(), 600)
        assert served.film.did == []

    with_served(oval, act)


def test_two_pages_share_one_film(oval: Disk) -> None:
    async def act(served: Served) -> None:
        async with served.page() as one, served.page() as two:
            for page in (one, two):
                assert (await page.told())["varied"]
            for page in (one, two):
                assert len((await page.news())["points"]) == 1
            await one.say(follow={"kL3_alpha": 700.0}, asked=7)
            news = [await one.news(), await two.news()]
            for told in news:
                assert told["points"][-1]["values"] == {"kL3_alpha": 700.0}
            assert [told["answered"] for told in news] == [7, 0]
            assert news[0]["shape"] == news[1]["shape"]
            assert "triangles" not in news[0]  # they are those it has

    with_served(oval, act)


def test_a_page_that_comes_later_sees_what_was_visited(oval: Disk) -> None:
    async def act(served: Served) -> None:
        async with served.page() as one:
            await one.told()
            await one.news()
            for load in (10.0, 20.0):
                await one.say(follow={"kL3_alpha": load})
                await one.news()
        async with served.page() as two:
            await two.told()
            points = (await two.news())["points"]
            assert [point["values"]["kL3_alpha"] for point in points] == [1.0, 10.0, 20.0]

    with_served(oval, act)


def test_a_page_that_draws_slowly_is_told_all_points_and_one_shape(oval: Disk) -> None:
    async def act(served: Served) -> None:
        async with served.page() as slow, served.page() as quick:
            await slow.told()
            await slow.told()  # not drawn yet
            await quick.told()
            await quick.news()
            for load in (10.0, 20.0, 30.0):
                await quick.say(follow={"kL3_alpha": load})
                shown = await quick.news()
            await slow.say(drawn=True)
            told = await slow.told()
            loads = [point["values"]["kL3_alpha"] for point in told["points"]]
            assert loads == [10.0, 20.0, 30.0]
            assert told["shape"] == shown["shape"]

    with_served(oval, act)


def test_points_are_forgotten_in_the_end(
    oval: Disk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("eulerplateau.live.pages._REMEMBERED", 20)

    async def act(served: Served) -> None:
        for _ in range(50):
            served.pages.tell(Done(served.film.at, (0, 0)))
        async with served.page() as page:
            await page.told()
            numbers = [point["number"] for point in (await page.news())["points"]]
            assert numbers == list(range(32, 52))

    with_served(oval, act)


def test_it_ends_when_the_last_page_has_been_closed_for_long_enough(
    oval: Disk, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Even if the browser that it opened stays open.
    browser_closes, come_back = threading.Event(), list[str]()

    def browser(address: str) -> None:
        browser_closes.wait(60)
        come_back.append(address)

    monkeypatch.setattr("webbrowser.open", browser)
    film, addresses = StandIn(oval), list[str]()
    pages = Pages("oval", film.varied, film.at)
    told = threading.Event()

    def say(address: str) -> None:
        addresses.append(address)
        told.set()

    service = Service(pages, Worker(film, film.save), 0.3, True, say)
    ended = list[BaseException | None]()

    def run() -> None:
        try:
            serve(service)
            ended.append(None)
        except BaseException as error:
            ended.append(error)

    server = threading.Thread(target=run)
    server.start()
    assert told.wait(600)

    async def visit() -> None:
        origin = addresses[0].rsplit("/", 2)[0]
        async with aiohttp.ClientSession() as session:
            for _ in range(2):  # the second comes before it ends
                talk = session.ws_connect(addresses[0] + "talk", headers={"Origin": origin})
                async with talk as socket:
                    await socket.receive_json()
                    await asyncio.sleep(0.5)
                    assert server.is_alive()

    asyncio.run(visit())
    closed = time.monotonic()
    server.join(600)
    assert ended == [None]
    assert time.monotonic() - closed > 0.1
    assert not come_back
    browser_closes.set()
