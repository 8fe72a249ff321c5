"""`python -m eulerplateau` is the command `eulerplateau`, and begins here, too."""

import os
import sys

from eulerplateau.interruption import listen

# A stream that is closed leaves its number to the next file that is opened: a table would
# get what is said.
for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
    if getattr(sys, name) is None:
        setattr(sys, name, open(os.devnull, mode))  # noqa: SIM115

# Before anything else is loaded, which takes its time.
listen()

from eulerplateau.cli import main  # noqa: E402

if __name__ == "__main__":
    main()
