"""What a live film's thread carries out: of values the newest, clicks in their order."""

from __future__ import annotations

import queue
from collections.abc import Iterator

import pytest

from eulerplateau.live import Worker
from eulerplateau.live.worker import Done
from eulerplateau.mesh.disk import Disk
from tests.live.films import StandIn


class Watched:
    """A worker of a film that waits, and what it has told."""

    def __init__(self, disk: Disk) -> None:
        self.film = StandIn(disk, waits=True)
        self.worker = Worker(self.film, self.film.save)
        self.told: queue.Queue[Done] = queue.Queue()
        self.worker.start(self.told.put)

    def let_go(self) -> Done:
        """Let the film be found that is sought; return what is told of it."""
        self.film.may.release()
        return self.told.get(timeout=600)


@pytest.fixture
def watched(oval: Disk) -> Iterator[Watched]:
    made = Watched(oval)
    yield made
    made.film.may.release()
    made.worker.stop(600)


def test_of_the_values_that_come_meanwhile_only_the_newest_is_solved(
    watched: Watched,
) -> None:
    for number, load in enumerate([10.0, 20.0, 30.0, 40.0], start=1):
        watched.worker.follow({"kL3_alpha": load}, 1, number)
        if number == 1:
            assert watched.film.begun.acquire(timeout=600)
    first, second = watched.let_go(), watched.let_go()
    assert watched.film.did == [{"kL3_alpha": 10.0}, {"kL3_alpha": 40.0}]
    assert [first.answered, second.answered] == [{1: 1}, {1: 4}]


def test_no_click_is_lost_that_came_before_another(watched: Watched) -> None:
    watched.worker.click("kick", 1, 1)
    assert watched.film.begun.acquire(timeout=600)
    for number, what in enumerate(["other", "begin", "save"], start=2):
        watched.worker.click(what, 1, number)
    done = [watched.let_go() for _ in range(4)]
    assert watched.film.did == ["kick", "other", "begin", "save"]
    assert [one.found is not None for one in done] == [True, False, True, False]
    assert "No other stable state" in done[1].said


def test_what_fails_is_said_and_ends_nothing(watched: Watched) -> None:
    watched.worker.click("save", 1, 1)
    assert watched.let_go().said == "disk: is full"
    watched.worker.follow({"kL3_alpha": 5.0}, 1, 2)
    found = watched.let_go().found
    assert found is not None
    assert found.row.kL3_alpha == 5.0


def test_an_error_of_the_program_is_kept_for_who_started_it(watched: Watched) -> None:
    watched.worker.follow({"no such": 1.0}, 1, 1)
    watched.film.may.release()
    watched.worker._thread.join(600)
    assert isinstance(watched.worker.failure, KeyError)
