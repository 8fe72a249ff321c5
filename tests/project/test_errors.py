"""Errors cross process boundaries whole, and each has the exit code it promises."""

import pickle

import pytest

from eulerplateau.errors import MeshError, OutputError, SpecError

ERRORS = [
    (SpecError("sweep.loads", "is empty"), 2),
    (MeshError("edge", (3, 4), "has no length"), 3),
    (MeshError("mesh", None, "is closed"), 3),
    (OutputError("runs/x", "disk full"), 5),
]


@pytest.mark.parametrize("make", [SpecError, OutputError])
def test_names_that_are_no_line_are_escaped(make):
    """Keys may be quoted in TOML, and files may be called anything."""
    said = str(make("a\nb\x1b[2Jµ\udc80", "is\u2028wrong"))
    assert said == "a\\nb\\x1b[2Jµ\\udc80: is\\u2028wrong"
    said.encode()


@pytest.mark.parametrize(("error", "code"), ERRORS)
def test_errors_survive_pickling_with_their_attributes(error, code):
    copy = pickle.loads(pickle.dumps(error))
    assert type(copy) is type(error)
    assert vars(copy) == vars(error)
    assert str(copy) == str(error)
    assert copy.exit_code == code
