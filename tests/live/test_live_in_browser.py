"""A live film in a real browser: dragged, kicked, saved, from two pages, to its end.

Screenshots are left in tests/artefacts, to be looked at.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from eulerplateau.mesh import write_mesh
from eulerplateau.mesh.disk import Disk
from tests.helpers.browser import Browser, chromium
from tests.helpers.command import command_line
from tests.helpers.processes import PATIENCE, Process, started

pytestmark = pytest.mark.slow

# Seconds in which no film comes once the last has.
QUIET = 1.0
ARTEFACTS = Path(__file__).parents[1] / "artefacts"
RUN = """
[mesh]
file = "oval.vtp"
[film]
load = 1.0
[loop]
twist_ratio = 1.0
diameter = 0.03
[sweep]
parameter = "link"
values = [0, 3]
"""


ROD = """
[mesh]
file = "oval.vtp"
[film]
model = "area"
surface_tension = "25 mN/m"
[rod]
young_modulus = "2 GPa"
diameter = "0.2 mm"
[sweep]
parameter = "length"
values = ["10 cm", "13 cm"]
"""


class Live:
    """A film that is served, and where."""

    def __init__(self, process: Process, folder: Path) -> None:
        assert process.stdout is not None
        self.process, self.folder = process, folder
        self.address = process.stdout.readline().strip()


@contextmanager
def served(run: str, folder: Path, disk: Disk) -> Iterator[Live]:
    write_mesh(disk, folder / "oval.vtp")
    (folder / "ring.toml").write_text(run)
    words = "live", folder / "ring.toml", "--no-browser", "--idle", 2
    with started(command_line(*words)) as process:
        yield Live(process, folder / "ring")


@pytest.fixture
def live(tmp_path: Path, oval: Disk) -> Iterator[Live]:
    with served(RUN, tmp_path, oval) as film:
        yield film


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with chromium(tmp_path_factory.mktemp("profile")) as started:
        yield started


@pytest.fixture
def page(browser: Browser, live: Live) -> Iterator[Browser]:
    """The page, opened; afterwards it has not complained, nor fetched from elsewhere."""
    browser.visit(live.address)
    browser.wait_for(lambda: data(browser, "drawn") == "1")
    yield browser
    assert browser.complaints() == []
    elsewhere = {url for url in browser.requested() if not url.startswith(live.address)}
    assert {url for url in elsewhere if not url.startswith("data:")} == set()


def data(page: Browser, name: str) -> Any:
    return page.evaluate("document.body.dataset[arguments[0]]", name)


def numbers(page: Browser) -> dict[str, str]:
    """Return the numbers beside the film, by what they are called."""
    found: dict[str, str] = page.evaluate(
        """Object.fromEntries([...document.querySelectorAll("#row div")].map(
            (pair) => [pair.children[0].textContent, pair.children[1].textContent]))"""
    )
    return found


def drag(page: Browser, to: float) -> None:
    """Drag the slider of the link from where it is to a part of its width."""
    x, y, width, part = page.evaluate(
        """((range) => {
            const { x, y, width, height } = range.getBoundingClientRect();
            const part = (range.value - range.min) / (range.max - range.min);
            return [x, y + height / 2, width, part];
        })(document.getElementById("range-link"))"""
    )
    inside = width - 16  # the knob's own width
    start = x + 8 + part * inside
    page.drag(start, y, x + 8 + to * inside - start, 0.0)


def settle(page: Browser) -> None:
    """Wait until the film is that of where the slider stands, and no other comes."""

    def is_still() -> bool:
        before = data(page, "number")
        time.sleep(QUIET)
        there = page.evaluate(
            """(({ points }) => Math.abs(points.at(-1).values.link
                - document.getElementById("range-link").value) < 1e-9)(diagram)"""
        )
        last = page.evaluate("diagram.points.at(-1).number")
        drawn = int(data(page, "drawn")) >= last and page.evaluate("settling === null")
        return bool(there) and drawn and data(page, "number") == before

    page.wait_for(is_still)


def click(page: Browser, name: str) -> None:
    page.evaluate("document.getElementById(arguments[0]).click()", name)


def test_dragging_changes_the_film_and_its_numbers(page: Browser, live: Live) -> None:
    before, shown = page.picture("film"), numbers(page)
    # In strokes after each of which the film is there: how far apart films are on the way
    # is the machine's, and of a jump within a long step the rates cannot tell.
    for to in (0.5 / 3, 1.0 / 3, 1.4 / 3, 1.65 / 3, 1.9 / 3):
        drag(page, to)
        settle(page)
    after, changed = page.picture("film"), numbers(page)
    page.screenshot(ARTEFACTS / "live.png")
    assert float((np.abs(before - after).max(axis=2) > 0.1).mean()) > 0.02
    assert changed["link"] != shown["link"]
    assert changed["energy E"] != shown["energy E"]
    assert page.evaluate("diagram.points.length") > 2
    # A ring jumps to an eight on the way (Michell 1889), and is drawn as having done so.
    assert page.evaluate("diagram.points.filter(({ jumped }) => jumped).length") == 1
    assert page.evaluate("diagram.jumps.data.length") == 3


def test_a_slider_that_is_let_go_stays_where_it_was_put(page: Browser) -> None:
    page.evaluate(
        """((range) => {
            window.stood = [];
            range.addEventListener("pointerup", () => {
                setInterval(() => window.stood.push(range.value), 1);
            });
        })(document.getElementById("range-link"))"""
    )
    drag(page, 0.6)
    settle(page)
    stood = [float(value) for value in page.evaluate("window.stood")]
    assert np.ptp(stood) < 1e-6  # what a film's value is rounded to


def test_where_no_graphics_card_draws_the_last_film_is_drawn_finely(page: Browser) -> None:
    width = page.evaluate("find('film').width")
    page.evaluate(
        """((film) => {
            window.widths = [];
            const draw = film.draw.bind(film);
            film.draw = () => { draw(); window.widths.push(film.canvas.width); };
        })(film)"""
    )
    drag(page, 0.3)
    settle(page)
    widths = page.evaluate("window.widths")
    assert min(widths) <= 0.5 * width
    assert widths[-1] == page.evaluate("find('film').width") == width


def test_back_and_forth_shows_hysteresis_and_the_other_state(page: Browser) -> None:
    for to in (1.65 / 3, 1.85 / 3, 1.65 / 3):
        drag(page, to)
        settle(page)
    eight = numbers(page)["energy E"]
    for way in ("other", "kick", "begin"):
        click(page, way)
        page.wait_for(lambda way=way: page.evaluate("diagram.points.at(-1).way") == way)  # type: ignore[misc]
        if way == "other":
            assert numbers(page)["energy E"] != eight
            page.wait_for(lambda: page.evaluate("find('said').textContent") == "")


def test_a_click_saves_the_shape_into_the_run_folder(page: Browser, live: Live) -> None:
    for count in (1, 2):
        click(page, "save")
        path = live.folder / "live" / f"live-000{count}.vtp"
        page.wait_for(lambda path=path: path.is_file() and path.stat().st_size > 0)  # type: ignore[misc]
        page.wait_for(
            lambda path=path: str(path) in page.evaluate("find('said').textContent")  # type: ignore[misc]
        )


def test_a_value_is_typed_too_and_one_out_of_range_is_its_end(page: Browser) -> None:
    for count, (typed, there) in enumerate([(0.5, 0.5), (-2.0, 0.0)], start=2):
        page.evaluate(
            """((number, typed) => {
                number.focus();
                number.value = typed;
                number.dispatchEvent(new Event("input"));
                number.dispatchEvent(new Event("change"));
            })(document.getElementById("number-link"), arguments[0])""",
            typed,
        )
        page.wait_for(lambda count=count: int(data(page, "drawn")) == count)  # type: ignore[misc]
        assert page.evaluate("diagram.points.at(-1).values.link") == there
        for name in ("range-link", "number-link"):
            assert (
                page.evaluate(f"document.getElementById('{name}').valueAsNumber") == there
            )


def test_a_length_is_shown_in_the_unit_in_which_the_run_has_it(
    browser: Browser, tmp_path: Path, oval: Disk
) -> None:
    with served(ROD, tmp_path, oval) as film:
        browser.visit(film.address)
        browser.wait_for(lambda: data(browser, "drawn") == "1")
        assert browser.evaluate("find('headline').textContent") == "ring: L = 10 cm"
        assert browser.evaluate("find('varied').textContent") == "L (cm)"
        assert numbers(browser)["length"] == "10 cm"
        assert browser.complaints() == []


def test_two_pages_share_one_film_and_one_closes_in_the_middle(
    page: Browser, live: Live
) -> None:
    first = page.driver.current_window_handle
    page.driver.switch_to.new_window("tab")
    page.driver.get(live.address)
    page.wait_for(lambda: data(page, "drawn") is not None)
    drag(page, 0.4)
    settle(page)
    there = numbers(page)
    drag(page, 0.45)
    page.driver.close()  # while the film is sought
    page.driver.switch_to.window(first)
    page.wait_for(lambda: page.evaluate("diagram.points.at(-1).values.link") > 1.2)
    assert numbers(page)["link"] != there["link"]
    drag(page, 0.2)
    settle(page)
    assert live.process.poll() is None


def test_on_a_phone_nothing_is_wider_than_the_screen(
    live: Live, tmp_path_factory: pytest.TempPathFactory
) -> None:
    with chromium(tmp_path_factory.mktemp("phone")) as phone:
        phone.become_a_phone()
        phone.visit(live.address)
        phone.wait_for(lambda: data(phone, "drawn") == "1")
        assert phone.evaluate("document.documentElement.scrollWidth") <= 390
        wide = phone.evaluate(
            """[...document.querySelectorAll("button, select, input")]
                .filter((one) => one.getBoundingClientRect().right > 390.5)
                .map(({ id }) => id)"""
        )
        assert wide == []
        phone.screenshot(ARTEFACTS / "live-phone.png")
        assert phone.complaints() == []


def test_it_ends_after_the_last_page(browser: Browser, live: Live) -> None:
    browser.visit(live.address)
    browser.wait_for(lambda: data(browser, "drawn") == "1")
    time.sleep(3.0)
    assert live.process.poll() is None
    browser.driver.get("about:blank")
    said, complained = live.process.communicate(timeout=PATIENCE)
    assert live.process.returncode == 0
    assert "no page is open" in said
    assert complained == ""
