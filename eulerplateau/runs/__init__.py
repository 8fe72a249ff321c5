"""Runs: from a specification to a folder of rows and shapes, and back.

    running.py      `run`, as from the command line; plan.py: which runs a call asks for
    spec.py         what a file of runs/ may say, to which a key is added; spec_files.py:
                    how it is read; bench_spec.py, bench_load.py: of line and liquid
    inputs.py       its mesh, and what is in the files that it names
    start.py        where a run starts: at its mesh or at a stored shape
    sweep.py, exploration.py   a sweep, the branches; recording.py: what both write
    catalogue.py    all equilibria at a load
    live_film.py    a film that follows what one drags; live_values.py: what that is
    rows.py         the columns of sweep.csv and its kin; table.py: the files;
                    folder.py: the folder
    shape_files.py  shapes/*.vtp and their fields, written and read
    record.py       `read_run`: a folder read back; series.py: the curves of its diagram;
                    states.py: its distinct states; noise.py: what of them is rounding

What has been computed is on disk row by row, and valid after every step.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
