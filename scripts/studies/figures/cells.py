"""The paper's figures of cells, from exact cells; polygons are drawn as circles."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.cells import Cell, regular_sites, solve_cell
from eulerplateau.exact.cell import (
    RegularCell,
    cell_radius,
    fold_line,
    folds,
    inflection_stiffness,
    inflections,
    interpolated_radius,
    parabola,
    parabola_kappa_adhesion,
    parabola_traction,
    quartic_side,
    reconnection,
    regular_cell,
    smooth_cells,
    star,
    symmetry_lost,
)
from eulerplateau.loop import edges_of
from eulerplateau.pictures.figure import (
    BLACK,
    BLUE,
    COLUMN,
    GREEN,
    ORANGE,
    PAGE,
    SMALL,
    VERMILION,
    frame,
    new_figure,
    save,
)
from eulerplateau.pictures.phase_diagram import phase_figure
from eulerplateau.runs import load_cell_run, run_phase_diagram
from scripts.studies.cell_transitions.located import lost_at_stiffness
from scripts.studies.common import ROOT
from scripts.studies.figures.numbers import Number

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SIGMA, K_S = r"$\hat\sigma=\sigma R_0^3/\alpha$", r"$\hat k_s=k_sR_0^3/\alpha$"
# The cell of fig. geometry, and the polygon drawn beside it.
LOAD, STIFFNESS, EDGES = 10.0, 50.0, 32
# By which curves are told apart, in colour and in grey.
TAGS: tuple[dict[str, Any], ...] = tuple(
    {"color": colour, "marker": marker, "markevery": 8, "markersize": 3.2}
    for colour, marker in ((BLUE, "^"), (GREEN, "s"), (VERMILION, "D"))
)
_DASHDOT = (0, (6, 1.5, 1, 1.5))
# The paper's smooth muscle cells: sigma and alpha / R_0^3, both in nN/um.
MUSCLE = 1.05, 0.16


def draw_geometry(path: Path) -> list[Number]:
    """Draw curvature, angle, perimeter and kappa_0; the paper gives no number."""
    figure = new_figure(PAGE, 5.4)
    axes = figure.subplots(2, 2)
    _along_a_side(axes[0, 0], axes[0, 1])
    stiffness = np.geomspace(1, 1000, 41)
    for load, tag in zip((10.0, 20.0, 30.0), TAGS, strict=True):
        cells = [regular_cell(3, load, float(k)) for k in stiffness]
        here = rf"$\hat\sigma={load:g}$"
        ax = axes[1, 0]
        ax.plot(stiffness, [c.perimeter for c in cells], **tag, label=here)
        ax.plot(stiffness, [np.pi * c.width for c in cells], "--", **tag)
        sides = np.array([quartic_side(3, load, float(k)) for k in stiffness])
        axes[1, 1].plot(stiffness, [c.kappa_adhesion for c in cells], **tag, label=here)
        formula = [parabola_kappa_adhesion(3, float(side), load) for side in sides]
        axes[1, 1].plot(stiffness, formula, "--", **tag)
        inside = [c for c in cells if c.kappa_mid < 0]
        if inside:
            first = inside[0]
            ax.plot(first.ks_hat, first.perimeter, "v", color=tag["color"], markersize=6)
    ax.plot([], [], "v", color="0.3", markersize=6, label="inflected from here on")
    _polygons(axes[1, 0], axes[1, 1])
    _label(axes[1, 0], "C", K_S, r"perimeter $L/R_0$", "solid: $L$; dashed: $\\pi w$")
    _label(axes[1, 1], "D", K_S, r"$\kappa_0R_0$", "dashed: formula")
    axes[1, 1].set_yscale("log")
    for ax in axes[1]:
        ax.set_xscale("log")
    save(figure, path)
    return []


def _along_a_side(curved: Axes, turned: Axes) -> None:
    exact = regular_cell(3, LOAD, STIFFNESS)
    h = exact.side.h
    u = np.linspace(-1, 1, 201)
    curved.plot(h * (u + 1), exact.side.curvature(u), color=BLACK, label="exact")
    turned.plot(h * (u + 1), exact.side.tangent_angle(u), color=BLACK, label="exact")
    found = solve_cell(Cell(regular_sites(3), EDGES), LOAD, STIFFNESS)
    edges = edges_of(found.x)
    kappa = (edges.turning / edges.means)[: EDGES + 1]
    edge = float(edges.lengths[0])
    places = edge * np.arange(EDGES + 1)
    name = f"polygon, {EDGES} edges a side"
    marks: dict[str, Any] = {"markersize": 4, "markerfacecolor": "none", "color": BLUE}
    curved.plot(places, kappa, "o", label=name, **marks)
    angle = np.cumsum(edges.turning[1:EDGES])
    angle = np.append(0.0, angle)
    angle -= angle.mean()
    turned.plot(places[:-1] + 0.5 * edge, angle, "o", label=name, **marks)
    side = quartic_side(3, LOAD, STIFFNESS)
    s = np.linspace(0, side, 201)
    end = parabola_kappa_adhesion(3, side, LOAD)
    drawn: dict[str, Any] = {
        "color": VERMILION,
        "linestyle": "--",
        "label": "the paper's formula",
    }
    curved.plot(s, parabola(s, side, LOAD, end), **drawn)
    theta = end * s + 0.25 * LOAD * s**2 * (s / 3 - side / 2) - np.pi / 3
    turned.plot(s, theta, **drawn)
    _label(curved, "A", "$s/R_0$", r"$\kappa R_0$", r"$\hat\sigma=10$, $\hat k_s=50$")
    _label(turned, "B", "$s/R_0$", r"$\theta$", r"$\hat\sigma=10$, $\hat k_s=50$")


def _polygons(lengths: Axes, curvatures: Axes) -> None:
    """Draw polygons at sigma_hat = 10."""
    marks: dict[str, Any] = {"markersize": 4, "markerfacecolor": "none", "color": BLUE}
    for k in np.geomspace(1, 1000, 10):
        found = solve_cell(Cell(regular_sites(3), EDGES), LOAD, float(k))
        lengths.plot(k, found.perimeter, "o", **marks)
        curvatures.plot(k, found.kappa_adhesion.mean(), "o", **marks)
    for ax in (lengths, curvatures):
        ax.plot([], [], "o", **marks, label="polygon")


def draw_traction(path: Path) -> list[Number]:
    """Draw tractions, the branches in sigma_hat, and the lines that bound them."""
    figure = new_figure(PAGE, 5.4)
    axes = figure.subplots(2, 2)
    _over_stiffness(axes[0, 0])
    _over_load(axes[0, 1])
    _branches(axes[1, 0])
    _lines(axes[1, 1])
    save(figure, path)
    return []


def _over_stiffness(ax: Axes) -> None:
    stiffness = np.geomspace(1, 1000, 41)
    for load, tag in zip((5.0, 10.0, 20.0), TAGS, strict=True):
        exact = [regular_cell(3, load, float(k)).traction for k in stiffness]
        ax.plot(stiffness, exact, **tag, label=rf"$\hat\sigma={load:g}$")
        ax.plot(stiffness, [_quartic(load, float(k)) for k in stiffness], "--", **tag)
    ax.set_xscale("log")
    _label(ax, "A", K_S, r"$TR_0^2/\alpha$", "dashed: $T=\\sigma\\ell$, quartic")


def _over_load(ax: Axes) -> None:
    loads = np.geomspace(0.1, 300, 41)
    for k, tag in zip((10.0, 30.0, 60.0), TAGS, strict=True):
        exact = [regular_cell(3, float(load), k).traction for load in loads]
        ax.plot(loads, exact, **tag, label=rf"$\hat k_s={k:g}$")
        ax.plot(loads, [_quartic(float(load), k) for load in loads], "--", **tag)
    ax.axhline(0.0, color="0.7", linewidth=0.8)
    ax.set_xscale("log")
    _label(ax, "B", SIGMA, r"$TR_0^2/\alpha$", "dashed: $T=\\sigma\\ell$, quartic")


def _quartic(load: float, k: float) -> float:
    return parabola_traction(quartic_side(3, load, k), load)


def _branches(ax: Axes) -> None:
    for k, colour, mark in ((100.0, BLUE, "o"), (120.0, VERMILION, "s")):
        low, high = (fold.sigma_hat for fold in folds(3, k))
        near = np.linspace(0, 1, 15) ** 2
        below = low - (low - 2) * near[::-1]
        above = high + (500 - high) * near
        below[-1], above[0] = low * (1 - 1e-9), high * (1 + 1e-9)
        for loads, name in ((below, rf"$\hat k_s={k:g}$"), (above, None)):
            found = [smooth_cells(3, float(load), k) for load in loads]
            first = [cells[0] if cells else None for cells in found]
            second = [cells[1] if len(cells) > 1 else None for cells in found]
            stable = [c if c and c.n_unstable == 0 else None for c in first]
            _curve(ax, loads, first, color=colour, linestyle=":", linewidth=1.2)
            _curve(ax, loads, second, color=colour, linestyle=":", linewidth=1.2)
            _curve(ax, loads, stable, color=colour, linewidth=1.8, label=name)
        for ends in ((40.0, low), (high, 5000.0)):
            lost = lost_at_stiffness(k, *ends)
            place = lost.sigma_hat, lost.cell.perimeter
            ax.plot(*place, mark, color=colour, markersize=4.5)
        ax.plot([], [], mark, color=colour, markersize=4.5, label="its symmetry lost")
    loads = np.geomspace(star(3).sigma_p, 500, 60)
    lengths = [_star_perimeter(float(load)) for load in loads]
    ax.plot(
        loads, lengths, color="0.5", linestyle="--", label="star, its tips free of cost"
    )
    ax.set_xscale("log")
    _label(ax, "C", SIGMA, r"perimeter $L/R_0$", "dotted: unstable")


def _curve(
    ax: Axes, loads: FloatArray, cells: list[RegularCell | None], **how: Any
) -> None:
    ax.plot(loads, [np.nan if c is None else c.perimeter for c in cells], **how)


def _star_perimeter(load: float) -> float:
    found = star(3)
    arcs = found.side_length * load ** (-1 / 3)
    return float(3 * (arcs + 2 * found.protrusion(load)))


def _lines(ax: Axes) -> None:
    loads = np.geomspace(5, 1000, 36)
    # From the stiffest substrate shown, with close steps there, where the line is flat.
    first = inflections(3, 1000)[0].sigma_hat
    above = first * (1000 / first) ** np.linspace(0, 1, 100) ** 2
    flat = [inflection_stiffness(3, float(load)) for load in above]
    straight = [np.nan if point is None else point.ks_hat for point in flat]
    ax.plot(
        straight, above, color=BLUE, linestyle=(0, (5, 2)), label="$\\sigma_1^*$: inflected"
    )
    lost = [symmetry_lost(3, float(load)) for load in loads]
    stiff = [np.nan if point is None else point.ks_hat for point in lost]
    ax.plot(stiff, loads, color=ORANGE, linestyle=_DASHDOT, label="symmetry lost")
    folded = fold_line(3, 80)
    ax.plot(
        [p.ks_hat for p in folded],
        [p.sigma_hat for p in folded],
        color=VERMILION,
        label="fold",
    )
    meeting = reconnection(3)
    place = meeting.ks_hat, meeting.sigma_hat
    ax.plot(*place, "o", color=BLACK, markerfacecolor="white", label="softest folded")
    ax.axhline(star(3).sigma_p, color="0.4", linestyle=":", label=r"$\sigma_p$")
    ax.set(xscale="log", yscale="log", xlim=(50, 1000), ylim=(3, 1000))
    ax.set_xticks([50, 100, 200, 500, 1000], ["50", "100", "200", "500", "1000"])
    ax.minorticks_off()
    _label(ax, "D", K_S, SIGMA, "")


def draw_phases(path: Path) -> list[Number]:
    """Draw the phase diagram of runs/cell-phases.toml; the paper gives no number."""
    spec = load_cell_run(ROOT / "runs" / "cell-phases.toml", {})
    with TemporaryDirectory() as folder:
        diagram = run_phase_diagram(spec, Path(folder) / "phases")
        save(phase_figure(diagram), path)
    return []


def draw_spreading(path: Path) -> list[Number]:
    """Draw the radius over the stiffness with the paper's parameters, without data."""
    sigma, alpha = MUSCLE
    stiffness = np.geomspace(0.01, 1000, 200)
    figure = new_figure(COLUMN, 2.8)
    ax = figure.subplots()
    exact = cell_radius(stiffness, sigma, alpha, 1.0)
    ax.plot(stiffness, exact, color=BLACK, label="root of the cubic")
    near = interpolated_radius(stiffness, sigma, alpha, 1.0)
    ax.plot(stiffness, near, "--", color=VERMILION, label="interpolation formula")
    soft = (alpha / sigma) ** (1 / 3)
    for limit, label in ((soft, "soft and stiff limits"), (1.0, None)):
        ax.axhline(limit, color="0.6", linewidth=0.8, linestyle=":", label=label)
    ax.set_xscale("log")
    what = r"$\sigma=1.05$, $\alpha/R_0^3=0.16$ nN/$\mu$m; no measurements"
    _label(ax, "", r"$k_s$ (nN/$\mu$m)", "$R/R_0$", what)
    save(figure, path)
    return []


def _label(ax: Axes, letter: str, x: str, y: str, note: str) -> None:
    frame(ax)
    ax.set(xlabel=x, ylabel=y)
    ax.set_title("  ".join(filter(None, (letter, note))), loc="left", fontsize=SMALL)
    ax.legend(frameon=False, fontsize=SMALL)
