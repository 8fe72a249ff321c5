"""`python -m eulerplateau` is the command `eulerplateau`."""

from eulerplateau.cli import main

if __name__ == "__main__":
    main()
