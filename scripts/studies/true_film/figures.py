"""Pictures of the true film's branches."""

from __future__ import annotations

from collections.abc import Mapping
from math import pi
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from eulerplateau.exact.conformal import ConformalFilm, flat_eight, surface
from eulerplateau.exact.planar import planar_film
from eulerplateau.mesh import Shape
from eulerplateau.pictures.figure import (
    BLACK,
    BLUE,
    GREEN,
    PAGE,
    SMALL,
    TEXT,
    VERMILION,
    frame,
    new_figure,
    save,
    scale_bar,
    write_below,
)
from eulerplateau.pictures.vector_film import draw_film

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

_LOAD = r"$\hat\sigma=\sigma L^3/\alpha$"
_COLOURS = {"two-lobed": BLUE, "twisted": VERMILION, "saddle": GREEN}
_RADII, _ANGLES = 24, 192
# Degrees from which films are seen, and the direction to there.
_ELEVATION, _AZIMUTH = 28.0, -62.0
_TO_EYE = np.array(
    [
        np.cos(np.radians(_ELEVATION)) * np.cos(np.radians(_AZIMUTH)),
        np.cos(np.radians(_ELEVATION)) * np.sin(np.radians(_AZIMUTH)),
        np.sin(np.radians(_ELEVATION)),
    ]
)
# A field's height over its width, and a bar in units of L.
_HEIGHT, _BAR = 0.6, 0.1
# How far along the way to the eye (in L) a loop is drawn in front of its film: enough to
# have its width where a film is seen aslant, too little for hidden strands to be seen.
_NEARER = 0.005
_DASHDOT = (0, (6, 1.5, 1, 1.5))
_HELD: dict[str, dict[str, Any]] = {
    "twisted": {"color": VERMILION, "linewidth": 1.4},
    "planar": {"color": BLUE, "linestyle": _DASHDOT, "linewidth": 0.9},
    "on to the eight": {"color": "0.4", "linestyle": ":", "linewidth": 0.9},
    "planar, not held": {
        "color": BLUE, "linestyle": "none", "marker": "o", "ms": 4, "mfc": "none"
    },
}  # fmt: skip
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
    figure = new_figure(PAGE, 3.3)
    left, right = figure.subplots(1, 2)
    loads = np.linspace(700, 2100, 141)
    eight = np.array([flat_eight(load).energy for load in loads])
    disk = loads / (4 * pi) + 4 * pi**2
    lobes = np.array([planar_film(2, load).energy for load in loads])
    _split(left, loads, disk - eight, 48 * pi**3, "0.7", "disk", below=True)
    buckled = loads > 48 * pi**3
    _split(left, loads[buckled], (lobes - eight)[buckled], onset, BLUE, "two lobes", True)
    twisted = [r for r in rows if r.branch == "twisted"]
    x = [onset, *(r.sigma_hat for r in twisted)]
    y = [planar_film(2, onset).energy - flat_eight(onset).energy]
    y += [r.energy - flat_eight(r.sigma_hat).energy for r in twisted]
    left.plot(x, y, linestyle=_DASHDOT, color=VERMILION, label="twisted (index 1)")
    left.axhline(0, color=BLACK, label="flat eight, pinched (stable)")
    left.set(
        xlabel=_LOAD, ylabel=r"$(E-E_8)\,/\,(\alpha/L)$", ylim=(-9, 9), xlim=(700, 2100)
    )
    saddles = [r for r in rows if r.branch == "saddle"]
    x2 = np.array([r.sigma_hat for r in saddles])
    base = x2 / (4 * pi) + 4 * pi**2
    wide = np.linspace(2400, 7000, 100)
    right.axhline(0, ls=":", color="0.7", label="disk (index 2, 4, ...)")
    right.plot(
        x2,
        [r.energy for r in saddles] - base,
        linestyle=_DASHDOT,
        color=GREEN,
        label="saddle (index 2, then 4)",
    )
    two = [planar_film(2, s).energy - s / (4 * pi) - 4 * pi**2 for s in wide]
    right.plot(wide, two, color=BLUE, ls="--", label="two lobes, planar")
    right.axvline(96 * pi**3, color="0.8", lw=0.8, zorder=0, label=r"$96\,\pi^3$")
    right.set(xlabel=_LOAD, ylabel=r"$(E-E_{\rm disk})\,/\,(\alpha/L)$")
    for ax in (left, right):
        frame(ax)
        ax.legend(frameon=False, fontsize=SMALL)
    save(figure, path)


def draw_waist(path: Path, rows: Any, onset: float, held: Any) -> None:
    """Draw the waist over the load, and energies over the waist at fixed loads."""
    figure = new_figure(PAGE, 3.3)
    left, right = figure.subplots(1, 2)
    # The waist falls from the disk's as the root of the load: even steps in that.
    loads = 48 * pi**3 + 1e-6 + (2100 - 48 * pi**3) * np.linspace(0, 1, 60) ** 2
    widths = np.array([2 * planar_film(2, s).positions(0.25)[1] for s in loads])
    _split(left, loads, widths, onset, BLUE, "two lobes", below=True)
    twisted = [r for r in rows if r.branch == "twisted"]
    x = [onset, *(r.sigma_hat for r in twisted)]
    y = [2 * float(planar_film(2, onset).positions(0.25)[1]), *(r.waist for r in twisted)]
    left.plot(x, y, linestyle=_DASHDOT, color=VERMILION, label="twisted (index 1)")
    left.set(xlabel=_LOAD, ylabel=r"waist $w/L$", yscale="log", xlim=(680, 2110))
    for land in held:
        _draw_held(right, land)
    right.plot(0, 0, "s", color=BLACK, ms=4)
    right.set(
        xlabel=r"waist $w/L$, held", ylabel=r"$(E-E_8)\,/\,(\alpha/L)$", xlim=(-0.008, 0.41)
    )
    right.set(ylim=(-15, 11))
    for ax in (left, right):
        frame(ax)
    left.legend(frameon=False, fontsize=SMALL)
    right.legend(handles=_held_handles(), frameon=False, fontsize=SMALL, loc="lower left")
    save(figure, path)


def _draw_held(ax: Axes, land: Any) -> None:
    """Draw the energies of films at one load over the waists at which they are held."""
    zero = flat_eight(land.load).energy
    energies, planar = (
        np.array(values) - zero for values in (land.energies, land.planar_energies)
    )
    ax.plot(land.waists, energies, **_HELD["twisted"])
    ax.plot([0, land.waists[0]], [0, energies[0]], **_HELD["on to the eight"])
    ax.plot(land.planar_waists, planar, **_HELD["planar"])
    ax.plot(land.planar_waists[0], planar[0], **_HELD["planar, not held"])
    ax.annotate(
        rf"$\hat\sigma={land.load:.0f}$",
        (land.planar_waists[0], planar[0]),
        xytext=(4, 3),
        textcoords="offset points",
        fontsize=SMALL,
    )


def _held_handles() -> list[Artist]:
    from matplotlib.lines import Line2D

    eight = Line2D([], [], marker="s", linestyle="none", color=BLACK, ms=4)
    eight.set_label("flat eight")
    return [*(Line2D([], [], **look, label=name) for name, look in _HELD.items()), eight]


def draw_shapes(path: Path, films: dict[str, list[ConformalFilm]]) -> None:
    """Draw films in space, all at one scale."""
    chosen = [
        (name, min(films[name], key=lambda film: abs(film.load - load)))
        for name, load in _SHOWN
    ]
    draw_films(
        path,
        {rf"{name}, $\hat\sigma={film.load:.0f}$": film for name, film in chosen},
        lines=2,
    )


def draw_films(path: Path, films: Mapping[str, ConformalFilm], lines: int) -> None:
    """Draw films by their titles, from one side at one scale, in so many lines."""
    shapes = [triangulated(film) for film in films.values()]
    seen = [shape.x - shape.x.mean(axis=0) for shape in shapes]
    half = 1.06 * max(float(np.linalg.norm(x, axis=1).max()) for x in seen)
    size = half, _HEIGHT * half
    columns = -(-len(shapes) // lines)
    width = PAGE / columns
    figure = new_figure(PAGE, lines * (_HEIGHT * width + 0.3) + 0.3)
    axes = figure.subplots(lines, columns, squeeze=False)
    for ax, title, shape, x in zip(axes.flat, films, shapes, seen, strict=True):
        draw_film(ax, _loop_in_front(shape.moved(x)), _TO_EYE, size)
        ax.set_title(title, fontsize=TEXT)
    scale_bar(axes[0, 0], _BAR)
    note = f"seen from {_ELEVATION:.0f}° above the plane of flat films; bar: {_BAR:g} L"
    write_below(figure, note)
    save(figure, path)


def _loop_in_front(shape: Shape) -> Shape:
    """Return a shape whose loop is a little nearer to the eye than the film it bounds."""
    count, nearer = len(shape.x), shape.x_loop + _NEARER * _TO_EYE
    loop = np.arange(count, count + len(nearer))
    return Shape(np.concatenate([shape.x, nearer]), shape.triangles, loop)


def triangulated(film: ConformalFilm) -> Shape:
    """Return a film as triangles, fine enough to be drawn: rings about its centre."""
    whole = surface(film)
    points = whole.points
    # Even steps of the loop's own parameter: the film's ends are crowded in theta.
    phi = 2 * pi * np.arange(_ANGLES) / _ANGLES
    theta = film.basis.grading.theta(phi) % (2 * pi)
    index = np.round(theta / (2 * pi) * points).astype(int) % points
    rings = [whole.at(float(r), points)[index] for r in np.linspace(0, 1, _RADII + 1)[1:]]
    centre = whole.at(0.0, points)[:1]
    place = np.arange(_RADII * _ANGLES).reshape(_RADII, _ANGLES) + 1
    after = np.roll(place, -1, axis=1)
    fan = np.stack([np.zeros(_ANGLES, dtype=int), place[0], after[0]], axis=1)
    inner = np.stack([place[:-1], place[1:], after[1:]], axis=-1)
    outer = np.stack([place[:-1], after[1:], after[:-1]], axis=-1)
    triangles = np.concatenate([fan, inner.reshape(-1, 3), outer.reshape(-1, 3)])
    return Shape(np.concatenate([centre, *rings]), triangles, place[-1])


def _split(
    ax: Axes, x: Any, y: Any, onset: float, colour: str, label: str, below: bool
) -> None:
    """Draw a branch solid on its stable side of an onset and dashed on the other."""
    stable = x <= onset if below else x >= onset
    ax.plot(x[stable], y[stable], color=colour, label=f"{label} (stable)")
    ax.plot(x[~stable], y[~stable], "--", color=colour, label=f"{label} (unstable)")
    ax.plot(onset, np.interp(onset, x, y), "o", color=colour, ms=4)
