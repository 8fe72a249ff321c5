"""`eulerplateau estimate`: what a loop of a given line does in a given soap film."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from math import isfinite
from typing import TYPE_CHECKING, Any

import click

from eulerplateau.cli.bench_options import line_options, quantity, rigidity

if TYPE_CHECKING:
    from eulerplateau.units import Quantity

_STATES = {
    "disk": "the flat disk, which is stable",
    "buckled": "flat, with two lobes",
    "point-contact": "flat, with two lobes whose sides touch in a point",
    "line-contact": "flat, with two lobes whose sides touch along a line",
    "too_thick": "bent more sharply than a line of this diameter can be",
    "eight": "a pinched figure eight, to which two lobes have jumped",
}
_LINES = {
    "untwisting": "if the line's ends turn freely in each other",
    "welded": "if they are welded straight: a round line does not twist before it touches",
}
_CHANGES = {
    "buckles": "the disk gets two lobes",
    "jumps": "two lobes jump to a pinched eight, if the line's ends turn freely",
    "touches": "if they do not: the two lobes' sides touch in a point",
    "touches_along_a_line": "and along a line",
    "opens": "an eight in contact opens again, if the line's ends turn freely",
}
_NOT = {
    "touches": "not where the line's curvature stays below 2/d",
    "touches_along_a_line": "not where the line's curvature stays below 2/d",
    "opens": "not known but of loops of 10 to 2000 diameters",
}


@click.command()
@line_options
@click.option("--length", required=True, help='Of the loop: "20 cm".')
@click.option(
    "--surface-tension",
    required=True,
    help='Of the liquid: "25 mN/m"; the film has two faces and twice this tension.',
)
@click.option(
    "--poisson", type=float, help="Poisson's ratio of the line: C/B = 1/(1 + it)."
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON, in SI units.")
def estimate(
    young: str | None,
    diameter: str | None,
    bending_rigidity: str | None,
    length: str,
    surface_tension: str,
    poisson: float | None,
    as_json: bool,
) -> None:
    """Say what a loop of a line does in a soap film, and at which lengths that changes.

    The line's bending rigidity is EI, of --young and --diameter (I = pi d^4/64) or given
    as --bending-rigidity. A given diameter is heeded where the loop's sides touch.
    """
    from eulerplateau.errors import SpecError
    from eulerplateau.exact import THICKEST, Bench
    from eulerplateau.threads import one_thread
    from eulerplateau.units import DIAMETER, LENGTH, SURFACE_TENSION

    stiffness = rigidity(young, diameter, bending_rigidity)
    if stiffness is None:
        problem = 'is missing, as "2 GPa" with --diameter "0.2 mm"; or --bending-rigidity'
        raise SpecError("--young", problem)
    long = quantity("--length", length, LENGTH)
    thick = None if diameter is None else quantity("--diameter", diameter, DIAMETER).value
    liquid = quantity("--surface-tension", surface_tension, SURFACE_TENSION).value
    if poisson is not None and not -1 < poisson <= 0.5:
        raise SpecError("--poisson", f"found {poisson:g}; should be as 0.4, up to 0.5")
    bench = Bench(stiffness, long.value, liquid)
    if thick is not None and thick > THICKEST * long.value:
        most = f"{1e3 * THICKEST * long.value:g} mm, {THICKEST:g} of the loop's length"
        raise SpecError("--diameter", f"found {diameter!r}; should be at most {most}")
    with one_thread():
        numbers = _numbers(bench, thick, poisson)
    click.echo(
        json.dumps(numbers, indent=2) if as_json else "\n".join(_said(numbers, long))
    )


def _numbers(bench: Any, diameter: float | None, poisson: float | None) -> dict[str, Any]:
    """Return what is printed as JSON, in units of the SI."""
    from dataclasses import asdict

    from eulerplateau.exact import Twist, changes, isotropic_twist_ratio, state
    from eulerplateau.film import SPRING_LOAD

    relative = None if diameter is None else diameter / bench.length
    loads = asdict(changes(0.0 if diameter is None else bench.width(diameter)))
    loads = {name: load if isfinite(load) else None for name, load in loads.items()}
    return {
        "sigma_hat": bench.load,
        "kL3_alpha": bench.load / SPRING_LOAD.tension_per_load,
        "diameter": relative,
        "elastocapillary_length": bench.elastocapillary_length,
        "bending_rigidity": bench.rigidity,
        "twist_ratio": None if poisson is None else isotropic_twist_ratio(poisson),
        "film": {twist.value: state(bench.load, twist, relative) for twist in Twist},
        "loads": loads,
        "lengths": {name: load and bench.length_at(load) for name, load in loads.items()},
    }


def _said(numbers: Mapping[str, Any], length: Quantity) -> Iterator[str]:
    """Yield the lines that are printed; lengths in the unit of the loop's."""
    from eulerplateau.units import LENGTH

    unit = LENGTH.factor(length.unit)

    def long(value: float) -> str:
        return f"{value / unit:.4g} {length.unit}"

    explained = {
        "sigma_hat": ("sigma L^3 / alpha, sigma = 2 gamma, alpha = EI / 2", _plain),
        "kL3_alpha": ("sigma_hat / (2 sqrt 3), of films of springs", _plain),
        "diameter": ("the line's, over the loop's length", _plain),
        "elastocapillary_length": ("(EI / sigma)^(1/3)", long),
        "bending_rigidity": ("EI in N m^2", _plain),
        "twist_ratio": ("C/B = 1 / (1 + Poisson's ratio)", _plain),
    }
    for name, (meaning, form) in explained.items():
        if numbers[name] is not None:
            yield f"{name:22}  {form(numbers[name]):>10}  {meaning}"
    yield ""
    yield f"A loop of {long(length.value)} whose film has grown to this load is"
    for twist, condition in _LINES.items():
        yield f"  {_STATES[numbers['film'][twist]]}, {condition}"
    yield ""
    yield "Lengths of a loop of this line at which"
    for name, what in _CHANGES.items():
        load = numbers["loads"][name]
        if load is None:
            yield f"  {'':>10}  {what}: {_NOT[name]}"
            continue
        yield f"  {long(numbers['lengths'][name]):>10}  {what} (sigma_hat {load:.2f})"


def _plain(value: float) -> str:
    return f"{value:.4g}" if value < 1000 else f"{value:.1f}"
