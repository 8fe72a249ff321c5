"""Pictures of the true film's branches."""

from __future__ import annotations

from math import pi
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.conformal import ConformalFilm, flat_eight, surface
from eulerplateau.exact.planar import planar_film
from eulerplateau.pictures.figure import BLACK, BLUE, GREEN, ORANGE, VERMILION, frame, save

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LOAD = r"$\hat\sigma=\sigma L^3/\alpha$"
_COLOURS = {"two-lobed": BLUE, "twisted": VERMILION, "saddle": GREEN}
_RADII, _ANGLES = 24, 192
# Degrees from which films are seen, the direction to there, and how far along it (in L) a
# loop is drawn in front of its film.
_ELEVATION, _AZIMUTH, _NEARER = 28.0, -62.0, 0.025
_TO_EYE = np.array(
    [
        np.cos(np.radians(_ELEVATION)) * np.cos(np.radians(_AZIMUTH)),
        np.cos(np.radians(_ELEVATION)) * np.sin(np.radians(_AZIMUTH)),
        np.sin(np.radians(_ELEVATION)),
    ]
)
# Films in the gallery: branch and load.
_SHOWN = (
    ("two-lobed", 1800.0),
    ("twisted", 1800.0),
    ("twisted", 1500.0),
    ("twisted", 1000.0),
    ("saddle", 3400.0),
    ("saddle", 5000.0),
)


def draw_all(
    folder: Path,
    films: dict[str, list[ConformalFilm]],
    rows: Any,
    onset: float,
    held: Any,
) -> None:
    """Draw every figure of docs/true-film.md to a folder.

    `onset` is where the twisted branch leaves the planar one; `rows` and `held` are those
    of the command.
    """
    folder.mkdir(parents=True, exist_ok=True)
    draw_branches(folder / "branches.png", rows, onset)
    draw_waist(folder / "waist.png", rows, onset, held)
    draw_shapes(folder / "shapes.png", films)


def draw_branches(path: Path, rows: Any, onset: float) -> None:
    """Draw the energies over the load, less the flat eight's or the disk's."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10, 4.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    loads = np.linspace(700, 2100, 141)
    eight = np.array([flat_eight(load).energy for load in loads])
    disk = loads / (4 * pi) + 4 * pi**2
    lobes = np.array([planar_film(2, load).energy for load in loads])
    _split(left, loads, disk - eight, 48 * pi**3, "0.45", "disk", below=True)
    buckled = loads > 48 * pi**3
    _split(left, loads[buckled], (lobes - eight)[buckled], onset, BLUE, "two lobes", True)
    twisted = [r for r in rows if r.branch == "twisted"]
    x = [onset, *(r.sigma_hat for r in twisted)]
    y = [planar_film(2, onset).energy - flat_eight(onset).energy]
    y += [r.energy - flat_eight(r.sigma_hat).energy for r in twisted]
    left.plot(x, y, "--", color=VERMILION, label="twisted (index 1)")
    left.axhline(0, color=BLACK, label="flat eight, pinched (stable)")
    left.set(
        xlabel=_LOAD, ylabel=r"$(E-E_8)\,/\,(\alpha/L)$", ylim=(-9, 9), xlim=(700, 2100)
    )
    saddles = [r for r in rows if r.branch == "saddle"]
    x2 = np.array([r.sigma_hat for r in saddles])
    base = x2 / (4 * pi) + 4 * pi**2
    wide = np.linspace(2400, 7000, 100)
    right.axhline(0, ls=":", color="0.45", label="disk (index 2, 4, ...)")
    right.plot(
        x2,
        [r.energy for r in saddles] - base,
        "--",
        color=GREEN,
        label="saddle (index 2, then 4)",
    )
    two = [planar_film(2, s).energy - s / (4 * pi) - 4 * pi**2 for s in wide]
    right.plot(wide, two, color=BLUE, ls="--", label="two lobes, planar")
    right.axvline(96 * pi**3, color="0.8", lw=0.8, zorder=0)
    right.set(xlabel=_LOAD, ylabel=r"$(E-E_{\rm disk})\,/\,(\alpha/L)$")
    for ax in (left, right):
        frame(ax)
        ax.legend(frameon=False, fontsize=8)
    save(figure, path)


def draw_waist(path: Path, rows: Any, onset: float, held: Any) -> None:
    """Draw the waist over the load, and energies over the waist at fixed loads."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10, 4.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    loads = np.linspace(48 * pi**3 + 1e-6, 2100, 60)
    widths = np.array([2 * planar_film(2, s).positions(0.25)[1] for s in loads])
    _split(left, loads, widths, onset, BLUE, "two lobes", below=True)
    twisted = [r for r in rows if r.branch == "twisted"]
    x = [onset, *(r.sigma_hat for r in twisted)]
    y = [2 * float(planar_film(2, onset).positions(0.25)[1]), *(r.waist for r in twisted)]
    left.plot(x, y, "--", color=VERMILION, label="twisted (index 1)")
    left.set(xlabel=_LOAD, ylabel=r"waist $w/L$", yscale="log", xlim=(680, 2110))
    colours = [BLACK, BLUE, GREEN, ORANGE, VERMILION, "0.5"]
    for land, colour in zip(held, colours, strict=True):
        zero = flat_eight(land.load).energy
        energies = np.array(land.energies) - zero
        right.plot(land.waists, energies, color=colour, label=f"{land.load:.0f}")
        right.plot([0, land.waists[0]], [0, energies[0]], ":", color=colour, lw=0.9)
        planar = np.array(land.planar_energies) - zero
        right.plot(land.planar_waists, planar, "-.", color=colour, lw=0.9)
        right.plot(land.planar_waists[0], planar[0], "o", color=colour, ms=5, mfc="none")
    right.plot(0, 0, "s", color=BLACK, ms=5)
    right.set(
        xlabel=r"waist $w/L$, held", ylabel=r"$(E-E_8)\,/\,(\alpha/L)$", xlim=(-0.005, 0.33)
    )
    right.set(ylim=(-15, 10))
    right.legend(frameon=False, fontsize=8, title=_LOAD, ncols=2)
    left.legend(frameon=False, fontsize=8)
    frame(left)
    frame(right)
    save(figure, path)


def draw_shapes(path: Path, films: dict[str, list[ConformalFilm]]) -> None:
    """Draw films in space, all at one scale."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10, 5), layout="constrained")
    for number, (branch, load) in enumerate(_SHOWN, start=1):
        film = min(films[branch], key=lambda f: abs(f.load - load))
        ax: Any = figure.add_subplot(2, 3, number, projection="3d")
        draw_surface(ax, film)
        ax.set_title(rf"{branch}, $\hat\sigma={film.load:.0f}$", fontsize=10)
    save(figure, path)


def draw_surface(ax: Any, film: ConformalFilm) -> None:
    """Draw a film in space, its loop in front of it, at the scale of all of them."""
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    whole = surface(film)
    radii = np.linspace(1e-3, 1, _RADII)
    points = whole.points
    rings = np.stack([whole.at(float(r), points) for r in radii])
    # Even steps of the loop's own parameter: the film's ends are crowded in theta.
    phi = 2 * pi * np.arange(_ANGLES + 1) / _ANGLES
    theta = film.basis.grading.theta(phi) % (2 * pi)
    index = np.round(theta / (2 * pi) * points).astype(int) % points
    grid = rings[:, index]
    corners = [grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]]
    quads = np.stack(corners, axis=2).reshape(-1, 4, 3)
    colours = _shaded(quads)
    # The loop's pieces are polygons too, so that all are drawn in the order of their depth;
    # a little nearer to the eye than the film they bound.
    loop = grid[-1] + _NEARER * _TO_EYE
    pieces = np.stack([loop[:-1], loop[1:], loop[1:], loop[:-1]], axis=1)
    black = np.tile([0.0, 0.0, 0.0, 1.0], (len(pieces), 1))
    ax.add_collection3d(
        Poly3DCollection(
            np.concatenate([quads, pieces]),
            facecolors=np.concatenate([colours, black]),
            edgecolors=np.concatenate([colours, black]),
            linewidths=1.0,  # one for all: matplotlib sorts colours by depth, not widths
        )
    )
    half = 0.215
    ax.set(xlim=(-half, half), ylim=(-half, half), zlim=(-half / 2, half / 2))
    ax.set_box_aspect((2, 2, 1), zoom=1.45)
    ax.view_init(elev=_ELEVATION, azim=_AZIMUTH)
    ax.set_axis_off()


def _shaded(quads: FloatArray) -> FloatArray:
    """Return the colours (n, 4) of quadrilaterals (n, 4, 3), lighter towards the light."""
    normals = np.cross(quads[:, 2] - quads[:, 0], quads[:, 3] - quads[:, 1])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    light = np.array([0.3, -0.5, 0.8]) / np.sqrt(0.98)
    brightness = 0.55 + 0.45 * np.abs(normals @ light)
    shade = np.array([0.749, 0.851, 0.933])
    return np.column_stack([brightness[:, None] * shade, np.ones(len(quads))])


def _split(
    ax: Axes, x: Any, y: Any, onset: float, colour: str, label: str, below: bool
) -> None:
    """Draw a branch solid on its stable side of an onset and dashed on the other."""
    stable = x <= onset if below else x >= onset
    ax.plot(x[stable], y[stable], color=colour, label=f"{label} (stable)")
    ax.plot(x[~stable], y[~stable], "--", color=colour, label=f"{label} (unstable)")
    ax.plot(onset, np.interp(onset, x, y), "o", color=colour, ms=5)
