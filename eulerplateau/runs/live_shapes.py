"""Where shapes of a live film are saved: in its run folder, under names of their own."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from itertools import count
from pathlib import Path

from eulerplateau.errors import OutputError
from eulerplateau.runs.run_files import LIVE, check_is_run


@contextmanager
def new_shape_file(folder: Path) -> Iterator[Path]:
    """Yield the first file of live/ in a run folder that is not there yet.

    It is made, so that nothing is replaced, and removed again if it is not written. Raises
    OutputError if it cannot be made, or the folder holds something else than a run.
    """
    if folder.exists():
        check_is_run(folder)
    path = _made(folder / LIVE)
    try:
        yield path
    except BaseException:
        path.unlink(missing_ok=True)
        raise


def _made(folder: Path) -> Path:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        numbers = count(1)
        while True:
            path = folder / f"live-{next(numbers):04d}.vtp"
            try:
                path.touch(exist_ok=False)
            except FileExistsError:
                continue
            return path
    except OSError as error:
        raise OutputError(folder, f"cannot be written: {error.strerror}") from None
