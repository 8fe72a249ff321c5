"""The documentation's pages and the fenced blocks in them."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = sorted(DOCS.glob("*.md"))
EXAMPLES = [ROOT / "README.md", *PAGES]


def blocks(page: Path, language: str) -> list[str]:
    """Return the fenced blocks of a page in one language, in order; those of lists too."""
    return re.findall(rf"^ *```{language}\n(.*?)^ *```$", page.read_text(), re.M | re.S)


def title(page: Path) -> str:
    """Return the heading of a page."""
    return page.read_text().splitlines()[0].removeprefix("# ")
