"""Functions of LAPACK and BLAS, SciPy's, without the rest of `scipy.linalg`.

To load that package takes longer than all else that a small film of springs needs, most of
it for arrays that are not NumPy's. What is compiled in it is loaded here by itself, under
its own name: whoever imports `scipy.linalg` later finds it there.
"""

from __future__ import annotations

import sys
from importlib import import_module
from importlib.machinery import PathFinder
from importlib.util import module_from_spec
from typing import Any

import scipy


def _compiled(name: str, public: str) -> Any:
    """Return a compiled module of `scipy.linalg`; where there is none, the public one."""
    full = f"scipy.linalg.{name}"
    if full not in sys.modules:
        found = PathFinder.find_spec(full, [f"{path}/linalg" for path in scipy.__path__])
        if found is None or found.loader is None:
            return import_module(f"scipy.linalg.{public}")
        module = sys.modules[full] = module_from_spec(found)
        found.loader.exec_module(module)
    return sys.modules[full]


_lapack, _blas = _compiled("_flapack", "lapack"), _compiled("_fblas", "blas")

dgelsy, dgtsv = _lapack.dgelsy, _lapack.dgtsv
dgeqrf, dormqr = _lapack.dgeqrf, _lapack.dormqr
dpotrf, dpotrs = _lapack.dpotrf, _lapack.dpotrs
dpttrf, dpttrs = _lapack.dpttrf, _lapack.dpttrs
dsygst, dtrtrs = _lapack.dsygst, _lapack.dtrtrs
dsyrk, dtrsm = _blas.dsyrk, _blas.dtrsm
