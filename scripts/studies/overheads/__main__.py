"""Measure what commands take besides solving, and what a large film takes; print tables."""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

import click

from scripts.studies.common import ROOT, machine, markdown_table

RUN = ROOT / "runs" / "elongated.toml"
COMMANDS = "sweep", "branches"
WORDS = {
    "before": "until the run begins: Python, imports, the specification",
    "solved": "the solver",
    "measured": "measures of shapes",
    "written": "tables, shapes, run.json",
    "drawn": "the diagram",
    "the rest": "the rest",
    "ended": "the end of the process",
    "beside": "all but the solver",
    "all": "all",
}


def carried_out(command: str, pictures: bool) -> dict[str, float]:
    """Return the seconds of CPU of a command by part."""
    # Whoever wishes for no compiled files would wait for them each time.
    kept = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    with TemporaryDirectory() as folder:
        told = Path(folder) / "parts.json"
        words = [command, str(RUN), "--quiet", "--out", str(Path(folder) / "run")]
        if not pictures:
            words.append("--no-pictures")
        module = [sys.executable, "-P", "-m", "scripts.studies.overheads.parts", str(told)]
        began = _children()
        subprocess.run([*module, *words], check=True, env=kept)
        whole = _children() - began
        found: dict[str, float] = json.loads(told.read_text())
    ended = whole - found["all"]
    return {**found, "ended": ended, "beside": whole - found["solved"], "all": whole}


def _children() -> float:
    """Return the seconds of CPU of all processes that were started here and have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def large_film() -> str:
    """Return a line about a film of 50,000 vertices."""
    module = [sys.executable, "-P", "-m", "scripts.studies.overheads.large"]
    told = json.loads(subprocess.run(module, check=True, stdout=subprocess.PIPE).stdout)
    middle, least, most = told["warm"]
    return (
        f"{told['vertices']} vertices of true area, {told['loop']} on the loop, stability "
        f"included: cold {told['cold']:.3g} s of CPU, then {middle:.3g} ({least:.3g} to "
        f"{most:.3g}) s a step, peak memory {told['memory']:.0f} MiB"
    )


@click.command()
@click.option("--repeat", default=5, help="How often each command is carried out.")
@click.option("--large/--no-large", default=True, help="Also a film of 50,000 vertices.")
def main(repeat: int, large: bool) -> None:
    """Print tables: median seconds of CPU, least to most; with the diagram and without."""
    cases = [(command, drawn) for command in COMMANDS for drawn in (False, True)]
    taken: dict[tuple[str, bool], list[dict[str, float]]] = {case: [] for case in cases}
    for case in cases:
        carried_out(*case)  # what is compiled and cached is from then on
    for _ in range(repeat):
        for case in cases:
            taken[case].append(carried_out(*case))
    rows = [("part", *(f"{name}{', drawn' * drawn}" for name, drawn in cases))]
    for part, words in WORDS.items():
        rows.append((words, *(_spread([one[part] for one in taken[c]]) for c in cases)))
    click.echo(markdown_table(rows, 1))
    if large:
        click.echo(f"{large_film()}\n")
    click.echo(machine())


def _spread(values: list[float]) -> str:
    return f"{median(values):.2f} ({min(values):.2f}-{max(values):.2f})"


if __name__ == "__main__":
    main()
