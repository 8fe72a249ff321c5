"""Tables and plot of errors against run time."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import groupby
from operator import attrgetter

from scripts.studies.common import machine
from scripts.studies.error_vs_time.arithmetic import (
    BoolArray,
    fitted_order,
    pareto,
    seconds_to,
)
from scripts.studies.error_vs_time.equal_error import equal_error
from scripts.studies.error_vs_time.growth import growth
from scripts.studies.error_vs_time.records import (
    EXTRAPOLATED,
    HARMONICS,
    Measurement,
    Point,
    extrapolated,
    points,
)
from scripts.studies.error_vs_time.scenes import SCENES

EVOLVER = "evolver"
# Smaller errors are no better.
ROUNDING = 1e-15
STATED = (1e-3, 1e-4, 1e-5, 1e-6)


def markdown(found: list[Measurement]) -> str:
    """Return the report's tables."""
    known = points(found)
    lines = [
        "# Error against run time",
        "",
        f"Printed by `scripts/error_vs_time` on {machine()}, one BLAS thread. "
        "CPU seconds, medians.",
        "",
        *_times(known),
        "",
        *equal_error(by_scene(known)),
        "`conformal`, in space, and `tangent angle`, in the plane, have harmonics in place "
        "of a mesh, of the whole loop and of a lobe; they keep, and use, the start's "
        "symmetry, converge exponentially and have no order.",
        "",
        *_orders(known),
        "",
        *growth(known),
        "",
        *_all_points(known),
        "",
        advice(known),
    ]
    return "\n".join(lines)


def ours(point: Point) -> bool:
    """Whether a point is this program's."""
    return not point.first.solver.startswith(EVOLVER)


def theirs(point: Point) -> bool:
    """Whether a point is Surface Evolver's."""
    return point.first.solver.startswith(EVOLVER)


def time_to(known: Iterable[Point], error: float) -> float | None:
    """Return the CPU seconds to an error on the front of the points given."""
    chosen = list(known)
    return seconds_to([p.cpu for p in chosen], [error_of(p) for p in chosen], error)


def on_front(known: list[Point]) -> BoolArray:
    """Return (n,): whether a point is on the Pareto front of those given."""
    return pareto([p.cpu for p in known], [error_of(p) for p in known])


def error_of(point: Point) -> float:
    """Return the error to three digits: rounding alone must not make one solver better."""
    return float(f"{max(point.first.error, ROUNDING):.2e}")


def by_scene(known: list[Point]) -> dict[str, list[Point]]:
    """Return the points of each scene, by its name."""
    return {
        name: group
        for name in SCENES
        if (group := [p for p in known if p.first.scene == name])
    }


def _times(known: list[Point]) -> list[str]:
    heads = " | ".join(f"{error:.0e}" for error in STATED)
    lines = [
        "CPU seconds to an error, ours / Evolver's (how many times faster ours is):",
        "",
        f"| scene | {heads} |",
        f"|---|{'---:|' * len(STATED)}",
    ]
    for name, group in by_scene(known).items():
        lines.append(f"| {name} | {_compared(group)} |")
        if both := extrapolated(group):
            both += [p for p in group if p.first.mesh == HARMONICS]
            lines.append(f"| ... or from two meshes | {_compared(both)} |")
    return lines


def _compared(group: list[Point]) -> str:
    cells = []
    for error in STATED:
        a = time_to(filter(ours, group), error)
        b = time_to(filter(theirs, group), error)
        ratio = f" ({b / a:.2g})" if a and b else ""
        cells.append(f"{_short(a)} / {_short(b)}{ratio}")
    return " | ".join(cells)


def _orders(known: list[Point]) -> list[str]:
    lines = [
        "Fitted orders: of the errors in h, and of the energy error in seconds.",
        "",
        "| scene | solver | mesh | energy in h | shape in h | energy in seconds |",
        "|---|---|---|---:|---:|---:|",
    ]

    for (scene, solver, mesh), group in groupby(known, attrgetter("ladder")):
        ladder = [p for p in group if p.first.error > 0]
        if mesh == HARMONICS or len(ladder) < 3:
            continue
        h = [1 / p.first.loop_edges for p in ladder]
        energy = [p.first.error for p in ladder]
        shape = [p.first.shape_error for p in ladder]
        orders = (
            fitted_order(h, energy),
            fitted_order(h, shape),
            fitted_order([p.cpu for p in ladder], energy),
        )
        cells = " | ".join(f"{order:.2f} ± {spread:.2f}" for order, spread in orders)
        lines.append(f"| {scene} | {solver} | {mesh} | {cells} |")
    return lines


def _all_points(known: list[Point]) -> list[str]:
    lines = [
        "All points that converged; * on the Pareto front of their scene.",
        "",
        "| scene | solver | mesh | loop | vertices | energy error | shape error | "
        "area error | bending error | CPU s | least-most | wall s | steps | MiB | |",
        "|---|---|---|" + "---:|" * 11 + "---|",
    ]
    for name, group in by_scene(known).items():
        front = on_front(group)
        for p, best in zip(group, front, strict=True):
            m = p.first
            lines.append(
                f"| {name} | {m.solver} | {m.mesh} | {m.loop_edges} | {m.vertices} | "
                f"{m.error:.1e} | {m.shape_error:.1e} | {m.area_error:.1e} | "
                f"{m.bending_error:.1e} | {p.cpu:.3g} | "
                f"{p.least:.3g}-{p.most:.3g} | {p.wall:.3g} | {m.iterations} | "
                f"{p.memory:.0f} | {'*' if best else ''} |"
            )
    return lines


@dataclass(frozen=True)
class Way:
    """A way of ours to compute a film: solver, kind of mesh and its loop edges."""

    solver: str
    mesh: str
    loop_edges: int


def cheapest(known: list[Point], error: float, in_plane: bool) -> tuple[Way, float] | None:
    """Return the cheapest way measured to reach an error, and its worst CPU seconds.

    In every scene of film `area` with an exact energy, in space or in the plane; two meshes
    may be combined. None if no way reached it in all of them.
    """
    scenes = [
        n for n, scene in SCENES.items() if scene.exact and scene.in_plane == in_plane
    ]
    times: dict[Way, dict[str, float]] = {}
    for p in filter(ours, [*known, *extrapolated(known)]):
        m = p.first
        if m.scene in scenes and m.error <= error:
            times.setdefault(Way(m.solver, m.mesh, m.loop_edges), {})[m.scene] = p.cpu
    good = [(w, max(t.values())) for w, t in times.items() if len(t) == len(scenes)]
    return min(good, key=lambda item: item[1], default=None)


def advice(known: list[Point]) -> str:
    """Return one sentence for users: what to use for an error of 1e-3 and of 1e-6."""
    space, plane = (_advice(known, in_plane) for in_plane in (False, True))
    return f"{space}; for films kept in their plane: {plane}."


def _advice(known: list[Point], in_plane: bool) -> str:
    parts = []
    for error in (1e-3, 1e-6):
        found = cheapest(known, error, in_plane)
        if found is None:
            parts.append(f"an error of {error:.0e} was not reached in every scene")
            continue
        way, seconds = found
        wanted = f"for an error of {error:.0e} use"
        how = f"`{way.solver.removesuffix(EXTRAPOLATED)}` "
        if way.mesh == HARMONICS:
            parts.append(f"{wanted} {how}with {way.loop_edges} harmonics ({seconds:.2g} s)")
            continue
        how += f"on {way.mesh} meshes of "
        if way.solver.endswith(EXTRAPOLATED):
            how += f"{way.loop_edges // 2} and {way.loop_edges} loop edges combined"
        else:
            how += f"{way.loop_edges} loop edges"
        parts.append(f"{wanted} {how} ({seconds:.2g} s)")
    return "; ".join(parts)


def _short(seconds: float | None) -> str:
    return "-" if seconds is None else f"{seconds:.2g}"
