"""Print the errors of the interpolation formula."""

from __future__ import annotations

import click

from scripts.studies.cell_radius.errors import STIFFNESSES, TENSIONS, error, worst
from scripts.studies.common import markdown_table


@click.command()
def main() -> None:
    """Print relative errors over stiffness and tension, and the worst, as Markdown."""
    head = ["k̂ over σ̂", *(f"{tension:.4g}" for tension in TENSIONS)]  # noqa: RUF001
    rows = [
        [f"{k:g}", *(f"{100 * float(error(k, tension)):.3g} %" for tension in TENSIONS)]
        for k in STIFFNESSES
    ]
    click.echo(markdown_table([head, *rows], words=1))
    cases = [["σ̂", "worst error", "at k̂", "order soft", "order stiff"]]  # noqa: RUF001
    for tension in TENSIONS:
        if tension == 1:  # xi = R_0: no error at all
            continue
        w = worst(tension)
        numbers = [f"{100 * w.error:.4g} %", f"{w.stiffness:.4g}"]
        numbers += [f"{w.soft_order:.3f}", f"{w.stiff_order:.3f}"]
        cases.append([f"{tension:.4g}", *numbers])
    click.echo(markdown_table(cases, words=1))


if __name__ == "__main__":
    main()
