"""Pictures of docs/welded-loop.md."""

from __future__ import annotations

from math import pi
from pathlib import Path
from typing import Any

import numpy as np

from eulerplateau.branches.conformal import Start, rod_film
from eulerplateau.exact.conformal import BUCKLING, flat_eight
from eulerplateau.pictures.figure import BLACK, BLUE, GREEN, ORANGE, VERMILION, frame, save
from scripts.studies.true_film.figures import draw_surface
from scripts.studies.welded_loop.answers import ISOTROPIC, Load, disk_link
from scripts.studies.welded_loop.curves import Row

_LOAD = r"$\hat\sigma=\sigma L^3/\alpha$"
_LINKS = (0.25, 0.4, 0.5)
_SHOWN = 1700.0
# Energies that are shown, above the flat film's, by load.
_ENERGIES = {1000.0: (-2.0, 48.0), 1700.0: (-4.0, 10.0)}


def draw_energies(path: Path, curves: dict[float, list[Row]], loads: Any) -> None:
    """Draw energies over the link, less the flat film's, with the pinched eight's."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10, 4.2), layout="constrained")
    panels = figure.subplots(1, len(loads))
    for ax, load in zip(panels, loads, strict=True):
        rows = curves[load]
        for ratio, colour in zip((0.2, *ISOTROPIC), (ORANGE, BLUE, GREEN), strict=True):
            _energy_curve(ax, rows, ratio, colour)
        ax.set(xlabel="link $Lk$, turns", title=rf"$\hat\sigma={load:.0f}$")
        ax.set(xlim=(0, 1.4), ylim=_ENERGIES[load])
        ax.set_ylabel(r"$E-E(\mathrm{flat,\ no\ twist})\,/\,(\alpha/L)$")
        frame(ax)
    panels[1].legend(frameon=False, fontsize=8, title="$C/B$")
    save(figure, path)


def _energy_curve(ax: Any, rows: list[Row], ratio: float, colour: str) -> None:
    """Draw one rod's films, solid where stable, and the pinched eight, dotted."""
    links = np.array([row.link(ratio) for row in rows])
    flat = rows[0].energy - rows[0].writhe * 2 * pi * rows[0].moment
    totals = np.array([row.total(ratio) for row in rows]) - flat
    stable = np.array([not row.index and ratio > row.ratio for row in rows])
    ax.plot(links, np.where(stable, totals, np.nan), color=colour, label=f"{ratio:.3g}")
    ax.plot(links, np.where(stable, np.nan, totals), "--", color=colour, lw=1)
    turned = np.linspace(0.0, 1.5, 151)
    if rows[0].load < BUCKLING:
        disk = 4 * pi**2 * ratio * turned**2
        kept = turned < disk_link(rows[0].load, ratio)
        ax.plot(turned[kept], disk[kept], color=colour, lw=1)
        ax.plot(turned[~kept], disk[~kept], "--", color=colour, lw=1)
    pinched = flat_eight(rows[0].load).energy - flat + 4 * pi**2 * ratio * (turned - 1) ** 2
    ax.plot(turned, pinched, ":", color=colour, lw=1)


def draw_map(path: Path, answers: list[Load], disk: list[tuple[float, float]]) -> None:
    """Draw which rods keep flat films, and which have one stable film for every link."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 4.4), layout="constrained")
    ax = figure.subplots()
    loads = [answer.load for answer in answers]
    lobes = [answer for answer in answers if answer.flat > -1 and answer.load > 1800]
    ax.plot(loads, [a.every for a in answers], color=BLUE, label="above: one film a link")
    ax.plot(
        [a.load for a in lobes],
        [a.flat for a in lobes],
        color=VERMILION,
        label="above: flat lobes are stable",
    )
    ax.plot(
        loads,
        [a.twisted for a in answers],
        color=GREEN,
        label="below: welded straight, a twisted film is stable",
    )
    ax.plot(
        *zip(*disk, strict=True), "--", color=BLACK, label="above: the disk yields softly"
    )
    ax.axhspan(*ISOTROPIC, color="0.9", zorder=0)
    ax.set(xlabel=_LOAD, ylabel="$C/B$", ylim=(0, 1.5))
    ax.legend(frameon=False, fontsize=8)
    frame(ax)
    save(figure, path)


def draw_shapes(path: Path) -> None:
    """Draw stable films of an isotropic rod that was turned."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10, 2.4), layout="constrained")
    for number, link in enumerate(_LINKS, start=1):
        found = rod_film(Start.LOBES, _SHOWN, ISOTROPIC[0], link)
        ax: Any = figure.add_subplot(1, len(_LINKS), number, projection="3d")
        draw_surface(ax, found.film)
        ax.set_title(f"$Lk={link:g}$, $Wr={found.writhe:.3f}$", fontsize=10)
    save(figure, path)
