"""Static condensation: the film's interior eliminated exactly, once per mesh.

With the Laplacian split into interior (i) and loop (b),

    [L_ii L_ib] [x_i]   [ 0 ]
    [L_bi L_bb] [x_b] = [ f ]      x_i = -L_ii^-1 L_ib x_b,   f = S x_b,
                                   S = L_bb - L_bi L_ii^-1 L_ib,

S is the discrete Dirichlet-to-Neumann map; a relaxed film has the energy
load * tr(x_b^T S x_b).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import SuperLU, splu

from eulerplateau.mesh import FloatArray, IntArray

# Right-hand sides per back-substitution: enough for speed, few enough that the block
# (n_i, 64) stays small beside the factor.
_BLOCK = 64


@dataclass(frozen=True)
class Condensation:
    """A factorised interior.

    Attributes
    ----------
    stiffness : (n_b, n_b) float, symmetric
        S, per unit of load.
    """

    stiffness: FloatArray
    _factor: SuperLU | None
    _coupling: csc_array
    _loop: IntArray
    _interior: IntArray

    def extend(self, x_loop: FloatArray) -> FloatArray:
        """Return the relaxed film (n_v, 3) on a loop (n_b, 3)."""
        x = np.empty((len(self._loop) + len(self._interior), 3))
        x[self._loop] = x_loop
        if self._factor is not None:
            x[self._interior] = self._factor.solve(-(self._coupling @ x_loop))
        return x


def condense(laplacian: csc_array, loop: IntArray, interior: IntArray) -> Condensation:
    """Eliminate `interior` from `laplacian` (n_v, n_v); one sparse factorisation."""
    rows = laplacian.tocsr()
    inner = rows[interior]
    coupling = inner[:, loop].tocsc()
    stiffness = rows[loop][:, loop].toarray()
    factor = None
    if len(interior):
        # Symmetric positive definite: no pivoting, fill-reducing order of A + A^T.
        factor = splu(
            inner[:, interior].tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
        for start in range(0, len(loop), _BLOCK):
            block = slice(start, start + _BLOCK)
            stiffness[:, block] -= coupling.T @ factor.solve(coupling[:, block].toarray())
    symmetric = 0.5 * (stiffness + stiffness.T)
    return Condensation(symmetric, factor, coupling, loop, interior)
