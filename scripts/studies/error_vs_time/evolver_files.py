"""What Surface Evolver reads: datafiles of the area film, and scripts that relax it.

Evolver minimises sigma * area + bending with every loop edge's length fixed by a quantity
of its own. For the bending its method sqcurve_string_marked adds, where the loop turns by
the angle t, (2 u + u^2 / 3) / <s> with u = 1 - cos t, as its energies show; its manual says
2 u / <s>, which would be the first term of eq. discrete-energy (alpha = 1). With u^2 / 3 it
is t^2 / <s> up to t^6: the same limit, but another error on a given mesh.

How an expert runs it: Newton with a line search (hessian_seek) in hessian_normal mode, from
which the loop's vertices are exempt; the film's vertices are averaged after every step, so
that triangles follow the loop; six linear moments of the loop are fixed, against rigid
motions; hessian_epsilon, below which a pivot counts as zero, is so small that none does: at
1e-14 loops of 576 edges stop at shapes of four times the error, or nowhere near. In the
plane a film is its area and needs no interior: there Evolver gets its string model, and no
moments, with which the same loop takes twenty times the steps.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.mesh import Disk
from eulerplateau.mesh.triangles import directed_edges

# A Newton step that lowers the energy by less than this share is the last: the error left
# is about its square. The slow progress before that is never as slow.
LAST_DECREASE = 1e-10
MOST_STEPS = 1000

# Moments of the loop about its start, which rigid motions change and nothing else needs to.
_SHIFTS = {"shift_x": "x", "shift_y": "y", "shift_z": "z"}
_TURNS = {
    "turn_x": "start[2]*z - start[3]*y",
    "turn_y": "start[3]*x - start[1]*z",
    "turn_z": "start[1]*y - start[2]*x",
}
_MOMENTS = _SHIFTS | _TURNS


@dataclass(frozen=True)
class Datafile:
    """A datafile, and Evolver's numbers (n_b,) of the loop's vertices, in order."""

    text: str
    loop: IntArray
    in_plane: bool


def film_datafile(mesh: Disk, x: FloatArray, sigma_hat: float) -> Datafile:
    """Describe an area film with the rest lengths of `mesh`, at x (n_v, 3)."""
    edges, sides = _edges_and_sides(mesh.triangles)
    on_loop, loop_edge = np.zeros(mesh.n_v, dtype=bool), np.full(len(edges), -1)
    on_loop[mesh.loop] = True
    loop_edge[_edge_numbers(edges, mesh.loop)] = np.arange(mesh.n_b)
    rows = ["SPACE_DIMENSION 3", *_header(mesh), *_moments(x[mesh.loop]), "vertices"]
    for number, (at, marked) in enumerate(zip(x, on_loop, strict=True), start=1):
        rows.append(f"{number} {_triple(at)}{_loop_vertex(at) if marked else ''}")
    rows.append("edges")
    for number, ((i, j), v) in enumerate(zip(edges + 1, loop_edge, strict=True), start=1):
        rows.append(f"{number} {i} {j}{_loop_edge(v) if v >= 0 else ''}")
    rows.append("faces")
    for number, (a, b, c) in enumerate(sides, start=1):
        rows.append(f"{number} {a} {b} {c} tension {sigma_hat:.17g}")
    return Datafile("\n".join([*rows, "read", ""]), mesh.loop + 1, in_plane=False)


def string_datafile(mesh: Disk, x: FloatArray, sigma_hat: float) -> Datafile:
    """Describe the loop alone, in the plane, with sigma times its polygon's area.

    Of x (n_v, 3) the loop's first two coordinates count. By Stokes the area is the integral
    of (x dy - y dx) / 2 along the loop.
    """
    rows = [
        *("STRING", "SPACE_DIMENSION 2", *_header(mesh)),
        f"quantity film energy modulus {sigma_hat:.17g} method edge_vector_integral",
        *("vector_integrand:", "q1: -y/2", "q2: x/2"),
        "vertices",
    ]
    for number, at in enumerate(x[mesh.loop], start=1):
        rows.append(f"{number} {at[0]:.17g} {at[1]:.17g} on_loop 1 bending")
    rows.append("edges")
    for v in range(mesh.n_b):
        after = (v + 1) % mesh.n_b + 1
        rows.append(f"{v + 1} {v + 1} {after}{_loop_edge(v)} film tension 0")
    return Datafile(
        "\n".join([*rows, "read", ""]), np.arange(1, mesh.n_b + 1), in_plane=True
    )


def newton_script(in_plane: bool) -> str:
    """Return the commands of a Newton solve."""
    average = "" if in_plane else f"{_AVERAGE} "
    return _script(
        in_plane,
        [*_MULTIPLIERS],
        f"hessian_seek; {average}steps := steps + 1;",
        f"before - total_energy > {LAST_DECREASE}*abs(before) and steps < {MOST_STEPS}",
    )


def gradient_script(seconds: float) -> str:
    """Return the commands of conjugate gradients, given up after `seconds` of CPU."""
    return _script(
        False,
        ["conj_grad on;"],
        f"g 50; {_AVERAGE} steps := steps + 50;",
        f"before - total_energy > 1e-12*abs(before) and clock < {seconds}",
    )


def start_script(in_plane: bool) -> str:
    """Return the commands of a run that only reads the file: Evolver's start-up."""
    return _script(in_plane, [], "", "0")


_AVERAGE = "vertex_average vertex where not on_loop;"
# A step of no length finds the multipliers that hessian_seek asks for.
_MULTIPLIERS = ("m 0;", "g;")


def _script(in_plane: bool, prepare: list[str], step: str, repeat_while: str) -> str:
    """Repeat `step`; print energy, steps, last decrease, bending; the loop's positions."""
    loop_free = [] if in_plane else ["set vertex no_hessian_normal where on_loop;"]
    z = "0" if in_plane else "vv.z"
    rows = [
        "quiet on;",
        "define before real;",
        "define steps integer;",
        "steps := 0;",
        *loop_free,
        f"hessian_normal {'off' if in_plane else 'on'};",
        "hessian_epsilon := 1e-30;",
        *prepare,
        f"do {{ before := total_energy; {step} }} while ({repeat_while});",
        'printf "RESULT %.17g %d %.17g %.17g\\n",',
        "  total_energy, steps, before - total_energy, bending.value;",
        "foreach vertex vv where on_loop do",
        f'  printf "AT %d %.17g %.17g %.17g\\n", vv.id, vv.x, vv.y, {z};',
        "",
    ]
    return "\n".join(rows)


def _header(mesh: Disk) -> list[str]:
    return [
        "define edge attribute sqcurve_string_mark integer",
        "define vertex attribute on_loop integer",
        "quantity bending energy method sqcurve_string_marked",
        *(
            f"quantity length_{v} fixed = {s:.17g} method edge_length"
            for v, s in enumerate(mesh.rest_lengths)
        ),
    ]


def _moments(x_loop: FloatArray) -> list[str]:
    """Fix the moments at their values at the start (n_b, 3); those of turns are zero."""
    at_start = dict(zip(_SHIFTS, x_loop.sum(axis=0), strict=True))
    return [
        "define vertex attribute start real[3]",
        *(
            f"quantity {name} fixed = {at_start.get(name, 0.0):.17g} "
            f"method vertex_scalar_integral scalar_integrand: {integrand}"
            for name, integrand in _MOMENTS.items()
        ),
    ]


def _triple(at: FloatArray) -> str:
    return f"{at[0]:.17g} {at[1]:.17g} {at[2]:.17g}"


def _loop_vertex(at: FloatArray) -> str:
    return f" start {{{_triple(at)}}} on_loop 1 bending {' '.join(_MOMENTS)}"


def _loop_edge(v: int) -> str:
    return f" sqcurve_string_mark 1 length_{v}"


def _edges_and_sides(triangles: IntArray) -> tuple[IntArray, IntArray]:
    """Return the edges (n_e, 2) and each triangle's sides (n_t, 3) as Evolver counts them.

    Side k + 1 is edge k, negative where the triangle passes it backwards.
    """
    half = directed_edges(triangles)
    edges, inverse = np.unique(np.sort(half, axis=1), axis=0, return_inverse=True)
    number = inverse.ravel()
    sign = np.where(half[:, 0] == edges[number, 0], 1, -1)
    return edges, (sign * (number + 1)).reshape(-1, 3)


def _edge_numbers(edges: IntArray, loop: IntArray) -> IntArray:
    """Return the row in `edges`, sorted, of every loop edge loop[v] -> loop[v + 1]."""
    radix = (int(edges.max()) + 1, 1)
    ends = np.sort(np.stack([loop, np.roll(loop, -1)], axis=1), axis=1)
    found: IntArray = np.searchsorted(edges @ radix, ends @ radix)
    return found
