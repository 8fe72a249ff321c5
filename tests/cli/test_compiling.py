"""What is compiled at its first use is said, and nothing where it has been compiled."""

from __future__ import annotations

from eulerplateau.compiling import njit, telling_of_compiling


def test_first_call_alone_says_that_it_compiles() -> None:
    said: list[str] = []
    successor = njit(lambda number: number + 1)
    with telling_of_compiling(said.append):
        assert successor(1) == 2
        told = len(said)
        assert successor(2) == 3
    njit(lambda number: number - 1)(1)
    assert told == len(said) > 0
    assert "compiling" in said[0]
