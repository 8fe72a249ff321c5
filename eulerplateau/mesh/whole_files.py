"""Write a whole file or none: readers never meet half a file."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from threading import get_ident

from eulerplateau.errors import OutputError

# How the names of files begin that are not whole yet; a process that is killed leaves them.
TEMPORARY = ".new-"


def write_whole(path: Path, content: bytes) -> None:
    """Replace `path` by `content` in one step, through a temporary name beside it.

    Raises OutputError, with the old file untouched and the temporary one removed, if the
    folder is missing, full or not writable.
    """
    with whole_file(path) as temporary:
        temporary.write_bytes(content)


def sync(*paths: Path) -> None:
    """See to it that files outlive a loss of power, their names included."""
    for place in (*paths, *dict.fromkeys(path.parent for path in paths)):
        with suppress(OSError):
            number = os.open(place, os.O_RDONLY)
            try:
                os.fsync(number)
            finally:
                os.close(number)


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Yield a temporary name beside `path`, to write to; it then takes the place of `path`.

    It has the extension of `path`. Raises and leaves behind what `write_whole` does.
    """
    temporary = path.with_name(f"{TEMPORARY}{os.getpid()}-{get_ident()}.{path.name}")
    try:
        try:
            yield temporary
            os.replace(temporary, path)
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise
    except OSError as error:
        raise OutputError(path, f"cannot be written: {error.strerror}") from None
