"""What studies share: place, meshes and their limits, processes, tables, the machine."""

from __future__ import annotations

import math
import os
import platform
from collections.abc import Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from threadpoolctl import threadpool_limits

from eulerplateau.mesh import Disk, MeshSpec, generate
from eulerplateau.settings import validate

if TYPE_CHECKING:
    from PIL.Image import Quantize

ROOT = Path(__file__).parents[2]


def make_mesh(**settings: Any) -> Disk:
    """Return the mesh that a mesh specification with these settings describes."""
    return generate(validate(settings, MeshSpec, "mesh"))


def processes() -> ProcessPoolExecutor:
    """Return a pool with a process for each CPU, of one thread each."""
    return ProcessPoolExecutor(initializer=partial(threadpool_limits, 1))


def peak_memory() -> float:
    """Return this process's peak memory in MiB; a child's ru_maxrss may be its parent's."""
    status = Path("/proc/self/status")
    if not status.exists():
        return math.nan
    line = next(row for row in status.read_text().splitlines() if row.startswith("VmHWM"))
    return int(line.split()[1]) / 1024


def markdown_table(rows: Iterable[Sequence[str]], words: int) -> str:
    """Return a Markdown table: its head first; numbers stand behind `words` columns."""
    head, *others = rows
    rule = ["---"] * words + ["---:"] * (len(head) - words)
    return "".join(f"| {' | '.join(row)} |\n" for row in (head, rule, *others))


def extrapolated(edges: Sequence[int], values: Sequence[float]) -> float:
    """Return the limit, by the last two: errors fall with the square of an edge."""
    ratio = (edges[-1] / edges[-2]) ** 2
    return (ratio * values[-1] - values[-2]) / (ratio - 1)


def machine() -> str:
    """Return what times were taken on: architecture, Python, CPUs it may use."""
    may_use = hasattr(os, "sched_getaffinity")
    cpus = len(os.sched_getaffinity(0)) if may_use else 1
    return f"{platform.machine()}, Python {platform.python_version()}, {cpus} CPUs"


def shrink(path: Path) -> None:
    """Write a PNG of curves anew with a palette: a third of the size, for the repository.

    The palette covers all hues, also those of few pixels.
    """
    from PIL.Image import Quantize

    _with_palette(path, 256, Quantize.MAXCOVERAGE)


def shrink_shaded(path: Path) -> None:
    """Write a PNG of films anew, with a palette of the shades that most of it has."""
    from PIL.Image import Quantize

    _with_palette(path, 128, Quantize.MEDIANCUT)


def _with_palette(path: Path, colours: int, method: Quantize) -> None:
    from PIL import Image

    with Image.open(path) as image:
        # A contact sheet is as large as it is, and no number of inches.
        dots = {"dpi": image.info["dpi"]} if "dpi" in image.info else {}
        small = image.convert("RGB").quantize(
            colours, method=method, dither=Image.Dither.NONE
        )
    small.save(path, optimize=True, **dots)
