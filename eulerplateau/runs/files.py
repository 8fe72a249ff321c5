"""Write a whole file or none: readers never meet half a file."""

from __future__ import annotations

import os
from pathlib import Path

from eulerplateau.errors import OutputError


def write_whole(path: Path, content: bytes) -> None:
    """Replace `path` by `content` in one step, through a temporary name beside it.

    Raises OutputError, with the old file untouched and the temporary one removed, if the
    folder is missing, full or not writable.
    """
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        try:
            temporary.write_bytes(content)
            os.replace(temporary, path)
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise
    except OSError as error:
        raise OutputError(path, f"cannot be written: {error.strerror}") from None
