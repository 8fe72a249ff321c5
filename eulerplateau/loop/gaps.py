"""Places where strands of a loop are near, and how the distances there change.

With r = gamma(s) - gamma(t), n = r / D and a = phi(s) - phi(t) it is dD/dx_v = a_v n. The
second derivative is that at fixed arclengths, a a^T (I - n n^T) / D, less M K^-1 M^T, K the
second derivative of D by the arclengths that are free and M the mixed one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import BoolArray, FloatArray
from eulerplateau.loop.term import summed

# A gap below this, in units of L, is negative: strands overlap.
NEGATIVE = -1e-11


@dataclass(frozen=True)
class Gaps:
    """Places where strands of a loop are near: k of them, at arclengths s and t.

    Attributes
    ----------
    s, t : (k,) float
    slides : (k,) bool, whether D is least by s too
    """

    s: FloatArray
    t: FloatArray
    slides: BoolArray

    def __len__(self) -> int:
        """Return k."""
        return len(self.s)

    def __getitem__(self, chosen: BoolArray) -> Gaps:
        """Return those of them that are chosen (k,)."""
        return Gaps(self.s[chosen], self.t[chosen], self.slides[chosen])

    def joined(self, other: Gaps) -> Gaps:
        """Return these and others behind them."""
        parts = [(self.s, other.s), (self.t, other.t), (self.slides, other.slides)]
        return Gaps(*(np.concatenate(pair) for pair in parts))


NO_GAPS = Gaps(np.zeros(0), np.zeros(0), np.zeros(0, dtype=bool))


@dataclass(frozen=True)
class Between:
    """What is known between the places of k gaps of a loop (n, d).

    Attributes
    ----------
    weights : (k, n) float, a = phi(s) - phi(t)
    slopes : (2, k, n) float, phi'(s) and -phi'(t)
    normals : (k, d) float, from t to s
    distances : (k,) float, D
    along : (2, k, d) float, gamma'(s) and -gamma'(t)
    bends : (2, k) float, n . gamma''(s) and -n . gamma''(t)
    """

    weights: FloatArray
    slopes: FloatArray
    normals: FloatArray
    distances: FloatArray
    along: FloatArray
    bends: FloatArray

    def jacobian(self) -> FloatArray:
        """Return how the distances change with the vertices (k, d n)."""
        rows: FloatArray = self.weights[:, :, None] * self.normals[:, None, :]
        return rows.reshape(len(rows), self._size)

    @property
    def _size(self) -> int:
        """Number of coordinates, d n."""
        return int(self.weights.shape[1] * self.normals.shape[1])

    def hessian(self, shares: FloatArray, slides: BoolArray) -> FloatArray:
        """Return the second derivative (d n, d n) of shares (k,) times the distances.

        slides : (k,) bool, whether they are least by s too
        """
        per = (shares / self.distances)[:, None]
        rows = self.jacobian()
        alike = self.weights.T @ (per * self.weights)
        whole = summed([alike, rows.T @ (-per * rows)], self.weights.shape[1])
        mixed, inverse = self._eliminated(slides)
        moved = np.einsum("k,kef,kfi->kei", shares, inverse, mixed)
        whole -= mixed.reshape(-1, self._size).T @ moved.reshape(-1, self._size)
        return whole

    def _eliminated(self, slides: BoolArray) -> tuple[FloatArray, FloatArray]:
        """Return M (k, 2, d n) and K^-1 (k, 2, 2), which is 0 along s where s is held."""
        normals = self.normals
        flat = self.along - (self.along * normals).sum(axis=2)[:, :, None] * normals
        flat /= self.distances[:, None]
        mixed = self.slopes[..., None] * normals[:, None, :]
        mixed = mixed + self.weights[:, :, None] * flat[:, :, None, :]
        curved = np.einsum("eki,fki->kef", self.along, flat)
        curved[:, 0, 0] += self.bends[0]
        curved[:, 1, 1] += self.bends[1]
        inverse = np.zeros_like(curved)
        inverse[slides] = np.linalg.inv(curved[slides])
        inverse[~slides, 1, 1] = 1 / curved[~slides, 1, 1]
        return mixed.reshape(2, len(normals), self._size).transpose(1, 0, 2), inverse

    def angles(self) -> FloatArray:
        """Return the acute angle between the strands' tangents (k,), degrees."""
        first, second = self.along / np.linalg.norm(self.along, axis=2)[:, :, None]
        cosine = (first * second).sum(axis=1)
        across = np.linalg.norm(first - cosine[:, None] * second, axis=1)
        angles: FloatArray = np.degrees(np.arctan2(across, np.abs(cosine)))
        return angles
