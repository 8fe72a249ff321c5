"""What `--json` prints where a film is refused."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from contextlib import contextmanager

import click

from eulerplateau.errors import NotConvergedError


@contextmanager
def refusals_as_json(wanted: bool, names: Iterable[str]) -> Iterator[None]:
    """Print, if it is wanted, an object with `status` and `problem` of a refused film.

    The numbers of these names are null. The error goes on its way: the line, the exit code.
    """
    try:
        yield
    except NotConvergedError as error:
        if wanted:
            nothing = dict.fromkeys(names)
            said = {**nothing, "status": error.status, "problem": error.problem}
            click.echo(json.dumps(said, indent=2))
        raise
