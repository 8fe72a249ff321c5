"""Errors the user can cause, each with the exit code the command line ends with."""

from __future__ import annotations

NOT_CONVERGED_EXIT_CODE = 4


class EulerPlateauError(Exception):
    """Base of every error a user can cause; `exit_code` is what the shell sees.

    The arguments of a subclass are those of the exception, so that it survives pickling
    on its way out of a worker process. Its text is one line that any terminal can show,
    whatever the names in it are.
    """

    exit_code = 1

    def __str__(self) -> str:
        """Return what is wrong; what cannot be printed in a line is escaped."""
        said = self._text()
        return "".join(c if c.isprintable() else repr(c)[1:-1] for c in said)

    def _text(self) -> str:
        return super().__str__()


class SpecError(EulerPlateauError):
    """A run or mesh specification is wrong.

    `key` is the dotted key at fault ("sweep.loads"), or the file's path if the file
    itself cannot be used.
    """

    exit_code = 2

    def __init__(self, key: str, problem: str) -> None:
        super().__init__(key, problem)
        self.key = key

    def _text(self) -> str:
        return "{}: {}".format(*self.args)


class MeshError(EulerPlateauError):
    """A mesh is not a clean triangulated disk.

    `kind` is "vertex", "edge", "triangle" or "mesh"; `index` the first culprit (a vertex
    or triangle number, or a pair of vertex numbers for an edge), None for "mesh".
    """

    exit_code = 3

    def __init__(
        self, kind: str, index: int | tuple[int, int] | None, problem: str
    ) -> None:
        super().__init__(kind, index, problem)
        self.kind = kind
        self.index = index

    def _text(self) -> str:
        kind, index, problem = self.args
        return f"{kind}: {problem}" if index is None else f"{kind} {index}: {problem}"


class OutputError(EulerPlateauError):
    """A file cannot be read or written (full disk, no permission, ...)."""

    exit_code = 5

    def __init__(self, path: object, problem: str) -> None:
        super().__init__(path, problem)
        self.path = path

    def _text(self) -> str:
        return "{}: {}".format(*self.args)


class ConflictError(EulerPlateauError):
    """A run folder holds another run, or another process writes to it.

    `keys` are those in which the two runs differ.
    """

    exit_code = 6

    def __init__(self, path: object, keys: list[str], writer: str = "") -> None:
        super().__init__(path, keys, writer)
        self.keys = keys

    def _text(self) -> str:
        path, keys, writer = self.args
        if writer:
            return f"{path}: {writer} is writing to it: wait for its end, or name another"
        named = ", ".join(keys)
        return f"{path}: holds another run, with other {named}: --overwrite replaces it"


class MissingLibraryError(EulerPlateauError):
    """A library is missing; the message says which package brings it."""


class NotConvergedError(EulerPlateauError):
    """An equilibrium that was asked for is not found, or cannot be trusted.

    `problem` is the message; `status` says it in a word, as that of a row does.
    """

    exit_code = NOT_CONVERGED_EXIT_CODE

    def __init__(self, problem: str, status: str = "stalled") -> None:
        super().__init__(problem, status)
        self.problem = problem
        self.status = status

    def _text(self) -> str:
        return self.problem
