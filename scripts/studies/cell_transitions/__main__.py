"""Print where regular cells change."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import click

from eulerplateau.exact.cell import (
    RegularCell,
    fold_stiffness,
    inflection_onset,
    reconnection,
    regular_cell,
    rigid_fold,
    smooth_cells,
    star,
    strongest_pull,
    symmetry_lost,
)
from scripts.studies.cell_transitions.located import along_load, first_lost, softest_lost
from scripts.studies.cell_transitions.polygons import inflection, special_points
from scripts.studies.common import extrapolated, machine, markdown_table

Places = dict[str, tuple[float, RegularCell]]

ADHESIONS = (2, 3, 4, 5, 6, 8, 12)
STIFFNESSES = (100.0, 120.0)
EDGES = [32, 64, 128]
HEAVY = 1000.0  # a contractility beyond all folds' rigid limits
# Loads up to which a polygon is followed from beyond the second fold; and how near to what
# is looked for a window begins and ends.
FAR, NEAR = 1.25, 0.96


@dataclass(frozen=True)
class Check:
    """A fold or lost symmetry at a contractility, found again by polygons."""

    adhesions: int
    sigma_hat: float
    kind: str


CHECKS = (
    Check(2, 50.0, "fold"),
    Check(3, 60.0, "bifurcation"),
    Check(4, 200.0, "bifurcation"),
    Check(5, 200.0, "bifurcation"),
    Check(6, 200.0, "bifurcation"),
    Check(6, 400.0, "bifurcation"),
)
# Cells that a stiffer substrate makes stable again, and the stiffnesses to see it at.
RESTORED = ((6, 140.0), (12, 381.0))
RISING = (40.0, 50.0, 80.0, 90.0, 125.0, 135.0, 150.0, 200.0, 1000.0)


@click.command()
def main() -> None:
    """Print transitions of regular cells as Markdown: exact, and by polygons."""
    click.echo(f"{machine()}\n")
    click.echo(symmetric_shapes())
    click.echo(lost_symmetry())
    click.echo(loads())
    click.echo(checks())
    click.echo(stable_again())


def symmetric_shapes() -> str:
    """Return the table of what becomes of symmetric shapes."""
    head = ["N", "inflected from k̂", "at σ̂", "folds from k̂", "at σ̂", "Δ there"]  # noqa: RUF001
    rows = [[*head, "rigid limit σ̂", "k̂/σ̂^(2/3) for σ̂ → ∞", "σ_p"]]  # noqa: RUF001
    for n in ADHESIONS:
        flat, meeting, rigid = inflection_onset(n), reconnection(n), rigid_fold(n)
        numbers = [flat.ks_hat, flat.sigma_hat, meeting.ks_hat, meeting.sigma_hat]
        numbers += [meeting.cell.extension, rigid.sigma_hat, strongest_pull(n)]
        cells = [f"{number:.7g}" for number in numbers]
        rows.append([str(n), *cells, f"{star(n).sigma_p:.7g}" if n > 2 else "-"])
    return markdown_table(rows, words=0)


def lost_symmetry() -> str:
    """Return the table of where symmetric cells become unstable against unlike sides."""
    head = ["N", "lost from σ̂", "k̂ there", "wave", "softest k̂", "at σ̂", "wave"]  # noqa: RUF001
    rows = [[*head, "sides", f"k̂ at {HEAVY:g}", "wave", "fold there"]]
    for n in ADHESIONS:
        if n == 2:
            continue
        first = first_lost(n)
        softest = softest_lost(n, first.sigma_hat)
        heavy, fold = symmetry_lost(n, HEAVY), fold_stiffness(n, HEAVY)
        rigid = first.ks_hat > 1e6
        cells = [f"{first.sigma_hat:.6g}", "rigid" if rigid else f"{first.ks_hat:.4g}"]
        cells += [str(first.q), f"{softest.ks_hat:.6g}", f"{softest.sigma_hat:.3g}"]
        cells += [str(softest.q), "convex" if softest.cell.kappa_mid > 0 else "inflected"]
        cells += [f"{heavy.ks_hat:.6g}", str(heavy.q)] if heavy else ["-", "-"]
        rows.append([str(n), *cells, f"{fold.ks_hat:.6g}" if fold else "-"])
    return markdown_table(rows, words=0)


def loads() -> str:
    """Return the table of three adhesions under rising contractility."""
    names = ["k̂", "edges a side"]
    rows: list[list[str]] = []
    for ks_hat in STIFFNESSES:
        exact = along_load(ks_hat)
        rows = rows or [[*names, *exact]]
        found = [polygon(exact, ks_hat, edges) for edges in EDGES]
        for edges, values in zip(EDGES, found, strict=True):
            cells = (values.get(name) for name in exact)
            rows.append(row(ks_hat, str(edges), cells))
        limits = (
            extrapolated(EDGES[-2:], [values[name] for values in found[-2:]])
            if all(name in values for values in found[-2:])
            else None
            for name in exact
        )
        rows.append(row(ks_hat, "extrapolated", limits))
        rows.append(row(ks_hat, "exact", (load for load, _ in exact.values())))
        shape = [cell.kappa_mid for _, cell in exact.values()]
        rows.append([f"{ks_hat:g}", "κ in mid-side", *(f"{k:.4f}" for k in shape)])
        extended = [cell.extension for _, cell in exact.values()]
        rows.append([f"{ks_hat:g}", "Δ", *(f"{delta:.4f}" for delta in extended)])
    return markdown_table(rows, words=2)


def row(ks_hat: float, name: str, values: Iterable[float | None]) -> list[str]:
    """Return a row of loads, some of them missing."""
    cells = ["-" if value is None else f"{value:.7g}" for value in values]
    return [f"{ks_hat:g}", name, *cells]


def polygon(exact: Places, ks_hat: float, edges: int) -> dict[str, float]:
    """Return the loads of those transitions that are located for a polygon too."""
    first, fold = exact["inflection"][0], exact["fold"][0]
    window = (0.9 * exact["symmetry lost"][0], 1.05 * fold)
    start = regular_cell(3, 1.001 * window[0], ks_hat)
    below = special_points(edges, "load", window, ks_hat, start)
    load = FAR * exact["symmetric again"][0]
    window = (0.9 * exact["fold again"][0], 1.01 * load)
    start = smooth_cells(3, load, ks_hat)[0]
    above = special_points(edges, "load", window, ks_hat, start)
    found = {"inflection": inflection(3, edges, ks_hat, first)}
    for special, end in ((below, ""), (above, " again")):
        for kind, multiplicity, value in special:
            if kind == "fold":
                found[f"fold{end}"] = value
            elif multiplicity == 2:
                found["symmetric again" if end else "symmetry lost"] = value
    return found


def checks() -> str:
    """Return the table of folds and lost symmetry at given contractilities."""
    head = ["N", "σ̂", "what", *map(str, EDGES[:2]), "extrapolated", "exact"]  # noqa: RUF001
    rows = [head]
    for check in CHECKS:
        n, sigma = check.adhesions, check.sigma_hat
        lost = symmetry_lost(n, sigma)
        exact = fold_stiffness(n, sigma) if check.kind == "fold" else lost
        assert exact is not None
        window = (NEAR * exact.ks_hat * 0.96, exact.ks_hat / NEAR)
        start = regular_cell(n, sigma, NEAR * exact.ks_hat * 0.97)
        values = []
        for edges in EDGES[:2]:
            special = special_points(edges, "stiffness", window, sigma, start)
            values.append(next(value for kind, _, value in special if kind == check.kind))
        what = "fold" if lost is None else f"wave {lost.q}"
        cells = [*values, extrapolated(EDGES[:2], values), exact.ks_hat]
        rows.append([str(n), f"{sigma:g}", what, *(f"{k:.7g}" for k in cells)])
    return markdown_table(rows, words=0)


def stable_again() -> str:
    """Return the table of Morse indices over stiffness where these rise and fall."""
    rows = [["N", "σ̂", *(f"k̂ = {k:g}" for k in RISING)]]  # noqa: RUF001
    for n, sigma in RESTORED:
        indices = [str(regular_cell(n, sigma, k).n_unstable) for k in RISING]
        rows.append([str(n), f"{sigma:g}", *indices])
    return markdown_table(rows, words=0)


if __name__ == "__main__":
    main()
