"""Figures of exact planar films: their shapes at several loads, and their energies."""

from __future__ import annotations

from math import pi, sqrt
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from eulerplateau.exact.planar import (
    PlanarFilm,
    Regime,
    Thresholds,
    planar_film,
    thresholds,
)
from eulerplateau.pictures.figure import (
    BLACK,
    BLUE,
    PAGE,
    SMALL,
    TEXT,
    VERMILION,
    drawn,
    frame,
    new_figure,
    save,
    scale_bar,
    write_below,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

GALLERY, ENERGY = "planar-gallery.png", "planar-energy.png"

_LOAD = r"$\hat\sigma=\sigma L^3/\alpha$"
# Half the length of the longest film, and a margin.
_HALF_WIDTH = 0.26
_BAR = 0.1
_FILM, _ROD = "#CFE3F2", BLACK
_COLUMNS = (
    "near threshold",
    "buckled",
    "first contact",
    "line contact begins",
    "line contact",
)
# The loads of columns one and two, as a part of the way to the first contact, and of the
# last column, over the onset of line contact.
_EARLY, _MIDDLE, _LATE = 0.05, 0.4, 5.0
_COLOURS, _MARKERS = {2: BLUE, 3: VERMILION}, {2: "o", 3: "s"}
_STYLES: dict[Regime, Any] = {
    Regime.BUCKLED: "-",
    Regime.POINT_CONTACT: (0, (5, 1.5)),
    Regime.LINE_CONTACT: (0, (1.2, 1.2)),
}


def draw_figures(folder: Path) -> bool:
    """Draw both figures to `folder`; return whether they were drawn, and log why not."""
    gallery, energy = folder / GALLERY, folder / ENERGY
    done = drawn(str(gallery), lambda: plot_gallery(gallery))
    return drawn(str(energy), lambda: plot_energy(energy)) and done


def plot_gallery(path: Path) -> None:
    """Draw the films with 2 ... 5 lobes at five loads (paper, fig. gallery), at one scale.

    Raises OutputError if the PNG file `path` cannot be written.
    """
    heights = {2: 0.13, 3: 0.185, 4: 0.185, 5: 0.185}
    figure = new_figure(PAGE, 5.0)
    axes = figure.subplots(
        len(heights), len(_COLUMNS), height_ratios=list(heights.values())
    )
    for row, (n, height) in zip(axes, heights.items(), strict=True):
        for ax, load in zip(row, _gallery_loads(thresholds(n)), strict=True):
            _draw_film(ax, planar_film(n, load), (_HALF_WIDTH, height))
            _write(ax, (0.5, -0.14), rf"$\hat\sigma={_readable(load)}$", SMALL)
        _write(row[0], (-0.1, 0.5), rf"$n={n}$", TEXT)
    for ax, name in zip(axes[0], _COLUMNS, strict=True):
        _write(ax, (0.5, 1.2), name, TEXT)
    scale_bar(axes[0, 0], _BAR)
    write_below(figure, f"all at one scale; bar: {_BAR:g} L")
    save(figure, path)


def plot_energy(path: Path) -> None:
    """Draw the energy of two- and three-lobed films over the load (paper, fig. energy).

    Raises OutputError if the PNG file `path` cannot be written.
    """
    figure = new_figure(PAGE, 4.9)
    ax = figure.subplots()
    low, high = 500.0, 1.5e5
    loads = np.geomspace(low, high, 200)
    ax.plot(loads, loads / (4 * pi) + 4 * pi**2, "--", color="0.5", label="disk")
    for n, colour in _COLOURS.items():
        _draw_energies(ax, thresholds(n), high, colour)
    ax.plot([], [], "o", color="0.3", markersize=4, label="threshold of what follows")
    open_ones: Any = {"color": "0.3", "markersize": 5, "fillstyle": "none"}
    ax.plot([], [], "o", **open_ones, label="shape beside the curve")
    ax.set(xscale="log", yscale="log", xlim=(low, high), ylim=(60, 1.3e4))
    ax.set_xlabel(_LOAD)
    ax.set_ylabel(r"$E\,/\,(\alpha/L)$")
    frame(ax)
    ax.legend(loc="upper left", frameon=False, fontsize=SMALL)
    save(figure, path)


def _gallery_loads(limits: Thresholds) -> tuple[float, ...]:
    start, contact = limits.sigma_buckling, limits.sigma_contact
    free = [start + part * (contact - start) for part in (_EARLY, _MIDDLE)]
    line = limits.sigma_line_contact
    return (*free, contact, line, _LATE * line)


def _readable(load: float) -> str:
    return f"{load:,.0f}".replace(",", r"\,")


def _write(ax: Axes, place: tuple[float, float], text: str, size: float) -> None:
    ax.annotate(
        text, place, xycoords="axes fraction", ha="center", va="center", fontsize=size
    )


def _draw_film(
    ax: Axes, film: PlanarFilm, room: tuple[float, float], width: float = 1.3
) -> None:
    """Draw the film in a rectangle of half sides `room`; a tip points up if n > 2."""
    x = film.positions(np.linspace(0, 1, 1 + 240 * film.lobes))
    x = np.stack([-x[:, 1], x[:, 0]], -1) if film.lobes > 2 else x
    ax.fill(*x.T, color=_FILM, linewidth=0)
    ax.plot(*x.T, color=_ROD, linewidth=width, solid_joinstyle="round")
    ax.set(xlim=(-room[0], room[0]), ylim=(-room[1], room[1]), aspect="equal")
    ax.set_axis_off()


def _draw_energies(ax: Axes, limits: Thresholds, high: float, colour: str) -> None:
    corners = {
        Regime.BUCKLED: (limits.sigma_buckling, limits.sigma_contact),
        Regime.POINT_CONTACT: (limits.sigma_contact, limits.sigma_line_contact),
        Regime.LINE_CONTACT: (limits.sigma_line_contact, high),
    }
    for regime, (start, end) in corners.items():
        loads = np.geomspace(start, end, 60)
        energies = [planar_film(limits.lobes, load).energy for load in loads]
        label = f"n = {limits.lobes}, {regime.value.replace('-', ' ')}"
        ax.plot(loads, energies, color=colour, linestyle=_STYLES[regime], label=label)
        ax.plot(start, energies[0], _MARKERS[limits.lobes], color=colour, markersize=4)
        _draw_inset(ax, planar_film(limits.lobes, sqrt(start * end)), colour)


def _draw_inset(ax: Axes, film: PlanarFilm, colour: str) -> None:
    """Mark the film on its curve and draw its shape: below for n = 2, above for n = 3."""
    marker = _MARKERS[film.lobes]
    ax.plot(film.tension, film.energy, marker, color=colour, markersize=5, fillstyle="none")
    # Further off where the disk's line is close.
    distance = 2.0 if film.regime is Regime.BUCKLED else 1.55
    height = film.energy * (distance if film.lobes > 2 else 1 / distance)
    # Half an inset's width and height, as factors on the logarithmic axes.
    wide, high = 1.45, 1.6
    left, below = film.tension / wide, height / high
    inset = ax.inset_axes(
        (left, below, film.tension * wide - left, height * high - below),
        transform=ax.transData,
    )
    _draw_film(inset, film, (_HALF_WIDTH, _HALF_WIDTH), 0.9)
