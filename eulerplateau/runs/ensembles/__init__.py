"""Ensembles: many runs from one file, each known by what it is and never by where it lies.

spec.py      what ENSEMBLE.toml may say, and the cases that makes
cases.py     a case: its name, a hash of all that decides its results; carried out
running.py   `run_ensemble`: what is missing is computed, by processes or a cluster
workers.py   processes of this machine; cluster.py: those of Dask
folder.py    where cases lie, and what is kept of those that failed
joining.py   one table of run folders, with the keys in which they differ
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
