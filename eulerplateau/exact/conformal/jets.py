"""Values with their first and second derivatives by a few variables, at many points.

What is integrated along a loop may be written as it stands on paper; sums, products,
quotients and functions of jets carry the derivatives by the rules of calculus (forward
differentiation: Griewank and Walther 2008, ch. 13).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import FloatArray


@dataclass(frozen=True)
class Jet:
    """A quantity at n points: value (n,), slope (n, m) and curvature (n, m, m)."""

    value: FloatArray
    slope: FloatArray
    curvature: FloatArray

    def __add__(self, other: Jet) -> Jet:
        """Return the sum."""
        return Jet(
            self.value + other.value,
            self.slope + other.slope,
            self.curvature + other.curvature,
        )

    def __mul__(self, other: Jet) -> Jet:
        """Return the product."""
        cross = self.slope[:, :, None] * other.slope[:, None, :]
        return Jet(
            self.value * other.value,
            _at(self.value) * other.slope + _at(other.value) * self.slope,
            _at2(self.value) * other.curvature
            + _at2(other.value) * self.curvature
            + cross
            + cross.transpose(0, 2, 1),
        )

    def __sub__(self, other: Jet) -> Jet:
        """Return the difference."""
        return self + other.times(-1.0)

    def __truediv__(self, other: Jet) -> Jet:
        """Return the quotient."""
        return self * other.power(-1.0)

    def times(self, number: float) -> Jet:
        """Return a multiple."""
        return Jet(number * self.value, number * self.slope, number * self.curvature)

    def power(self, exponent: float) -> Jet:
        """Return a power of a positive quantity."""
        first = exponent * self.value ** (exponent - 1)
        second = exponent * (exponent - 1) * self.value ** (exponent - 2)
        return self._function(self.value**exponent, first, second)

    def cos(self) -> Jet:
        """Return the cosine."""
        cosine, sine = np.cos(self.value), np.sin(self.value)
        return self._function(cosine, -sine, -cosine)

    def sin(self) -> Jet:
        """Return the sine."""
        cosine, sine = np.cos(self.value), np.sin(self.value)
        return self._function(sine, cosine, -sine)

    def _function(self, value: FloatArray, first: FloatArray, second: FloatArray) -> Jet:
        outer = self.slope[:, :, None] * self.slope[:, None, :]
        return Jet(
            value,
            _at(first) * self.slope,
            _at2(first) * self.curvature + _at2(second) * outer,
        )


def variables(values: FloatArray) -> list[Jet]:
    """Return the m variables themselves, of values (n, m)."""
    n, m = values.shape
    flat, unit = np.zeros((n, m, m)), np.eye(m)
    return [Jet(values[:, k], np.tile(unit[k], (n, 1)), flat) for k in range(m)]


def dot(a: list[Jet], b: list[Jet]) -> Jet:
    """Return the scalar product of two vectors of jets."""
    first, *others = (x * y for x, y in zip(a, b, strict=True))
    for other in others:
        first = first + other
    return first


def _at(values: FloatArray) -> FloatArray:
    return values[:, None]


def _at2(values: FloatArray) -> FloatArray:
    return values[:, None, None]
