"""Write the true film's numbers, tables and figures."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from dataclasses import asdict
from math import pi
from pathlib import Path

import click
import numpy as np
from scipy.optimize import brentq
from threadpoolctl import threadpool_limits

from eulerplateau.exact.conformal import (
    TWISTED,
    BranchPoint,
    ConformalFilm,
    Mode,
    edge,
    flat_eight,
    go_to_load,
    locate,
    morse_index,
    start,
    switch,
    waist,
)
from eulerplateau.exact.conformal.eight_modes import planar_modes, transverse_modes
from eulerplateau.exact.conformal.families import ABOUT_X
from eulerplateau.exact.planar import planar_film, thresholds
from scripts.studies.common import ROOT
from scripts.studies.true_film.branches import (
    SADDLE,
    Row,
    planar_branch,
    planar_start,
    row_of,
    saddle_branch,
    saddle_start,
    twisted_branch,
)
from scripts.studies.true_film.family import family_fit
from scripts.studies.true_film.figures import draw_all
from scripts.studies.true_film.held import landscape

PER_LOAD = 2 * np.sqrt(3)  # sigma_hat / (k L^3 / alpha)
EIGHT_LOADS = (0.0, 500.0, 1000.0, 1500.0, 1855.677, 2500.0, 3500.0, 4500.0, 5000.0)
HELD_LOADS = (1300.0, 1500.0, 1611.259, 1750.0, 1855.677, 2000.0)
# Grids that the onset of the twist is located on: harmonics and crowding.
ONSET_GRIDS = ((32, 1e-2), (48, 1e-2), (64, 1e-2), (96, 1e-2), (64, 3e-3), (96, 3e-3))


@click.command()
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    default=ROOT / "docs",
    help="Folder for true_film.json, true_film.csv and pictures/true-film/. Default: docs.",
)
def main(out: Path) -> None:
    """Compute the true film's branches and draw them."""
    with threadpool_limits(1):
        planar, twist_film, twist_mode = planar_branch()
        twisted = twisted_branch(twist_film, twist_mode)
        saddle = saddle_branch()
        films = {"two-lobed": planar, "twisted": twisted, "saddle": saddle}
        rows = [row_of(name, film) for name, group in films.items() for film in group]
        numbers = {
            "twist": twist_numbers(twist_film, twist_mode),
            "saddle": saddle_numbers(saddle),
            "energies": crossings(),
            "eight": eights(),
            "barrier": barrier(rows),
            "family": {name: family_fit(films[name]) for name in ("twisted", "saddle")},
        }
        held = [landscape(load, twisted[4]) for load in HELD_LOADS]
    out.mkdir(parents=True, exist_ok=True)
    write(out, rows, numbers)
    draw_all(out / "pictures" / "true-film", films, rows, twist_film.load, held)
    click.echo(json.dumps(numbers, indent=1))


def twist_numbers(film: ConformalFilm, mode: Mode) -> dict[str, object]:
    """Return onset, its error over grids, and the law of the branch there."""
    onsets = {}
    for harmonics, crowding in ONSET_GRIDS:
        point = go_to_load(planar_start(harmonics, crowding), 1845.0)
        found, _ = locate(point, go_to_load(point, 1865.0), TWISTED)
        onsets[f"{harmonics} harmonics, crowding {crowding:g}"] = found.load
    best = list(onsets.values())
    law = near_onset(film.load, lambda a: switch(film, mode, a), -1)
    return {
        "onset": film.load,
        "error": max(abs(value - film.load) for value in best[2:]),
        "kL3_alpha": film.load / PER_LOAD,
        "waist": waist(film),
        "grids": onsets,
        **law,
    }


def saddle_numbers(films: list[ConformalFilm]) -> dict[str, object]:
    """Return the saddle's law at 96 pi^3; height is z's amplitude in disk radii."""
    law = near_onset(SADDLE, saddle_start, 1)
    amplitudes = np.array([0.002, 0.004, 0.008])
    shares, heights = [], []
    for amplitude in amplitudes:
        film = saddle_start(float(amplitude)).film
        heights.append(2 * pi * float(np.abs(film.curve.x[:, 2]).max()))
        shares.append(film.load / SADDLE - 1)
    ratios = np.array(shares) / np.array(heights) ** 2
    # ratio = c + d height^2 + e height^4 through three points.
    c = np.polyfit(np.array(heights) ** 2, ratios, 2)[-1]
    return {
        "onset": SADDLE,
        "load_over_height2": float(c),
        "least_index": min(morse_index(film) for film in films),
        "more_unstable_above": second_instability(films),
        **law,
    }


def second_instability(films: list[ConformalFilm]) -> float:
    """Return the load at which the saddle gets its third and fourth unstable mode."""
    before = max((f for f in films if morse_index(f) == 2), key=lambda f: f.load)
    point = start(before)
    return locate(point, go_to_load(point, before.load + 200.0), ABOUT_X)[0].load


def near_onset(
    onset: float, film_at: Callable[[float], BranchPoint], sign: int
) -> dict[str, float]:
    """Fit <|kappa_n|> and <K> to powers of the distance from the onset."""
    distances, bends, gauss = [], [], []
    for amplitude in np.geomspace(0.0005, 0.01, 9):
        film = film_at(float(amplitude)).film
        frame = edge(film)
        distances.append(sign * (film.load / onset - 1))
        bends.append(frame.abs_kappa_n)
        gauss.append(abs(frame.total_gauss_curvature))
    log = np.log(distances)
    # ln value = ln A + n ln eps + b eps.
    design = np.column_stack([np.ones_like(log), log, np.array(distances)])
    bent = np.linalg.lstsq(design, np.log(bends), rcond=None)[0]
    curved = np.linalg.lstsq(design, np.log(gauss), rcond=None)[0]
    return {
        "exponent_abs_kappa_n": float(bent[1]),
        "exponent_gauss": float(curved[1]),
        "load_over_abs_kappa_n2": float(sign * np.exp(-2 * bent[0])),
    }


def crossings() -> dict[str, float]:
    """Return where the flat eight has the energy of the two-lobed film and of the disk."""

    def gap(load: float) -> float:
        return flat_eight(load).energy - planar_film(2, load).energy

    def gap_to_disk(load: float) -> float:
        return flat_eight(load).energy - load / (4 * pi) - 4 * pi**2

    maxwell = float(brentq(gap, 1550, 1700, xtol=1e-9))
    with_disk = float(brentq(gap_to_disk, 1550, 1700, xtol=1e-9))
    return {
        "eight_equals_two_lobed": maxwell,
        "kL3_alpha": maxwell / PER_LOAD,
        "energy": flat_eight(maxwell).energy,
        "eight_equals_disk": with_disk,
        "crossing_angle_closes": thresholds(2).sigma_line_contact,
    }


def eights() -> list[dict[str, float]]:
    """Return energy, angle and lowest eigenvalues of flat eights."""
    found = []
    for load in EIGHT_LOADS:
        eight = flat_eight(load)
        transverse = {
            f"across, centre {c:+d}, mirror {m:+d}": float(
                transverse_modes(eight, c, m)[0 if (c, m) == (1, -1) else 1]
            )
            for c in (1, -1)
            for m in (1, -1)
        }
        found.append(
            {
                "sigma_hat": load,
                "energy": eight.energy,
                "lobe_angle_degrees": float(np.degrees(-2 * eight.angle)),
                "in the plane": float(planar_modes(eight)[3]),
                **transverse,
            }
        )
    return found


def barrier(rows: list[Row]) -> list[dict[str, float]]:
    """Compare the twisted films' energy above the flat eight with sigma w^2/(2 omega)."""
    found = []
    for row in (r for r in rows if r.branch == "twisted"):
        eight = flat_eight(row.sigma_hat)
        above = row.energy - eight.energy
        helicoid = row.sigma_hat * row.waist**2 / (-4 * eight.angle)
        found.append(
            {
                "sigma_hat": row.sigma_hat,
                "waist": row.waist,
                "above_eight": above,
                "above_two_lobed": row.energy - planar_film(2, row.sigma_hat).energy,
                "over_helicoid": above / helicoid,
            }
        )
    return found


def write(out: Path, rows: list[Row], numbers: dict[str, object]) -> None:
    """Write the table and the numbers."""
    text = json.dumps(numbers, indent=1, ensure_ascii=False)
    (out / "true_film.json").write_text(text + "\n", encoding="utf-8")
    with (out / "true_film.csv").open("w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, list(asdict(rows[0])), lineterminator="\n")
        table.writeheader()
        table.writerows(asdict(row) for row in rows)


if __name__ == "__main__":
    main()
