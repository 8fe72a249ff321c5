"""Run Surface Evolver in a process of its own and read what it reached and what it cost."""

from __future__ import annotations

import math
import os
import re
import shutil
import subprocess
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Timer

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh import Disk
from scripts.studies.error_vs_time.evolver_files import (
    LAST_DECREASE,
    Datafile,
    film_datafile,
    newton_script,
    string_datafile,
)

# Debian's name for double precision; the plain name is an alternative that may be another.
PROGRAMS = ("evolver-nox-d", "evolver")
MISSING = "Surface Evolver is not installed (Debian: apt-get install evolver-nox)"
# On top of the script, at its end: only Evolver itself knows its own peak, not its parent.
_WEIGH = 'system "grep VmHWM /proc/$PPID/status";\n'


@dataclass(frozen=True)
class EvolverRun:
    """What Evolver reached and what it cost, start-up and reading the datafile included.

    Attributes
    ----------
    bending : float, its part of the energy
    loop : (n_b, 3) float
    steps, cpu, wall :
        Newton steps and seconds, summed over the meshes of a sequence.
    memory : float
        Peak resident memory in MiB; nan where it was not asked for.
    """

    energy: float
    bending: float
    loop: FloatArray
    steps: int
    cpu: float
    wall: float
    memory: float
    converged: bool


def find_evolver() -> str | None:
    """Return the path of Evolver's program, None if it is not installed."""
    return next((path for name in PROGRAMS if (path := shutil.which(name))), None)


def run_evolver(
    data: Datafile, script: str, *, seconds: float = 100.0, weigh: bool = False
) -> EvolverRun:
    """Run `script` on `data` for at most `seconds`; `weigh` costs it a few milliseconds.

    Raises FileNotFoundError if Evolver is not installed, and ValueError with the end of
    what it printed if it was stopped or failed.
    """
    program = find_evolver()
    if program is None:
        raise FileNotFoundError(MISSING)
    with TemporaryDirectory() as folder:
        Path(folder, "film.fe").write_text(data.text, encoding="ascii")
        script = f"{script}{_WEIGH if weigh else ''}q\n"
        Path(folder, "script.cmd").write_text(script, encoding="ascii")
        with Path(folder, "out").open("w+b") as out:
            started = time.perf_counter()
            child = subprocess.Popen(
                [program, "-fscript.cmd", "film.fe"],
                cwd=folder,
                stdin=subprocess.DEVNULL,
                stdout=out,
                stderr=out,
            )
            timer = Timer(seconds, child.kill)
            timer.start()
            _, status, usage = os.wait4(child.pid, 0)
            wall = time.perf_counter() - started
            timer.cancel()
            child.returncode = os.waitstatus_to_exitcode(status)
            out.seek(0)
            printed = out.read().decode("ascii", "replace")
    run = parse(printed, data)
    return replace(run, cpu=usage.ru_utime + usage.ru_stime, wall=wall)


def parse(printed: str, data: Datafile) -> EvolverRun:
    """Return the run whose output is `printed`, without what it cost.

    Raises ValueError with the end of what was printed if there is no finite result.
    """
    result = re.search(r"^RESULT (\S+) (\d+) (\S+) (\S+)$", printed, re.MULTILINE)
    if result is None or "NaN" in printed:
        raise ValueError(f"Evolver gave no result: ... {printed[-300:]!r}")
    found = re.findall(r"^AT (\d+) (\S+) (\S+) (\S+)$", printed, re.MULTILINE)
    at = {int(number): [float(c) for c in position] for number, *position in found}
    memory = re.search(r"VmHWM:\s+(\d+) kB", printed)
    energy, decrease = float(result[1]), float(result[3])
    return EvolverRun(
        energy=energy,
        bending=float(result[4]),
        loop=np.array([at[number] for number in data.loop.tolist()]),
        steps=int(result[2]),
        cpu=math.nan,
        wall=math.nan,
        memory=int(memory[1]) / 1024 if memory else math.nan,
        converged=abs(decrease) <= LAST_DECREASE * abs(energy),  # false for nan
    )


def relax(
    meshes: Sequence[Disk],
    x: FloatArray,
    sigma_hat: float,
    prolong: Callable[[Disk, FloatArray, Disk, bool], FloatArray],
    *,
    in_plane: bool,
    weigh: bool = False,
) -> EvolverRun:
    """Solve on one mesh after the other, from x (n_v, 3) on the first.

    `prolong` carries the loop (n_b, 3) on one mesh to a shape (n_v, 3) on the next. It is
    ours, and so is writing the datafiles: neither is charged to Evolver.
    """
    describe = string_datafile if in_plane else film_datafile
    runs: list[EvolverRun] = []
    for number, mesh in enumerate(meshes):
        if runs:
            x = prolong(meshes[number - 1], runs[-1].loop, mesh, in_plane)
        data = describe(mesh, x, sigma_hat)
        last = number == len(meshes) - 1
        runs.append(run_evolver(data, newton_script(in_plane), weigh=weigh and last))
    return replace(
        runs[-1],
        steps=sum(run.steps for run in runs),
        cpu=sum(run.cpu for run in runs),
        wall=sum(run.wall for run in runs),
    )
