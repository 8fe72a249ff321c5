"""Fronts with indefinite blocks, and with Cholesky's, against dense linear algebra."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.film.condensation import factorise
from eulerplateau.film.elimination import Elimination, plan
from eulerplateau.film.indefinite import factorise_indefinite
from eulerplateau.film.models import area
from eulerplateau.film.tiling import Tiling
from eulerplateau.mesh.disk import Disk

SMALL = 7  # vertices of a piece: many fronts, deep


@pytest.fixture(params=[False, True], ids=["whole", "kept"])
def fronts(
    request: pytest.FixtureRequest, oval: Disk, monkeypatch: pytest.MonkeyPatch
) -> tuple[Tiling, Elimination]:
    """Of the inside alone, or with the loop's rows in the last front."""
    monkeypatch.setattr("eulerplateau.film.tiling.LARGEST", SMALL)
    tiling = area(oval).tiling(oval.triangles)
    tiling = Tiling(tiling.triangles, tiling.loop, tiling.interior)
    row, column = (tiling.numbers[vertex] for vertex in tiling.pairs)
    n_i = len(tiling.interior)
    kept = np.arange(n_i, tiling.n_v if request.param else n_i)
    chosen = np.flatnonzero((row < n_i + len(kept)) & (column < n_i + len(kept)))
    assert len(tiling.pieces) > 5
    return tiling, plan(row[chosen], column[chosen], tiling.pieces, kept)


def entries(tiling: Tiling, shift: float, n: int) -> tuple[FloatArray, FloatArray]:
    """A random symmetric matrix (n, n) with the pattern of a mesh, and its entries."""
    row, column = (tiling.numbers[vertex] for vertex in tiling.pairs)
    random = np.random.default_rng(3).standard_normal((tiling.n_v, tiling.n_v))
    whole = random + random.T + shift * np.eye(tiling.n_v)
    chosen = np.flatnonzero((row < n) & (column < n))
    matrix = np.zeros((n, n))
    matrix[row[chosen], column[chosen]] = whole[row[chosen], column[chosen]]
    return matrix, whole[row[chosen], column[chosen]]


@pytest.mark.parametrize("shift", [-3.0, 0.0, 3.0])
@pytest.mark.parametrize("compiled", [0, 256], ids=["lapack", "compiled"])
def test_indefinite_matrix_is_solved_with_and_its_negative_eigenvalues_are_counted(
    fronts: tuple[Tiling, Elimination],
    shift: float,
    compiled: int,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("eulerplateau.film.indefinite._COMPILED", compiled)
    tiling, elimination = fronts
    n = len(elimination.order)
    matrix, values = entries(tiling, shift, n)
    factor = factorise_indefinite(elimination, values)
    eigenvalues = np.linalg.eigvalsh(matrix)
    assert factor.n_negative == int((eigenvalues < 0).sum())
    assert 0 < factor.n_negative < n
    x = np.random.default_rng(4).standard_normal((n, 2))
    least = np.abs(eigenvalues).min()
    np.testing.assert_allclose(factor.solve(matrix @ x), x, atol=1e-9 / min(least, 1.0))


def test_vanishing_pivot_is_an_error(fronts: tuple[Tiling, Elimination]) -> None:
    tiling, elimination = fronts
    _, values = entries(tiling, 0.0, len(elimination.order))
    with pytest.raises(LinAlgError):
        factorise_indefinite(elimination, 0.0 * values)


@pytest.mark.parametrize("columns", [(), (1,), (3,)])
def test_definite_matrix_is_solved_with_inside_for_any_number_of_columns(
    fronts: tuple[Tiling, Elimination], columns: tuple[int, ...]
) -> None:
    tiling, elimination = fronts
    n_i = len(tiling.interior)
    matrix, values = entries(tiling, 50.0, len(elimination.order))
    forces = np.random.default_rng(5).standard_normal((n_i, *columns))
    found = factorise(elimination, values).solve(forces)
    expected = np.linalg.solve(matrix[:n_i, :n_i], forces)
    np.testing.assert_allclose(found, expected, atol=1e-13)
