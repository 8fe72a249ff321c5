"""Formulas of the documentation, which browsers draw by themselves: LaTeX to MathML.

A fenced block `math` of a page, which GitHub draws too, is displayed. This file is a hook
of `mkdocs.yml`: mkdocs calls `on_config` when it has read that.
"""

from __future__ import annotations

import logging
import re
from html import escape
from typing import Any

from math_core import LatexError, LatexToMathML
from mkdocs.config.defaults import MkDocsConfig

_log = logging.getLogger(f"mkdocs.hooks.{__name__}")
_converter = LatexToMathML(fancy_error=False)


def mathml(latex: str) -> str:
    """Return a displayed formula as MathML; raises `LatexError` where it is none.

    Primes are of a class, because fonts draw them raised and small already (`site.css`).
    """
    formula = _converter.convert_with_local_state(latex, displaystyle=True)
    return re.sub("<mo>(?=[\u2032-\u2034\u2057]</mo>)", '<mo class="prime">', formula)


def on_config(config: MkDocsConfig) -> None:
    """Have pages' fenced blocks `math` displayed as formulas."""
    fence = {"name": "math", "class": "formula", "format": _displayed}
    config.mdx_configs["pymdownx.superfences"] = {"custom_fences": [fence]}


def _displayed(latex: str, _language: str, style: str, *_: Any, **__: Any) -> str:
    """Return the HTML of a block, or its text and a warning, by which `--strict` fails."""
    try:
        inner = mathml(latex)
    except LatexError as error:
        _log.warning("no formula: %s in\n%s", error, latex)
        inner = f"<pre>{escape(latex)}</pre>"
    return f'<div class="{style}" data-search-exclude>{inner}</div>'
