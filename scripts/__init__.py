"""Launchers, which set up and start; the Python of the studies is in `studies`."""
