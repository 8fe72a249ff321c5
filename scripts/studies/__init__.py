"""Studies: what was computed for the documentation, one folder for each launcher beside it.

`scripts/NAME` starts `python -m scripts.studies.NAME`; tests import from here.
"""
