"""The gallery in a real browser: a full diagram, clicked, keyed, turned, touched.

Screenshots are left in tests/artefacts, to be looked at.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from eulerplateau.pictures.gallery import collect, page
from eulerplateau.runs import run_branches, run_sweep
from eulerplateau.runs.spec import load_run
from tests.helpers.browser import Browser, Image, chromium

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
ARTEFACTS = ROOT / "tests" / "artefacts"
RIGHT, LEFT, UP, DOWN, HOME, END = "\ue014\ue012\ue013\ue015\ue011\ue010"


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """The paper's first experiment: its sweep, and the whole diagram around it."""
    spec = load_run(ROOT / "runs" / "elongated.toml", {})
    path = tmp_path_factory.mktemp("runs")
    run_branches(spec, path / "branches")
    run_sweep(spec, path / "sweep")
    return [path / "branches", path / "sweep"]


@pytest.fixture(scope="module")
def gallery(folders: list[Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("page") / "gallery.html"
    path.write_bytes(page(collect(folders[:1])))
    assert path.stat().st_size < 10e6
    return path


@pytest.fixture(scope="module")
def started(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with chromium(tmp_path_factory.mktemp("profile")) as browser:
        yield browser


@pytest.fixture
def browser(started: Browser, gallery: Path) -> Iterator[Browser]:
    """The page just opened; afterwards it has not complained, nor fetched anything."""
    started.resize(1400, 900)
    started.open(gallery)
    yield started
    assert started.complaints() == []
    own = gallery.as_uri()
    assert {url for url in started.requested() if not url.startswith("data:")} == {own}
    assert started.evaluate("performance.getEntriesByType('resource').length") == 0


def step(browser: Browser) -> int:
    return int(browser.evaluate("document.body.dataset.step"))


def series(browser: Browser) -> str:
    return str(browser.evaluate("document.body.dataset.series"))


def curve(browser: Browser, number: int) -> dict[str, Any]:
    """Return the page's curve: its name, the numbers of its first and last row."""
    found: dict[str, Any] = browser.evaluate(
        "(({name, first, last}) => ({name, first, last}))(all[arguments[0]])", number
    )
    return found


def place_of(browser: Browser, number: int, row: int) -> tuple[float, float]:
    """Return where in the page the diagram shows a row of a curve."""
    return tuple(
        browser.evaluate(
            """((number, row) => {
                const { left, top } = diagram.chart.canvas.getBoundingClientRect();
                const point = all[number].drawn.indexOf(row);
                const { x, y } = diagram.chart.getDatasetMeta(number).data[point];
                return [left + x, top + y];
            })(...arguments)""",
            number,
            row,
        )
    )


def middle(browser: Browser, name: str) -> tuple[float, float]:
    return tuple(
        browser.evaluate(
            """((name) => {
                const box = document.getElementById(name).getBoundingClientRect();
                return [box.x + box.width / 2, box.y + box.height / 2];
            })(arguments[0])""",
            name,
        )
    )


def limits(browser: Browser) -> list[float]:
    found: list[float] = browser.evaluate(
        """["x", "y"].flatMap((name) =>
            [diagram.chart.scales[name].min, diagram.chart.scales[name].max])"""
    )
    return found


def span(limits: list[float]) -> float:
    return limits[1] - limits[0]


def part_changed(before: Image, after: Image) -> float:
    assert before.shape == after.shape
    return float((np.abs(before - after).max(axis=2) > 0.1).mean())


def wait_for_change(
    browser: Browser, name: str, before: Image, part: float = 0.01
) -> Image:
    """Wait until that part of an element looks different, and return how it looks."""
    browser.wait_for(lambda: part_changed(before, browser.picture(name)) > part)
    return browser.picture(name)


def peak(browser: Browser) -> int:
    """Return the row of branch 1, the twisted saddle, of largest <|kappa_n|>."""
    return int(
        browser.evaluate(
            """all[1].places.reduce((a, b) =>
                all[1].run.rows[a].abs_kappa_n > all[1].run.rows[b].abs_kappa_n ? a : b)"""
        )
    )


def test_click_on_the_diagram_changes_the_shape(browser: Browser) -> None:
    assert (series(browser), step(browser)) == ("branch 0", 0)
    disk = browser.picture("film")
    row = peak(browser)
    browser.click(*place_of(browser, 1, row))
    # The two mirror images are one point of the diagram.
    browser.wait_for(lambda: series(browser) in ("branch 1", "branch 2"))
    saddle = browser.picture("film")
    browser.screenshot(ARTEFACTS / "gallery-saddle.png")
    assert part_changed(disk, saddle) > 0.05
    load = browser.evaluate("all[1].run.rows[arguments[0]].kL3_alpha", row)
    assert f"{load:.6g}" in browser.evaluate("document.getElementById('row').textContent")


def test_second_click_on_one_place_shows_the_mirror_image(browser: Browser) -> None:
    place = place_of(browser, 1, peak(browser))
    browser.click(*place)
    browser.wait_for(lambda: series(browser) in ("branch 1", "branch 2"))
    first, picture = series(browser), browser.picture("film")
    browser.click(*place)
    browser.wait_for(lambda: {first, series(browser)} == {"branch 1", "branch 2"})
    wait_for_change(browser, "film", picture, 0.02)


def test_film_shows_which_side_is_its_front(browser: Browser) -> None:
    """A disk shows one side, the flat eight one side on the left and one on the right."""
    disk = browser.picture("film")
    browser.evaluate("show(all[3], all[3].last)")
    eight = browser.picture("film")
    browser.screenshot(ARTEFACTS / "gallery-eight.png")
    assert part_of(orange(disk)) < 0.001 < 0.05 < part_of(blue(disk))
    middle = eight.shape[1] // 2
    for half in (eight[:, :middle], eight[:, middle:]):
        sides = sorted([part_of(orange(half)), part_of(blue(half))])
        assert 20.0 * sides[0] < sides[1]
    assert min(part_of(orange(eight)), part_of(blue(eight))) > 0.03


def orange(image: Image) -> Any:
    return image[..., 0] > image[..., 2] + 0.15


def blue(image: Image) -> Any:
    return image[..., 2] > image[..., 0] + 0.15


def dark(image: Image) -> Any:
    return image.max(axis=2) < 0.3


def part_of(mask: Any) -> float:
    return float(mask.mean())


def test_arrow_keys_move_along_a_branch_and_between_branches(browser: Browser) -> None:
    last = curve(browser, 0)["last"]
    browser.press(RIGHT, RIGHT, RIGHT, LEFT)
    browser.wait_for(lambda: step(browser) == 2)
    browser.press(END, RIGHT)
    browser.wait_for(lambda: step(browser) == last)
    browser.press(HOME, LEFT)
    browser.wait_for(lambda: step(browser) == 0)
    browser.press(DOWN)
    first = curve(browser, 1)["first"]
    browser.wait_for(lambda: (series(browser), step(browser)) == ("branch 1", first))
    browser.press(UP)
    assert series(browser) == "branch 0"


def test_turning_and_zooming_last_when_the_point_changes(browser: Browser) -> None:
    before = browser.picture("film")
    x, y = middle(browser, "film")
    browser.drag(x, y, 120.0, 60.0)
    turned = wait_for_change(browser, "film", before)
    browser.wheel(x, y, -300.0)
    wait_for_change(browser, "film", turned)
    camera = "[...film.camera.position.toArray(), film.camera.zoom]"
    stands = browser.evaluate(camera)
    browser.press(RIGHT, DOWN)
    assert browser.evaluate(camera) == stands
    browser.driver.find_element("id", "view").click()
    browser.press(UP, HOME)
    browser.wait_for(lambda: part_changed(before, browser.picture("film")) < 0.001)


def test_first_view_cuts_no_shape_off(browser: Browser) -> None:
    """All around the picture, a frame stays white."""
    for number in range(int(browser.evaluate("all.length"))):
        found = curve(browser, number)
        for row in np.linspace(found["first"], found["last"], 4).astype(int):
            browser.evaluate("show(all[arguments[0]], arguments[1])", number, int(row))
            image = browser.picture("film")
            frame = np.concatenate([image[0], image[-1], image[:, 0], image[:, -1]])
            assert (frame == 1.0).all()
            assert part_of(image.min(axis=2) < 0.9) > 0.02


def test_diagram_zooms_and_shows_other_quantities(browser: Browser) -> None:
    whole = limits(browser)
    browser.wheel(*place_of(browser, 1, peak(browser)), -300.0)
    browser.wait_for(lambda: span(limits(browser)) < span(whole))
    browser.driver.find_element("id", "show-all").click()
    browser.wait_for(lambda: limits(browser) == whole)
    for choice in ("energy", "waist_twist", "lowest_eigenvalue"):
        before = browser.picture("chart")
        browser.driver.find_element("css selector", f"#y option[value={choice}]").click()
        wait_for_change(browser, "chart", before, 0.001)
    # The arrow keys belong to the branch again, not to the list.
    browser.press(RIGHT)
    browser.wait_for(lambda: step(browser) == 1)
    browser.screenshot(ARTEFACTS / "gallery-eigenvalue.png")


def test_hidden_branches_are_not_to_be_clicked(browser: Browser) -> None:
    place = place_of(browser, 1, peak(browser))
    browser.driver.find_element("css selector", "#legend label:nth-child(2) input").click()
    browser.click(*place)
    browser.wait_for(lambda: step(browser) > 0)
    assert series(browser) not in ("branch 1", "branch 2")


# What is to be read or pressed around diagram and shape: its box, and whether what is in it
# has room there; a list of choices is cut off with dots.
BOXES = """[...document.querySelectorAll("header > *, nav > *, #scale > *")].map((one) => {
    const { left, top, right, bottom } = one.getBoundingClientRect();
    const fits = one.tagName === "SELECT" || one.scrollWidth <= one.clientWidth + 1;
    return [one.id || one.tagName, [left, top, right, bottom], fits];
})"""


def are_apart(box: list[float], other: list[float]) -> bool:
    """Whether boxes, of left, top, right and bottom, overlap by less than half a pixel."""
    low, high = np.reshape([box, other], (2, 2, 2)).transpose(1, 0, 2)
    return bool((high.min(axis=0) - low.max(axis=0) < 0.5).any())


@pytest.mark.parametrize("wide", [1280, 768, 375])
def test_no_label_lies_on_a_button(browser: Browser, wide: int) -> None:
    browser.resize(wide, 812)
    browser.evaluate("show(all[1], arguments[0])", peak(browser))
    boxes = browser.evaluate(BOXES)
    assert len(boxes) > 10
    for number, (name, box, fits) in enumerate(boxes):
        assert fits, name
        assert box[0] >= -0.5, name
        assert box[2] <= wide + 0.5, name
        for other, beside, _ in boxes[:number]:
            assert are_apart(box, beside), (name, other)
    browser.screenshot(ARTEFACTS / f"gallery-{wide}.png")


def test_by_the_scale_bar_a_flat_film_from_above_has_its_area(browser: Browser) -> None:
    """It and the outer half of the tube round it; the bar follows the zoom."""
    radius, area = browser.evaluate("[all[0].run.radii[0], all[0].run.rows[0].area]")
    for zoom in (1.0, 0.6):
        browser.evaluate("(film.camera.zoom = arguments[0], film.above(normal()))", zoom)
        assert text_of(browser, "angle") == "seen from above"
        unit, parts = text_of(browser, "length").split("/")
        assert unit == "L"
        bar = "document.getElementById('bar').getBoundingClientRect().width"
        pixel = 1.0 / (int(parts) * browser.evaluate(bar))
        ink = (browser.picture("film").min(axis=2) < 0.9).sum()
        whole = area + radius + np.pi * radius**2
        # The outline is as long as the loop, L: by a pixel along it they may differ.
        assert ink * pixel**2 == pytest.approx(whole, abs=pixel)


def text_of(browser: Browser, name: str) -> str:
    return str(browser.evaluate("document.getElementById(arguments[0]).textContent", name))


def test_every_group_has_a_colour_and_marker_of_its_own(browser: Browser) -> None:
    looks = browser.evaluate(
        "[...diagram.groups.values()].map(([{ colour, marker }]) => `${colour} ${marker}`)"
    )
    assert len(set(looks)) == len(looks) > 3
    shown = browser.evaluate(
        "[...document.querySelectorAll('#legend i')].map((i) => i.textContent)"
    )
    assert len(set(shown)) == min(len(looks), 4)


def test_several_runs_are_one_diagram(
    started: Browser, folders: list[Path], tmp_path: Path
) -> None:
    content = page(collect(folders))
    (tmp_path / "gallery.html").write_bytes(content)
    started.open(tmp_path / "gallery.html")
    assert started.evaluate("document.querySelectorAll('#legend label').length") == 2
    started.press(UP)
    assert started.evaluate("document.body.dataset.run") == "sweep"
    started.screenshot(ARTEFACTS / "gallery-runs.png")
    assert started.complaints() == []


def test_the_stripe_on_a_twisted_loop_is_seen_and_no_other_loop_has_one(
    started: Browser, tmp_path: Path
) -> None:
    rod = {"loop.twist_ratio": 0.75, "loop.link": 1.3}
    for name, said in (("rod", rod), ("bare", {})):
        spec = load_run(ROOT / "runs" / "elongated.toml", {**said, "sweep.loads": [300.0]})
        run_sweep(spec, tmp_path / name)
    content = page(collect([tmp_path / "rod", tmp_path / "bare"]))
    (tmp_path / "gallery.html").write_bytes(content)
    started.open(tmp_path / "gallery.html")
    striped = started.picture("film")
    started.screenshot(ARTEFACTS / "gallery-twisted.png")
    started.evaluate("(film.stripe.visible = false, film.draw())")
    assert part_of(dark(started.picture("film"))) > 1.1 * part_of(dark(striped))
    started.press(DOWN)
    assert started.evaluate("document.body.dataset.run") == "bare"
    assert not started.evaluate("film.stripe.visible")
    started.press(UP)
    assert started.evaluate("film.stripe.visible")
    assert part_changed(striped, started.picture("film")) < 0.001
    assert started.complaints() == []


def test_without_webgl_the_diagram_and_the_numbers_remain(
    gallery: Path, tmp_path: Path
) -> None:
    with chromium(tmp_path, "--disable-3d-apis") as browser:
        browser.open(gallery)
        browser.press(RIGHT)
        browser.wait_for(lambda: step(browser) == 1)
        assert browser.driver.find_element("id", "no-webgl").is_displayed()
        browser.screenshot(ARTEFACTS / "gallery-no-webgl.png")


def test_phone(started: Browser, browser: Browser) -> None:
    browser.become_a_phone()
    browser.driver.refresh()
    width = browser.evaluate("document.documentElement.clientWidth")
    assert width == 390
    assert browser.evaluate("document.documentElement.scrollWidth") == width
    # Diagram, shape and the buttons to move along are on the first screen.
    assert (
        browser.evaluate("document.getElementById('on').getBoundingClientRect().bottom")
        < 844
    )
    before = browser.picture("film")
    browser.touch([place_of(browser, 1, peak(browser))])
    browser.wait_for(lambda: series(browser) in ("branch 1", "branch 2"))
    saddle = browser.picture("film")
    assert part_changed(before, saddle) > 0.05
    browser.screenshot(ARTEFACTS / "gallery-phone.png")
    x, y = middle(browser, "film")
    browser.touch([(x + 6.0 * i, y + 3.0 * i) for i in range(12)])
    wait_for_change(browser, "film", saddle)
    browser.touch(
        [(x - 20.0 - 5.0 * i, y) for i in range(12)],
        [(x + 20.0 + 5.0 * i, y) for i in range(12)],
    )
    browser.wait_for(lambda: browser.evaluate("film.camera.zoom") > 1.5)
    whole = limits(browser)
    x, y = middle(browser, "chart")
    browser.touch(
        [(x - 20.0 - 5.0 * i, y - 10.0 - 3.0 * i) for i in range(12)],
        [(x + 20.0 + 5.0 * i, y + 10.0 + 3.0 * i) for i in range(12)],
    )
    browser.wait_for(lambda: span(limits(browser)) < 0.8 * span(whole))
    browser.screenshot(ARTEFACTS / "gallery-phone-zoomed.png")
