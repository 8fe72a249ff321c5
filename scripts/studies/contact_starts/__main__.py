"""Solve random starts of loops with a diameter, and print what became of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import groupby

import click
import numpy as np

from scripts.studies.common import markdown_table, processes
from scripts.studies.contact_starts.starts import FAILURES, FILMS, End, case, run

STARTS = 500


@click.command()
@click.option("--starts", default=STARTS, help="How many; default: 500.")
def main(starts: int) -> None:
    """Print how starts ended, how far laws are kept, and every start that breaks one."""
    with processes() as pool:
        ends = list(pool.map(run, map(case, range(starts))))
    click.echo(f"{len(ends)} starts\n")
    for rows, words in ((_counts(ends), 3), (_extremes(ends), 1), (_failed(ends), 4)):
        click.echo(markdown_table(rows, words))


def _counts(ends: Sequence[End]) -> Iterator[list[str]]:
    """Yield how many starts ended how, and how many of those are not as they should be."""
    yield [
        "film",
        "start",
        "status",
        "starts",
        "overlapped first",
        "in contact",
        *FAILURES,
    ]

    def group(end: End) -> tuple[int, str, str]:
        return FILMS.index(end.case.film), end.case.kind, end.status

    for (film, kind, status), members in groupby(sorted(ends, key=group), group):
        some = list(members)
        failures = [name for end in some for name in end.failures]
        numbers = [
            len(some),
            sum(end.overlaps[0] > 0.0 for end in some),
            sum(end.contacts > 0 for end in some),
            *map(failures.count, FAILURES),
        ]
        yield [FILMS[film], kind, status, *map(str, numbers)]


def _extremes(ends: Sequence[End]) -> Iterator[list[str]]:
    """Yield the worst of a film's starts, whatever their status, and what they took."""
    yield [
        "film",
        "overlap / d, parted",
        "overlap / d",
        "pull",
        "merit rise",
        "rise",
        "CPU s each",
    ]
    for film in FILMS:
        every = [end for end in ends if end.case.film == film]
        worst: list[Callable[[End], float]] = [
            lambda end: end.overlaps[1],
            lambda end: end.overlaps[2],
            lambda end: 0.0 - end.pull,
            lambda end: end.risen,
            lambda end: end.rise,
        ]
        shown = [f"{np.nanmax([np.nan, *map(of, every)]):.1e}" for of in worst]
        mean = np.mean([end.seconds for end in every]) if every else np.nan
        yield [film, *shown, f"{mean:.2f}"]


def _failed(ends: Sequence[End]) -> Iterator[list[str]]:
    """Yield every start that is not as it should be, whatever its status."""
    yield [
        "film",
        "start",
        "status",
        "fails",
        "seed",
        "d",
        "tension",
        "overlap / d",
        "rise",
    ]
    for end in ends:
        if end.failures:
            told = end.case
            yield [
                told.film,
                told.kind,
                end.status,
                ", ".join(end.failures),
                str(told.seed),
                f"{told.diameter:.4f}",
                f"{told.tension:.0f}",
                f"{end.overlaps[2]:.2e}",
                f"{end.rise:.1e}",
            ]


if __name__ == "__main__":
    main()
