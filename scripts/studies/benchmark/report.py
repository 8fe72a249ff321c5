"""Tables and plot of the benchmark."""

from __future__ import annotations

import csv
import statistics
from collections.abc import Callable
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from eulerplateau.pictures.figure import PAGE, SMALL, TEXT, frame, new_figure, save
from eulerplateau.pictures.looks import legend_above, style
from scripts.studies.common import machine

ERRORS = tuple(10.0**-d for d in (3, 6, 8, 10, 12))
COLUMNS = (
    *("vertices", "loop_edges", "solver", "task", "repeat", "seconds", "error"),
    *("iterations", "status"),
)

TASKS = {"cold": "cold start", "warm": "warm start"}
LOOKS: dict[str, dict[str, Any]] = {
    name: {**style(number), "markersize": 2.6, "linestyle": line, "linewidth": 0.9}
    for number, (name, line) in enumerate(
        {"newton": "-", "cg": "-.", "cg-plain": "--"}.items()
    )
}


def time_to(points: list[tuple[float, float]], error: float) -> float | None:
    """Return when the error fell below `error` for good; None if it never did."""
    reached = None
    for seconds, found in points:
        if found > error:
            reached = None
        elif reached is None:
            reached = seconds
    return reached


def of_task(case: dict[str, Any], task: str) -> list[dict[str, Any]]:
    """Return the runs of one task."""
    return [run for run in case["runs"] if run["task"] == task]


def middle(values: list[float | None]) -> str:
    """Return median and spread of repeated times, for a table."""
    known = sorted(value for value in values if value is not None)
    if len(known) < len(values) or not known:
        return "-"
    spread = f" ({known[0]:.3g}-{known[-1]:.3g})" if len(known) > 1 else ""
    return f"{statistics.median(known):.3g}{spread}"


def summary(case: dict[str, Any]) -> str:
    """Return one line on a case."""
    done = "" if case["finished"] else ", not finished in time"
    seconds = [f"{t} {middle([r['seconds'] for r in of_task(case, t)])} s" for t in (
        "cold", "warm") if of_task(case, t)]  # fmt: skip
    return f"{case['vertices']} vertices, {case['solver']}: {', '.join(seconds)}{done}"


def report(cases: list[dict[str, Any]]) -> str:
    """Return the tables as Markdown."""
    lines = [
        "# Newton against conjugate gradients",
        "",
        f"Printed by `scripts/benchmark` on {machine()}, one BLAS thread. CPU seconds, "
        "median (least-most) of the repeated runs.",
        "",
    ]
    for task, text in (
        ("cold", "load 700 from the flat polygon"),
        ("warm", "load 710 from the equilibrium at 700"),
    ):
        heads = [f"to {error:.0e}" for error in ERRORS]
        lines += [
            f"## {task.capitalize()}: {text}",
            "",
            f"| vertices | loop | solver | iterations | {' | '.join(heads)} | accepted |",
            f"|---:|---:|---|---:|{'---:|' * len(heads)}---:|",
        ]
        for case in cases:
            if runs := of_task(case, task):
                times = [
                    middle([time_to(run["points"], error) for run in runs])
                    for error in ERRORS
                ]
                accepted = middle(
                    [r["seconds"] if r["status"] == "converged" else None for r in runs]
                )
                lines.append(
                    f"| {case['vertices']} | {case['loop_edges']} | {case['solver']} | "
                    f"{runs[0]['iterations'] or '-'} | {' | '.join(times)} | {accepted} |"
                )
        lines.append("")
    return "\n".join([*lines, *ratios(cases), *set_ups(cases)])


def ratios(cases: list[dict[str, Any]]) -> list[str]:
    """Return how many times faster newton is than what finished, run against run."""
    lines = ["## How many times faster newton is", ""]
    lines += [
        "| vertices | task | than | to 1e-06 | accepted |",
        "|---:|---|---|---:|---:|",
    ]
    by_size: dict[int, dict[str, Any]] = {}
    for case in cases:
        by_size.setdefault(case["vertices"], {})[case["solver"]] = case
    for size, found in by_size.items():
        for task, other in product(("cold", "warm"), ("cg", "cg-plain")):
            if "newton" not in found or not found.get(other, {}).get("finished"):
                continue
            slow, fast = of_task(found[other], task), of_task(found["newton"], task)
            whole = medians(slow, whole_time) / medians(fast, whole_time)
            part = medians(slow, to_a_millionth) / medians(fast, to_a_millionth)
            lines.append(f"| {size} | {task} | {other} | {part:.0f} | {whole:.0f} |")
    return [*lines, ""]


def whole_time(run: dict[str, Any]) -> float:
    """Return the CPU seconds of the whole solve, stability or kick included."""
    return float(run["seconds"])


def to_a_millionth(run: dict[str, Any]) -> float:
    """Return the CPU seconds to an error of 1e-6."""
    return time_to(run["points"], 1e-6) or float("nan")


def medians(runs: list[dict[str, Any]], of: Callable[[dict[str, Any]], float]) -> float:
    """Return the median of a quantity over repeated runs."""
    return statistics.median(of(run) for run in runs)


def set_ups(cases: list[dict[str, Any]]) -> list[str]:
    """Return set-up times (with the condensation), peak memory, and the cost's growth."""
    lines = ["## Set-up and memory", ""]
    lines += [
        "| vertices | solver | set-up, s | peak memory, GiB |",
        "|---:|---|---:|---:|",
    ]
    lines += [
        f"| {c['vertices']} | {c['solver']} | {c['set_up']:.3g} | {c['memory']:.2f} |"
        for c in cases
    ]
    lines += [
        "",
        "Exponent of the growth of the accepted time with the vertices:",
        "",
    ]
    for solver in ("cg-plain", "cg", "newton"):
        for task in ("cold", "warm"):
            found = [
                (c["vertices"], medians(of_task(c, task), whole_time))
                for c in cases
                if c["solver"] == solver and c["finished"] and of_task(c, task)
            ]
            if len(found) > 1:
                size, seconds = np.log(np.array(found)).T
                power = np.polyfit(size, seconds, 1)[0]
                lines.append(f"- {solver}, {task}: {power:.2f}")
    return [*lines, ""]


def write_csv(path: Path, cases: list[dict[str, Any]]) -> None:
    """Write every report of every run."""
    with path.open("w", newline="", encoding="ascii") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        for case in cases:
            for run in case["runs"]:
                for seconds, error in run["points"]:
                    writer.writerow(
                        [
                            *(case[name] for name in COLUMNS[:3]),
                            *(run[name] for name in COLUMNS[3:5]),
                            *(seconds, error),
                            *(run[name] for name in COLUMNS[7:]),
                        ]
                    )


def read_csv(path: Path) -> list[dict[str, Any]]:
    """Return of each case what `draw` needs, from a table that `write_csv` has written."""
    cases: dict[tuple[str, ...], dict[str, Any]] = {}
    with path.open(newline="", encoding="ascii") as file:
        for row in csv.DictReader(file):
            case = cases.setdefault(
                (row["vertices"], row["solver"]),
                {"vertices": int(row["vertices"]), "solver": row["solver"], "runs": {}},
            )
            run = case["runs"].setdefault(
                (row["task"], row["repeat"]), {"task": row["task"], "points": []}
            )
            run["points"].append((float(row["seconds"]), float(row["error"])))
    return [{**case, "runs": list(case["runs"].values())} for case in cases.values()]


def draw(path: Path, cases: list[dict[str, Any]]) -> None:
    """Draw error against run time, a panel for each task and size; of repeats the last."""
    from matplotlib.lines import Line2D

    sizes = sorted({case["vertices"] for case in cases})
    figure = new_figure(PAGE, 3.9)
    axes = figure.subplots(2, len(sizes), sharex=True, sharey=True, squeeze=False)
    for line, (task, heading) in zip(axes, TASKS.items(), strict=True):
        line[0].set_ylabel(f"{heading}\nrelative error")
        for ax, size in zip(line, sizes, strict=True):
            for case in cases:
                runs = of_task(case, task)
                if case["vertices"] == size and runs:
                    seconds, errors = np.array(runs[-1]["points"]).T
                    ax.loglog(seconds, np.maximum(errors, 1e-16), **LOOKS[case["solver"]])
            frame(ax)
    for ax, size in zip(axes[0], sizes, strict=True):
        ax.set_title(f"{size} vertices", fontsize=SMALL)
    figure.supxlabel(
        "CPU time (s); the error is the larger one of energy and lengths", fontsize=TEXT
    )
    drawn = sorted({case["solver"] for case in cases}, key=list(LOOKS).index)
    legend_above(figure, [Line2D([], [], **LOOKS[name], label=name) for name in drawn])
    save(figure, path)
