"""`python -m eulerplateau` is the command `eulerplateau`, and begins here, too."""

from eulerplateau.interruption import listen

# Before anything else is loaded, which takes its time.
listen()

from eulerplateau.cli import main  # noqa: E402

if __name__ == "__main__":
    main()
