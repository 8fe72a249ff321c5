"""`python -m eulerplateau` is the command `eulerplateau`, and begins here, too."""

import gc
import os
import sys
from typing import NoReturn

from eulerplateau.interruption import listen

# A stream that is closed leaves its number to the next file that is opened: a table would
# get what is said.
for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
    if getattr(sys, name) is None:
        setattr(sys, name, open(os.devnull, mode))  # noqa: SIM115

# Before anything else is loaded, which takes its time.
listen()
# What is loaded is no garbage. At Python's 700 new objects it would be looked through a
# hundred times.
gc.set_threshold(200_000)

from eulerplateau import cli  # noqa: E402


def main() -> NoReturn:
    """Carry out the command line, and end."""
    try:
        cli.main()
    finally:
        # All memory goes with the process: no garbage need be looked for in it at the end.
        gc.freeze()


if __name__ == "__main__":
    main()
