"""Print where sweeps of the contractility end, and what stars cost."""

from __future__ import annotations

import click
import numpy as np

from eulerplateau.cells import CellEquilibrium
from eulerplateau.exact.cell import smooth_cells, star
from scripts.studies.cell_hysteresis.stars import StarEnergy, star_energy
from scripts.studies.cell_hysteresis.sweeps import End, followed, light_start, nearest
from scripts.studies.cell_transitions.located import along_load
from scripts.studies.cell_transitions.polygons import near_exact
from scripts.studies.common import extrapolated, markdown_table

STIFFNESSES = (100.0, 120.0)
EDGES = [24, 48, 96]
LIGHT, STEP_UP = 2.0, 4.0
HEAVY, STEP_DOWN = 400.0, -10.0
STAR_EDGES = (24, 48, 96, 192)
STAR_LOADS = (5.0, 30.0, 60.0, 400.0)


@click.command()
def main() -> None:
    """Print the ends of sweeps up and down, and the energies of stars, as Markdown."""
    click.echo(sweeps())
    click.echo(stars())
    click.echo(against_smooth())


def sweeps() -> str:
    """Return the table of where sweeps end, and what follows."""
    head = ["k̂", "sweep", "edges a side", "last σ̂", "perimeter", "area", "Δ", "then"]  # noqa: RUF001
    rows = [[*head, "perimeter", "area", "Δ of each", "near each other"]]
    for ks_hat in STIFFNESSES:
        exact = along_load(ks_hat)
        for up, name in ((True, "symmetry lost"), (False, "symmetric again")):
            loads = []
            for edges in EDGES:
                found = swept(ks_hat, edges, up=up)
                way = "up" if up else "down"
                if found is None:
                    rows.append([f"{ks_hat:g}", way, str(edges), "none lost", *8 * [""]])
                    continue
                loads.append(found.last.sigma_hat)
                rows.append([f"{ks_hat:g}", way, str(edges), *cells(found)])
            limit = extrapolated(EDGES[-2:], loads[-2:])
            texts = ["extrapolated", f"{limit:.4f}", "exact", f"{exact[name][0]:.4f}"]
            rows.append([f"{ks_hat:g}", way, *texts, *6 * [""]])
    return markdown_table(rows, words=2)


def swept(ks_hat: float, edges: int, *, up: bool) -> End | None:
    """Return where a sweep ends, from a light cell up or from a heavy one down."""
    if up:
        return followed(light_start(edges, LIGHT, ks_hat), STEP_UP, HEAVY)
    exact = smooth_cells(3, HEAVY, ks_hat)[0]
    return followed(near_exact(exact, edges, HEAVY, ks_hat), STEP_DOWN, LIGHT)


def cells(found: End) -> list[str]:
    """Return the last minimum's numbers and those of what it goes over to."""
    last, after = found.last, found.after
    places = " and ".join(f"{place:.2f}" for place in nearest(after))
    return [
        f"{last.sigma_hat:.3f}",
        *size(last),
        f"{last.extensions.mean():.3f}",
        after.status.value,
        *size(after),
        ", ".join(f"{delta:.3f}" for delta in np.sort(after.extensions)),
        places,
    ]


def size(found: CellEquilibrium) -> list[str]:
    """Return perimeter and area."""
    return [f"{found.perimeter:.3f}", f"{found.area:.3f}"]


def stars() -> str:
    """Return the table of a star's energy over its edges."""
    load = 60.0
    head = ["edges a side", "bending of tips", "of the rest", "film", "turning but tips"]
    rows = [[*head, "a tip's push", "2k̂ at 100"]]
    found = [star_energy(3, load, edges) for edges in STAR_EDGES]
    for edges, one in zip(STAR_EDGES, found, strict=True):
        texts = [f"{one.tips:.2f}", f"{one.rest:.4f}", f"{one.film:.4f}"]
        texts += [f"{one.turning / np.pi:.6f} π", f"{one.pull:.1f}", "200"]
        rows.append([str(edges), *texts])
    logs = np.log([one.tips for one in found])
    power = np.polyfit(np.log(STAR_EDGES), logs, 1)[0]
    note = f"\nsigma_p = {star(3).sigma_p:.6f}; star at {load:g}: protrusion "
    note += f"{star(3).protrusion(load):.4f}; tips grow as edges^{power:.4f}\n"
    return markdown_table(rows, words=0) + note


def against_smooth() -> str:
    """Return the table of stars' energies, with and without tips, and smooth cells'."""
    head = ["σ̂", "smooth, k̂ = 100", "star without tips"]  # noqa: RUF001
    rows = [[*head, *(f"tips, {edges}" for edges in STAR_EDGES), "equal at"]]
    for load in STAR_LOADS:
        smooth = smooth_cells(3, load, 100.0)[0].energy
        found = [star_energy(3, load, edges) for edges in STAR_EDGES]
        without = found[-1].rest + found[-1].film
        equal = balanced(found[-1], smooth)
        texts = [f"{smooth:.2f}", f"{without:.2f}", *(f"{one.tips:.0f}" for one in found)]
        rows.append([f"{load:g}", *texts, f"{equal:.2f} edges a side"])
    return markdown_table(rows, words=0)


def balanced(finest: StarEnergy, smooth: float) -> float:
    """Return the edges a side at which a star has a smooth cell's energy."""
    share = finest.tips / STAR_EDGES[-1]
    return (smooth - finest.rest - finest.film) / share


if __name__ == "__main__":
    main()
