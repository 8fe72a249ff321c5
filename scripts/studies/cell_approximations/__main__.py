"""Print the errors of the paper's formulas for regular cells."""

from __future__ import annotations

import click
import numpy as np

from eulerplateau.exact.cell import CellStatus, RegularCell, errors, regular_cell
from scripts.studies.cell_approximations.widths import (
    pull,
    traction_by_forces,
    traction_by_integration,
    widths,
)
from scripts.studies.common import markdown_table

LOADS = (1.1, 2.0, 5.0, 10.0, 20.0, 30.0, 50.0)
STIFFNESSES = (10.0, 50.0, 100.0, 1000.0)
ADHESIONS = (3, 4, 6)
FORMULAS = ("kappa", "kappa_adhesion", "traction", "width", "side", "quartic_traction")
SHORT = ("κ(s)", "κ₀", "T = σℓ", "width", "ℓ, quartic", "T, quartic")  # noqa: RUF001
# Cells with line tension, for the exact relations: N, sigma_hat, ks_hat, beta_hat.
TENSE = ((3, 10.0, 50.0, 5.0), (2, 10.0, 20.0, 1.0), (6, 30.0, 100.0, 20.0))
LIGHT = 1e-3
# Ever larger contractility, where traction saturates.
HEAVY = (1e3, 1e4, 1e5)


@click.command()
def main() -> None:
    """Print relative errors of the paper's formulas as Markdown."""
    cells = {
        (n, load, k): regular_cell(n, load, k)
        for n in ADHESIONS
        for load in LOADS
        for k in STIFFNESSES
    }
    click.echo(grid(cells))
    click.echo(worst(cells))
    click.echo(all_widths(cells))
    click.echo(relations(cells))
    click.echo(ends())


def grid(cells: dict[tuple[int, float, float], RegularCell]) -> str:
    """Return the table of all errors with three adhesions."""
    rows = [["σ̂", "k̂", *SHORT, "κ in mid-side"]]  # noqa: RUF001
    for (n, load, k), cell in cells.items():
        if n == 3:
            if cell.status is CellStatus.CONVERGED:
                found = errors(cell)
                texts = [percent(found[name]) for name in FORMULAS]
                texts.append(f"{cell.kappa_mid:.3f}")
            else:
                texts = ["-"] * len(FORMULAS) + ["no cell"]
            rows.append([f"{load:g}", f"{k:g}", *texts])
    return markdown_table(rows, words=0)


def worst(cells: dict[tuple[int, float, float], RegularCell]) -> str:
    """Return the table of the least and largest errors, convex and inflected apart."""
    rows = [["N", "cells", "how many", *SHORT]]
    for n in ADHESIONS:
        for convex in (True, False):
            these = [
                errors(cell)
                for (number, _, _), cell in cells.items()
                if number == n
                and cell.status is CellStatus.CONVERGED
                and (cell.kappa_mid > 0) == convex
            ]
            texts = []
            for name in FORMULAS:
                values = sorted((one[name] for one in these), key=abs)
                ends = f"{percent(values[0])} … {percent(values[-1])}" if values else "-"
                texts.append(ends)
            kind = "convex" if convex else "inflected"
            rows.append([str(n), kind, str(len(these)), *texts])
    return markdown_table(rows, words=2)


def all_widths(cells: dict[tuple[int, float, float], RegularCell]) -> str:
    """Return the table of widths over all directions, in units of perimeter / pi."""
    rows = [["N", "k̂", *(f"σ̂ = {load:g}" for load in LOADS)]]  # noqa: RUF001
    for n in ADHESIONS:
        for k in STIFFNESSES:
            texts = []
            for load in LOADS:
                cell = cells[n, load, k]
                if cell.status is CellStatus.CONVERGED:
                    found = widths(cell)
                    inflected = "*" if cell.kappa_mid < 0 else ""
                    texts.append(f"{found.least:.4f} … {found.most:.4f}{inflected}")
                else:
                    texts.append("-")
            rows.append([str(n), f"{k:g}", *texts])
    means = [
        widths(cell).mean - 1
        for cell in cells.values()
        if cell.status is CellStatus.CONVERGED and cell.kappa_mid > 0
    ]
    note = f"\n* inflected. Mean width of convex cells: 1 to {np.abs(means).max():.0e}.\n"
    return markdown_table(rows, words=0) + note


def relations(cells: dict[tuple[int, float, float], RegularCell]) -> str:
    """Return how well the exact relations of traction hold."""
    known = [cell for cell in cells.values() if cell.status is CellStatus.CONVERGED]
    known += [regular_cell(*arguments) for arguments in TENSE]
    lines = []
    for name, relation in (
        ("T = 2 tan(pi/N) (sigma rho + beta - kappa_0^2)", traction_by_forces),
        ("T = sigma l + 2 pi beta/N - int kappa^3 ds", traction_by_integration),
    ):
        off = [
            abs(relation(cell) - cell.traction) / (cell.sigma_hat * 2 * cell.side.h)
            for cell in known
            if cell.side.adhesions > 2
        ]
        lines.append(f"{name}: off by at most {max(off):.0e} of sigma l, {len(off)} cells")
    two = [cell for cell in known if cell.side.adhesions == 2]
    two += [regular_cell(2, load, 20.0) for load in LOADS]
    off = [
        abs(cell.kappa_adhesion**2 - pull(cell)) / cell.kappa_adhesion**2 for cell in two
    ]
    name = "N = 2, kappa_0^2 = sigma rho + beta"
    lines.append(f"{name}: off by at most {max(off):.0e}, {len(off)} cells")
    return "\n".join(lines) + "\n"


def ends() -> str:
    """Return the tractions for small and for large contractility."""
    rows = [["N", "k̂", f"T at σ̂ = {LIGHT:g}", *(f"T/2k̂ at {load:g}" for load in HEAVY)]]  # noqa: RUF001
    for n in ADHESIONS:
        for k in (50.0, 100.0):
            cells = [regular_cell(n, load, k) for load in HEAVY]
            shares = [f"{cell.traction / (2 * k):.5f}" for cell in cells]
            light = regular_cell(n, LIGHT, k).traction
            rows.append([str(n), f"{k:g}", f"{light:.4g}", *shares])
    return markdown_table(rows, words=0)


def percent(value: float) -> str:
    """Return a relative error."""
    return f"{100 * value:.2g} %"


if __name__ == "__main__":
    main()
