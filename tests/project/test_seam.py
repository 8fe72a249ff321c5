"""The seam between films and what stands above them: who may know what kind a film is."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import eulerplateau
from tests.helpers.sources import nodes, tree

ROOT = Path(eulerplateau.__file__).parent
FILES = {path.relative_to(ROOT).as_posix(): path for path in sorted(ROOT.rglob("*.py"))}

FILMS = {"QuadraticFilm", "AreaFilm", "PlaneFilm"}
# The solver chooses its search by the film, conjugate gradients their unknowns; and soap
# films alone are corrected.
TOLD_APART = {"solvers/correction.py", "solvers/newton.py", "solvers/trial_space.py"}


def names(code: ast.AST) -> set[str]:
    """Every name that code uses, defines, imports or reaches through a module."""
    found = set()
    for node in ast.walk(code):
        match node:
            case ast.Name(id=name) | ast.Attribute(attr=name) | ast.ClassDef(name=name):
                found.add(name)
            case ast.alias(name=name):
                found.add(name.rpartition(".")[2])
    return found


@cache
def kinds() -> set[str]:
    """The classes of films and of the loop's energies, and what they are made of."""
    return {
        node.name
        for name, path in FILES.items()
        if name.startswith(("film/", "loop/"))
        for node in nodes(path)
        if isinstance(node, ast.ClassDef)
    }


def asked_for(code: ast.AST) -> Iterator[ast.AST]:
    """Yield what code asks of the class of a value, other than by `match`."""
    for node in ast.walk(code):
        match node:
            case ast.Call(func=ast.Name(id="isinstance" | "issubclass"), args=[_, asked]):
                yield asked
            case ast.Compare(left=ast.Call(func=ast.Name(id="type")), comparators=asked):
                yield from asked


def matched(code: ast.AST) -> Iterator[ast.AST]:
    """Yield the classes that code tells apart by `match`."""
    yield from (node.cls for node in ast.walk(code) if isinstance(node, ast.MatchClass))


def test_films_are_called_by_name_where_they_are_told_apart_and_nowhere_else() -> None:
    found = {name for name, path in FILES.items() if names(tree(path)) & FILMS}
    assert {name for name in found if not name.startswith("film/")} == TOLD_APART
    stubs = {path: names(tree(path)) for path in ROOT.rglob("*.pyi")}
    calling = {path.name for path, named in stubs.items() if named & FILMS}
    assert calling == {"__init__.pyi"}


def test_no_code_asks_what_kind_of_film_energy_or_chart_it_has() -> None:
    for name, path in FILES.items():
        code = tree(path)
        asked = {n for node in asked_for(code) for n in names(node)}
        assert asked & kinds() == set(), name
        known = FILMS if name in TOLD_APART else set()
        assert {n for node in matched(code) for n in names(node)} & kinds() <= known, name


def test_every_way_of_asking_is_noticed() -> None:
    code = """
isinstance(film, (AreaFilm, film.PlaneFilm))
type(film) is AreaFilm
match film:
    case QuadraticFilm(): pass
"""
    asked = [names(node) for node in asked_for(ast.parse(code))]
    assert asked == [{"AreaFilm", "film", "PlaneFilm"}, {"AreaFilm"}]
    assert [names(node) for node in matched(ast.parse(code))] == [{"QuadraticFilm"}]
    assert FILMS | {"LocalFilm", "Area", "Bending", "LoopEnergy"} <= kinds()
