"""The package's files as Python reads them, each parsed once."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path


@cache
def tree(path: Path) -> ast.Module:
    """The syntax tree of a file."""
    return ast.parse(path.read_text())


@cache
def nodes(path: Path) -> tuple[ast.AST, ...]:
    """All that is in it."""
    return tuple(ast.walk(tree(path)))


def statements(path: Path) -> Iterator[ast.Import | ast.ImportFrom]:
    """Yield what a file imports, in its functions too."""
    yield from (n for n in nodes(path) if isinstance(n, ast.Import | ast.ImportFrom))
