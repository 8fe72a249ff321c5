"""The documentation's site: its pages' names, its formulas, and how it opens from disk."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from markdown import markdown
from math_core import LatexError

import eulerplateau
from scripts.site.formulas import mathml
from tests.helpers.browser import Browser, chromium
from tests.helpers.pages import DOCS, EXAMPLES, PAGES, ROOT, blocks, title

INDEX = DOCS / "index.md"

# Whether every table is in a box that scrolls.
BOXED = "[...document.querySelectorAll('article table')].every(t => t.closest({}))".format(
    "'.md-typeset__scrollwrap, .highlighttable'"
)
# How far boxes narrower than what they hold can be scrolled, and how far they must.
REACH = """(() => {
    const boxes = [...document.querySelectorAll('.md-typeset__scrollwrap, .formula')]
        .filter(box => box.scrollWidth > box.clientWidth);
    for (const box of boxes) box.scrollLeft = 1e6;
    return [boxes.map(box => box.scrollLeft),
            boxes.map(box => box.scrollWidth - box.clientWidth)];
})()"""
# The tops and bottoms of all numerators and denominators.
FRACTIONS = """[...document.querySelectorAll('mfrac')].map(fraction =>
    [...fraction.children].map(part => part.getBoundingClientRect())
        .map(({ top, bottom }) => [top, bottom]))"""
FONT = "[...document.fonts].some(f => f.family.includes('STIX') && f.status == 'loaded')"


def test_index_names_every_page_by_its_title() -> None:
    named = re.findall(r"^\| \[([^]]+)\]\((\S+)\) \|", INDEX.read_text(), re.M)
    assert sorted(named) == sorted(
        (title(page), page.name) for page in PAGES if page != INDEX
    )
    assert len(dict(named)) == len(named)


def test_formulas_are_formulas() -> None:
    formulas = [latex for page in PAGES for latex in blocks(page, "math")]
    assert formulas
    for latex in formulas:
        assert mathml(latex).startswith("<math ")
    for wrong in (r"\fraction{1}{2}", r"\frac{1}", "{x", r"\left( x"):
        with pytest.raises(LatexError):
            mathml(wrong)


def test_no_formula_is_displayed_as_code() -> None:
    for page in PAGES:
        html = markdown(page.read_text(), extensions=["fenced_code", "tables"])
        for code in re.findall("<pre><code>(.*?)</code></pre>", html, re.DOTALL):
            without_comments = re.sub("#.*", "", code)
            assert not re.search("[αβκπσ∂∫∮√²³½]", without_comments), page


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of the built site; any warning of the build is an error."""
    folder = tmp_path_factory.mktemp("site")
    build = ["-P", "-m", "mkdocs", "build", "--strict"]
    where = ["--config-file", str(ROOT / "mkdocs.yml"), "--site-dir", str(folder)]
    subprocess.run([sys.executable, *build, *where], check=True)
    return folder


def built(site: Path) -> dict[str, str]:
    """Return the built pages by name."""
    return {path.stem: path.read_text() for path in site.glob("*.html")}


def test_site_has_every_page_and_loads_nothing_from_elsewhere(site: Path) -> None:
    pages = built(site)
    assert pages.keys() == {page.stem for page in PAGES} | {"404"}
    for text in pages.values():
        loaded = re.findall(r"<(?:script|link|img)\b[^>]*\b(?:src|href)=\"([^\"]*)\"", text)
        assert loaded
        assert not [address for address in loaded if re.match(r"https?:|//", address)]


def test_navigation_has_every_page_by_its_title(site: Path) -> None:
    entry = (
        r'<a href="([\w-]+)\.html" class="md-nav__link[^>]*>\s*<span[^>]*>\s*([^<]*?)\s*<'
    )
    found = re.findall(entry, built(site)["404"].replace('href="/', 'href="'))
    assert sorted(found) == sorted((page.stem, title(page)) for page in PAGES)


def test_formulas_of_every_page_are_in_its_html(site: Path) -> None:
    pages = built(site)
    for page in PAGES:
        assert pages[page.stem].count("<math ") == len(blocks(page, "math"))


def test_interface_page_documents_the_front_door_and_what_examples_import(
    site: Path,
) -> None:
    documented = set(re.findall(r'id="eulerplateau\.([\w.]+)"', built(site)["api"]))
    names = set(eulerplateau.__all__) - {"__version__"}
    assert names <= {found.rpartition(".")[2] for found in documented}
    listed = (DOCS / "api.md").read_text().partition("\n## Meshes")[0]
    assert names <= set(re.findall(r"\[`(\w+)`\]", listed))
    for page in set(EXAMPLES) - {DOCS / "true-film.md"}:  # of rooms inside a room
        tree = ast.parse("".join(blocks(page, "python")))
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and node.module.startswith("eulerplateau"):
                module = node.module.partition(".")[2]
                assert {f"{module}.{alias.name}" for alias in node.names} <= documented


@pytest.fixture
def browser(site: Path, tmp_path: Path) -> Iterator[Browser]:
    """A browser; what it opens last does not complain, and fetches own files only."""
    with chromium(tmp_path / "profile") as browser:
        yield browser
        assert_sound(browser, site)


def assert_sound(browser: Browser, site: Path) -> None:
    """Check what was said and fetched since a page was opened."""
    assert browser.complaints() == []
    own = (f"{site.as_uri()}/", "data:")
    assert [url for url in browser.requested() if not url.startswith(own)] == []


@pytest.mark.slow
def test_search_works_from_disk(site: Path, browser: Browser) -> None:
    browser.open(site / "cells.html")
    field = browser.driver.find_element("css selector", "[data-md-component=search-query]")
    field.click()
    field.send_keys("writhe")
    links = "document.querySelectorAll('a.md-search-result__link')"
    browser.wait_for(lambda: browser.evaluate(f"{links}.length") > 0)
    pages = browser.evaluate(f"[...{links}].map(link => link.pathname.split('/').pop())")
    found = {page.stem for page in PAGES if "writhe" in page.read_text().lower()}
    assert {f"{name}.html" for name in found} <= set(pages)
    assert_sound(browser, site)
    browser.driver.find_element("css selector", "a.md-search-result__link").click()
    browser.wait_for(lambda: "writhe" in browser.evaluate("document.title + location.href"))
    assert "writhe" in browser.evaluate("document.querySelector('article').textContent")


@pytest.mark.slow
def test_only_tables_and_formulas_scroll_sideways_on_a_phone(
    site: Path, browser: Browser
) -> None:
    browser.become_a_phone()
    scrolled = 0
    for page in PAGES:
        browser.open(site / f"{page.stem}.html")
        browser.wait_for(lambda: browser.evaluate(BOXED))
        assert browser.evaluate("document.documentElement.scrollWidth") <= 390, page
        reach, needed = browser.evaluate(REACH)
        assert reach == pytest.approx(needed, abs=1), page
        scrolled += len(reach)
        assert_sound(browser, site)
    assert scrolled > len(PAGES)


@pytest.mark.slow
def test_formulas_are_drawn_in_their_font(site: Path, browser: Browser) -> None:
    for page in (page for page in PAGES if blocks(page, "math")):
        browser.open(site / f"{page.stem}.html")
        browser.wait_for(lambda: browser.evaluate(FONT))
        fractions = browser.evaluate(FRACTIONS)
        assert len(fractions) == "".join(blocks(page, "math")).count("\\frac")
        for (top, middle), (below, bottom) in fractions:
            assert top < middle <= below < bottom
        assert_sound(browser, site)
