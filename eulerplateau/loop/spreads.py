"""How strands spread from where they touch, told to second order in a loop's edges.

At a point of contact a force f makes the curve's third derivative jump by f n / 2, in units
alpha = L = 1, and its second one has a kink. A spline through vertices cuts that off; and
where it lies between vertices these share the force, by phi_v(s). Their second differences
k_v are exact for such forces. So what one force at s makes of the second derivative is

    gamma''(s) = k(s) - n f / 4 sum_v phi_v(s) |s_v - s|,

k(s) being linear between vertices; and for forces along a stretch this is what it would be
if they were one, in the middle: positive as long as strands touch at a point only.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.loop.gaps import Gaps
from eulerplateau.loop.loop import backward_differences
from eulerplateau.loop.strands import Strands


def contact_spreads(
    strands: Strands, x: FloatArray, gaps: Gaps, forces: FloatArray, contact: IntArray
) -> FloatArray:
    """Return d2D/ds2 (k,), in 1/L, in the middle of each place's contact, were it a point.

    forces : (k,) with which strands push each other at the places
    contact : (k,) int, the number of the contact of which each is a place
    """
    found = np.zeros(len(gaps))
    for number in np.unique(contact):
        own = contact == number
        found[own] = _spread(strands, x, gaps[own], forces[own])
    return found


def _spread(strands: Strands, x: FloatArray, gaps: Gaps, forces: FloatArray) -> float:
    """Return d2D/ds2, in 1/L, in the middle of a contact of a loop (n, d), were it a point.

    gaps : the places of one contact, k of them
    forces : (k,) with which strands push each other there
    """
    whole = strands.knots[-1]
    pushes = np.maximum(forces, 0.0)
    shares = pushes / pushes.sum() if pushes.any() else np.full(len(gaps), 1 / len(gaps))

    def off(places: FloatArray, from_: FloatArray | float) -> FloatArray:
        apart: FloatArray = (places - from_ + 0.5 * whole) % whole - 0.5 * whole
        return apart

    # All from the strand of the first.
    first = gaps.s[0]
    turned = np.abs(off(gaps.t, first)) < np.abs(off(gaps.s, first))
    gaps = replace(
        gaps, s=np.where(turned, gaps.t, gaps.s), t=np.where(turned, gaps.s, gaps.t)
    )

    def middle(places: FloatArray) -> float:
        return float(places[0] + shares @ off(places, places[0]))

    here = np.zeros(1, dtype=bool)
    at = Gaps(np.array([middle(gaps.s)]), np.array([middle(gaps.t)]), here)
    at, _ = strands.at(x, at)
    between = strands.between(x, at)
    n, distance = between.normals[0], float(between.distances[0])
    along = between.along[:, 0]
    bends = []
    for place, places, way in (at.s, gaps.s, 1.0), (at.t, gaps.t, -1.0):
        cut = np.abs(off(strands.knots[:-1], place[0]))
        push = float(forces @ (strands.weights(places) @ cut))
        bends.append(float(_bend(strands, x, place[0]) @ n) - way * push / 4)
    one = along[0] @ along[0] + distance * bends[0]
    other = along[1] @ along[1] - distance * bends[1]
    if other <= 0.0:
        # The distance has no minimum by t: as far from a point as a contact can be.
        return -np.inf
    return float(one - (along[0] @ along[1]) ** 2 / other) / distance


def _bend(strands: Strands, x: FloatArray, s: float) -> FloatArray:
    """Return the curvature vector (d,) at s, linear between the vertices'."""
    loop = strands.loop
    tangents = loop.chords(x) / loop.rest_lengths[:, None]
    bends = backward_differences(tangents) / loop.mean_lengths[:, None]
    bends = np.vstack([bends, bends[:1]])
    inside = s % strands.knots[-1]
    return np.array([np.interp(inside, strands.knots, each) for each in bends.T])
