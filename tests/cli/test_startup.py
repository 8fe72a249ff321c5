"""What the command line loads, and how soon it answers."""

from __future__ import annotations

import statistics
import subprocess
import sys
from pathlib import Path

from eulerplateau.mesh import write_mesh
from eulerplateau.mesh.disk import Disk

HEAVY = {"gmsh", "pyvista", "trimesh", "matplotlib", "meshio", "vtkmodules"}


# What only a loop with a diameter has a use for.
CONTACT = {
    "eulerplateau.loop.strand_kernels",
    "eulerplateau.runs.contact_record",
    "eulerplateau.solvers.contact",
}


# What only an equilibrium that is corrected has a use for.
CORRECTION = {
    "eulerplateau.film.curved_film",
    "eulerplateau.loop.spline",
    "eulerplateau.solvers.correction",
}


# One sweep after another, and after each a line of what is loaded by then.
SWEEPS = """
import sys
from eulerplateau.cli import main
for path in sys.argv[1:]:
    sys.argv[1:] = ["sweep", "--no-pictures", "--quiet", path]
    try:
        main()
    except SystemExit as end:
        assert not end.code
    print(*sys.modules)
"""


def loaded_by(*words: object) -> set[str]:
    """Top-level packages that `eulerplateau WORDS` imports."""
    result = subprocess.run(
        [sys.executable, "-X", "importtime", "-m", "eulerplateau", *map(str, words)],
        capture_output=True,
        text=True,
        check=True,
    )
    return {
        line.split("|")[-1].strip().partition(".")[0]
        for line in result.stderr.splitlines()
        if line.startswith("import time:")
    }


def test_sweep_on_a_stored_mesh_loads_no_mesher_and_no_plotting_library(
    tmp_path: Path, oval: Disk
) -> None:
    write_mesh(oval, tmp_path / "oval.vtp")
    thin, thick = tmp_path / "thin.toml", tmp_path / "thick.toml"
    thin.write_text('[mesh]\nfile = "oval.vtp"\n[sweep]\nloads = [500, 900]\n')
    thick.write_text(thin.read_text() + "[loop]\ndiameter = 0.01\n")
    command = [sys.executable, "-c", SWEEPS, str(thin), str(thick)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    modules, more = (set(line.split()) for line in done.stdout.splitlines())
    loaded = {name.partition(".")[0] for name in modules}
    assert {"numpy", "scipy", "eulerplateau"} <= loaded
    # A small film of springs has nothing that is compiled, sparse or optimised.
    assert not loaded & (HEAVY | {"pint", "numba"})
    slow = {"scipy.linalg", "scipy.sparse", "scipy.optimize"}
    assert not modules & (CONTACT | CORRECTION | slow)
    assert "numba" in more
    assert more >= CONTACT


def test_help_loads_no_numerical_library() -> None:
    """What makes it quick, whatever the machine."""
    for words in (("--help",), ("sweep", "--help"), ("mesh", "--help"), ("--version",)):
        loaded = loaded_by(*words)
        assert not loaded & (
            HEAVY | {"numpy", "scipy", "numba", "pint", "pydantic", "tqdm"}
        )


def test_help_answers_within_three_tenths_of_a_second() -> None:
    """Of processor time, which other work on the machine does not lengthen."""
    clock = (
        "import resource, subprocess, sys\n"
        "before = 0.0\n"
        "for _ in range(5):\n"
        "    subprocess.run(sys.argv[1:], check=True, capture_output=True)\n"
        "    used = resource.getrusage(resource.RUSAGE_CHILDREN)\n"
        "    after = used.ru_utime + used.ru_stime\n"
        "    sys.stdout.write(f'{after - before}\\n')\n"
        "    before = after\n"
    )
    module = ["-m", "eulerplateau", "--help"]
    run = subprocess.run(
        [sys.executable, "-c", clock, sys.executable, *module],
        capture_output=True,
        text=True,
        check=True,
    )
    assert statistics.median(map(float, run.stdout.split())) < 0.3
