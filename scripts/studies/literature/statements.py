"""Statements of the literature, each with what this program gives for the same quantity.

The literature's load is nu = sigma R^3 / a, R = L / 2 pi, a = 2 alpha the rigidity of the
loop to bending: sigma_hat = sigma L^3 / alpha = 16 pi^3 nu. A ring under the pressure p is
the same problem in its plane, p times the area enclosed being its energy: nu = p R^3 / a.
"""

# ruff: noqa: RUF001 (Greek letters and minus signs, as they are printed)

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from eulerplateau.exact import planar_film, thresholds
from eulerplateau.exact.conformal import (
    PLANAR,
    TWISTED,
    Family,
    disk,
    go_to_load,
    locate,
    make_basis,
    modes,
    morse_index,
    resolve,
    switch,
)
from eulerplateau.mesh import Disk
from eulerplateau.solvers import Problem, tangent_model
from scripts.studies.common import make_mesh

PER_NU = 16 * pi**3
# Of loops with three lobes, and of loops that keep one half-turn, about x.
MIRROR = Family("mirror", ((("cos", 0), ("cos", 1)), (("sin", 0), ("sin", 1)), ()))
HALF_TURN = Family("half-turn", (*MIRROR.harmonics[:2], (("sin", 0), ("sin", 1))))
# Amplitude at which branches are looked at, beside the disk they leave.
BESIDE = 0.02
SAME, CLOSE = 1e-9, 1e-3
# Mora et al. 2012: Young's modulus, radius, surface tension, as the review quotes them.
YOUNG, RADIUS, SURFACE_TENSION = 3.55e9, 0.25e-3, 27.3e-3
# Vertices of the disks on which rings are twisted: about 36 and 69 edges.
SIZES = (130, 474)


@dataclass(frozen=True)
class Statement:
    """A statement, whose it is, its number as printed and as sigma_hat, and ours."""

    claim: str
    whose: str
    theirs: str
    converted: str
    here: str
    agree: str


def agreement(theirs: float, here: float) -> str:
    """Return whether two numbers are the same, and to which part of themselves."""
    apart = here / theirs - 1
    if abs(apart) < SAME:
        return "yes"
    if abs(apart) < CLOSE:
        return f"to {abs(apart):.0e}"
    return f"no: {100 * apart:+.1f} %"


def threshold(claim: str, whose: str, theirs: str, here: float, digits: int) -> Statement:
    """Return a statement about the nu at which something happens.

    The two agree if they are one number, or ours is theirs when it is rounded as theirs is.
    """
    nu = float(theirs)
    printed = len(theirs.partition(".")[2])
    rounded = printed > 0 and f"{here:.{printed}f}" == theirs
    return Statement(
        claim=claim,
        whose=whose,
        theirs=f"ν = {theirs}",
        converted=f"{PER_NU * nu:.2f}",
        here=f"ν = {here:.{digits}f}",
        agree="yes, as printed" if rounded else agreement(nu, here),
    )


def disks() -> list[Statement]:
    """Return what becomes of the disk, by the eigenvalues of films without a mesh."""
    whose = "Chen and Fried 2014"
    leaving = [
        (f"{name} {n}", unstable_modes(nu, family))
        for name, n, nu, family in (
            ("planar", 2, 3, PLANAR),
            ("planar", 3, 8, MIRROR),
            ("planar", 4, 15, PLANAR),
            ("across", 2, 6, TWISTED),
            ("across", 3, 12, HALF_TURN),
        )
    ]
    first, *others = [count for _, count in leaving]
    return [
        threshold("the disk gives way, in its plane", whose, "3", disk_gives_way(), 9),
        Statement(
            claim="all other branches that leave the disk are unstable",
            whose=whose,
            theirs="",
            converted="",
            here="unstable modes: " + ", ".join(f"{name}: {n}" for name, n in leaving),
            agree="yes, these" if first == 0 and min(others) > 0 else "no",
        ),
    ]


def disk_gives_way() -> float:
    """Return the nu at which the disk's planar eigenvalue of n = 2 vanishes."""
    basis = make_basis(16, PLANAR)

    def nearest(nu: float) -> float:
        found = modes(disk(basis, PER_NU * nu), PLANAR)
        return min((mode.eigenvalue for mode in found), key=abs)

    return float(brentq(nearest, 2.9, 3.1, xtol=1e-12))


def unstable_modes(nu: float, family: Family) -> int:
    """Return the Morse index of the branch that leaves the disk at nu, close to it."""
    round_film = disk(make_basis(32, family), PER_NU * nu)
    mode = min(modes(round_film, family), key=lambda mode: abs(mode.eigenvalue))
    return morse_index(switch(round_film, mode, BESIDE).film)


def two_lobes() -> list[Statement]:
    """Return where the planar film of two lobes leaves its plane, and what that means."""
    flat = disk(make_basis(48, PLANAR, crowding=0.1), 3 * PER_NU)
    lobes = switch(flat, modes(flat, PLANAR)[0], BESIDE)
    before = resolve(go_to_load(lobes, 1850.0), tail=1e-10)
    after = go_to_load(before, 1860.0)
    nu = locate(before, after, TWISTED)[0].load / PER_NU
    counts = [morse_index(point.film) for point in (before, after)]
    wider = f"{100 * ((nu / 3) ** (1 / 3) - 1):.1f} %"
    claim, whose = "the planar film of two lobes leaves its plane", "Tiwari and Fried 2026"
    return [
        threshold(claim, whose, "3.7402", nu, 6),
        threshold(claim, "Majid, quoted there", "4.3790", nu, 6),
        Statement(
            claim="it is stable up to there only",
            whose=whose,
            theirs="3 < ν < 3.7402",
            converted="",
            here=f"unstable modes: {counts[0]} at σ̂ = 1850, {counts[1]} at 1860",
            agree="yes" if counts == [0, 1] else "no",
        ),
        Statement(
            claim="the loop's radius, when it does, over that when the disk gives way",
            whose=whose,
            theirs="+7.6 %",
            converted="",
            here=f"+{wider}",
            agree="yes" if wider == "7.6 %" else "no",
        ),
    ]


def rings_under_pressure() -> list[Statement]:
    """Return where a ring under pressure, or a flat film, touches itself."""
    whose, two = "Flaherty, Keller and Rubinow 1972", thresholds(2)
    # Of length 1, with heads of half their size at first: lambda = 1/2.
    film = planar_film(2, 8 * two.sigma_line_contact)
    straight = np.abs(film.curvature((np.arange(4000) + 0.5) / 4000)) < SAME
    # Two strands lie along the line of each of the two lobes.
    line = straight.mean() / 4
    return [
        threshold(
            "opposite sides of a ring under pressure touch in a point",
            whose,
            "5.247",
            two.sigma_contact / PER_NU,
            6,
        ),
        threshold(
            "they touch along a line",
            whose,
            "10.34",
            two.sigma_line_contact / PER_NU,
            6,
        ),
        Statement(
            claim="length of that line, in each of n lobes",
            whose="Djondjorov et al. 2011, quoted by Giomi",
            theirs="L(1 − λ)/n",
            converted="",
            here=f"{line:.4f} L for n = 2, λ = ½: L(1 − λ)/2n",
            agree="with Giomi: half of theirs",
        ),
    ]


def rackets() -> list[Statement]:
    """Return the size of the racket's head, in both readings of a surface tension."""
    load = thresholds(2).sigma_line_contact
    film, unit = planar_film(2, load), (2 / load) ** (1 / 3)

    def below(t: float) -> float:
        return -float(film.positions(t)[1])

    half = -minimize_scalar(below, bounds=(0, 0.25), method="bounded").fun
    head = np.array([float(film.positions(0.0)[0]), 2 * half]) / unit
    rigidity = YOUNG * pi * RADIUS**4 / 4
    sizes = [
        "{:.0f} × {:.0f} mm".format(*1e3 * head * (rigidity / tension) ** (1 / 3))
        for tension in (SURFACE_TENSION, 2 * SURFACE_TENSION)
    ]
    return [
        Statement(
            claim="the end loops have the shape of a similarity solution",
            whose="Mora et al. 2012",
            theirs="photographs",
            converted="",
            here="{:.4f} × {:.4f} (a/σ)^⅓; ".format(*head)
            + f"{sizes[0]} if 27.3 mN/m is the film's tension, {sizes[1]} if one face's",
            agree="not compared",
        )
    ]


def twisted_rings() -> list[Statement]:
    """Return how much twist a ring bears, with a film and without, by meshes."""
    meshes = [make_mesh(polygon={"kind": "circle"}, vertices=size) for size in SIZES]
    ring, light, heavy = (lost_to_twist(meshes, nu) for nu in (0.0, 1.0, 2.0))
    whose = "Biria and Fried 2015"
    return [
        Statement(
            claim="(C/B) Φ/2π at which a ring without a film is lost to its twist Φ",
            whose="Michell 1890",
            theirs="√3",
            converted="0",
            here=f"{ring:.4f}",
            agree=agreement(np.sqrt(3), ring),
        ),
        Statement(
            claim="twist destabilizes disks that are stable without",
            whose=whose,
            theirs="",
            converted="",
            here=f"(C/B) Φ/2π = {light:.4f} at ν = 1, {heavy:.4f} at ν = 2",
            agree="yes" if ring > light > heavy > 0 else "no",
        ),
        Statement(
            claim="it does not if perturbed only in their plane, or only across it",
            whose=whose,
            theirs="",
            converted="",
            here="the twist's second variation only mixes the two",
            agree="yes" if twist_only_mixes(meshes[0]) else "no",
        ),
    ]


def lost_to_twist(meshes: Sequence[Disk], nu: float) -> float:
    """Return (C / B) Phi / 2 pi at which the disk is lost, extrapolated from two meshes."""
    edges, values = np.array([[mesh.n_b, _lost_on(mesh, nu)] for mesh in meshes]).T
    weights = np.array([-1.0, 1.0]) * edges**2
    return float(weights @ values / weights.sum())


def _lost_on(mesh: Disk, nu: float) -> float:
    expected = np.sqrt((3 - nu) * (1 - nu / 6))

    def lowest(link: float) -> float:
        problem = Problem(mesh, "area", twist_ratio=1.0, link=link)
        energy = problem.film.of_loop(mesh.shape).energy(problem.loop, PER_NU * nu)
        return float(tangent_model(energy, mesh.shape.x_loop).eigenvalues[0])

    return float(brentq(lowest, 0.75 * expected, 1.1 * expected, xtol=1e-10))


def twist_only_mixes(mesh: Disk) -> bool:
    """Return whether a flat ring's twist couples planar with transverse displacements only.

    Of its second variation the blocks of either are then rounding.
    """
    twist = Problem(mesh, "area", twist_ratio=1.0, link=1.0).loop.terms["twist"]
    shape = (mesh.n_b, 3, mesh.n_b, 3)
    hessian = np.abs(twist.hessian(mesh.shape.x_loop).reshape(shape))
    own = max(hessian[:, :2, :, :2].max(), hessian[:, 2, :, 2].max())
    return bool(own < SAME * hessian.max())
