"""Pictures of docs/welded-loop.md."""

from __future__ import annotations

from math import pi
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from eulerplateau.branches.conformal import Start, rod_film
from eulerplateau.exact.conformal import BUCKLING, flat_eight
from eulerplateau.pictures.figure import (
    BLACK,
    BLUE,
    GREEN,
    PAGE,
    VERMILION,
    frame,
    new_figure,
    save,
)
from eulerplateau.pictures.looks import legend_above, tagged
from scripts.studies.true_film.figures import draw_films
from scripts.studies.welded_loop.answers import ISOTROPIC, Load, disk_link
from scripts.studies.welded_loop.curves import Row

if TYPE_CHECKING:
    from matplotlib.artist import Artist

_LOAD = r"$\hat\sigma=\sigma L^3/\alpha$"
_LINKS = (0.25, 0.4, 0.5)
_SHOWN = 1700.0
_MAP = 14.0 / 2.54
_KINDS: dict[str, dict[str, Any]] = {
    "stable": {"linestyle": "-", "linewidth": 1.2},
    "unstable": {"linestyle": "--", "linewidth": 0.9},
    "pinched eight": {"linestyle": ":", "linewidth": 0.9},
}
# Energies that are shown, above the flat film's, by load.
_ENERGIES = {1000.0: (-2.0, 48.0), 1700.0: (-4.0, 10.0)}


def draw_energies(path: Path, curves: dict[float, list[Row]], loads: Any) -> None:
    """Draw energies over the link, less the flat film's, with the pinched eight's."""
    figure = new_figure(PAGE, 3.3)
    panels = figure.subplots(1, len(loads))
    for ax, load in zip(panels, loads, strict=True):
        rows = curves[load]
        for number, ratio in enumerate((0.2, *ISOTROPIC)):
            _energy_curve(ax, rows, ratio, tagged(number))
        ax.set(xlabel="link $Lk$, turns", title=rf"$\hat\sigma={load:.0f}$")
        ax.set(xlim=(0, 1.4), ylim=_ENERGIES[load])
        ax.set_ylabel(r"$E-E(\mathrm{flat,\ no\ twist})\,/\,(\alpha/L)$")
        frame(ax)
    legend_above(figure, _energy_handles())
    save(figure, path)


def _energy_handles() -> list[Artist]:
    from matplotlib.lines import Line2D

    rods = [
        Line2D([], [], **{**tagged(number), "markevery": None}, label=f"$C/B={ratio:.3g}$")
        for number, ratio in enumerate((0.2, *ISOTROPIC))
    ]
    kinds = [
        Line2D([], [], color="0.3", **look, label=name) for name, look in _KINDS.items()
    ]
    return [*rods, *kinds]


def _energy_curve(ax: Any, rows: list[Row], ratio: float, looks: dict[str, Any]) -> None:
    """Draw one rod's films, solid where stable, and the pinched eight, dotted."""
    links = np.array([row.link(ratio) for row in rows])
    flat = rows[0].energy - rows[0].writhe * 2 * pi * rows[0].moment
    totals = np.array([row.total(ratio) for row in rows]) - flat
    stable = np.array([not row.index and ratio > row.ratio for row in rows])
    curves = [
        ("stable", links, np.where(stable, totals, np.nan)),
        ("unstable", links, np.where(stable, np.nan, totals)),
    ]
    turned = np.linspace(0.0, 1.5, 151)
    if rows[0].load < BUCKLING:
        disk = 4 * pi**2 * ratio * turned**2
        kept = turned < disk_link(rows[0].load, ratio)
        curves.append(("stable", turned, np.where(kept, disk, np.nan)))
        curves.append(("unstable", turned, np.where(kept, np.nan, disk)))
    pinched = flat_eight(rows[0].load).energy - flat + 4 * pi**2 * ratio * (turned - 1) ** 2
    curves.append(("pinched eight", turned, pinched))
    for kind, x, y in curves:
        # Markers cannot be spread along a curve of which there is nothing.
        if np.isfinite(y).any():
            ax.plot(x, y, **looks, **_KINDS[kind])


def draw_map(path: Path, answers: list[Load], disk: list[tuple[float, float]]) -> None:
    """Draw which rods keep flat films, and which have one stable film for every link."""
    figure = new_figure(_MAP, 3.6)
    ax = figure.subplots()
    loads = [answer.load for answer in answers]
    lobes = [answer for answer in answers if answer.flat > -1 and answer.load > 1800]
    ax.plot(loads, [a.every for a in answers], color=BLUE, label="above: one film a link")
    ax.plot(
        [a.load for a in lobes],
        [a.flat for a in lobes],
        color=VERMILION,
        linestyle=(0, (6, 1.5, 1, 1.5)),
        label="above: flat lobes are stable",
    )
    ax.plot(
        loads,
        [a.twisted for a in answers],
        color=GREEN,
        linestyle=(0, (1.5, 1.2)),
        label="below: welded straight, a twisted film is stable",
    )
    ax.plot(
        *zip(*disk, strict=True), "--", color=BLACK, label="above: the disk yields softly"
    )
    ax.axhspan(*ISOTROPIC, color="0.9", zorder=0, label="isotropic rods")
    ax.set(xlabel=_LOAD, ylabel="$C/B$", ylim=(0, 1.5))
    frame(ax)
    ax.set(ylim=(0, 1.5))
    legend_above(figure, ax.get_legend_handles_labels()[0])
    save(figure, path)


def draw_shapes(path: Path) -> None:
    """Draw stable films of an isotropic rod that was turned."""
    found = [rod_film(Start.LOBES, _SHOWN, ISOTROPIC[0], link) for link in _LINKS]
    titles = [
        f"$Lk={link:g}$, $Wr={film.writhe:.3f}$"
        for link, film in zip(_LINKS, found, strict=True)
    ]
    films = {title: film.film for title, film in zip(titles, found, strict=True)}
    draw_films(path, films, lines=1)
