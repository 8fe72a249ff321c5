"""`eulerplateau film`: a soap film without a mesh, bounded by a rod that resists twist."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import click

from eulerplateau.cli.refused import refusals_as_json

if TYPE_CHECKING:
    from eulerplateau.branches.conformal import Start

# What is said of every film; null of one that is refused.
_NUMBERS = ("energy", "area", "bending", "twist_energy", "writhe", "twist_moment")
# What the command line calls the arguments of `rod_film`.
_OPTIONS = {
    "load": "--sigma-hat",
    "twist_ratio": "--twist-ratio",
    "link": "--link",
    "rest_curvature": "--rest-curvature",
    "diameter": "--diameter",
}


@click.command()
@click.option("--sigma-hat", required=True, type=float, help="The load sigma L^3 / alpha.")
@click.option(
    "--start",
    required=True,
    type=click.Choice(["disk", "lobes", "twisted", "eight"]),
    help="The film of no link that is followed to the link asked for.",
)
@click.option(
    "--twist-ratio",
    type=float,
    default=0.0,
    help="C/B, the rod's rigidity to twist over that to bending; by default 0.",
)
@click.option("--link", type=float, default=0.0, help="Turns before the rod was welded.")
@click.option(
    "--rest-curvature",
    type=float,
    default=0.0,
    help="The rod's natural curvature over 2 pi / L.",
)
@click.option(
    "--diameter",
    type=float,
    help="The rod's, in L, up to 0.1, of an eight whose strands touch; by default none.",
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON, in full precision.")
def film(
    sigma_hat: float,
    start: str,
    twist_ratio: float,
    link: float,
    rest_curvature: float,
    diameter: float | None,
    as_json: bool,
) -> int:
    """Print the numbers of a film of true area, to ten digits (L = 1, energies in alpha/L).

    Starts: the flat disk; the flat film of two lobes; the least twisted film of no link;
    the flat figure eight, whose pinch the twist opens or presses, or with a diameter the
    twisted one, whose strands touch. Ends with 4 where the film is not resolved, is
    pinched, opens, has more contact than a point, or does not exist.
    """
    from eulerplateau.errors import NOT_CONVERGED_EXIT_CODE, SpecError
    from eulerplateau.threads import one_thread

    rod = sigma_hat, twist_ratio, link, rest_curvature
    try:
        with one_thread(), refusals_as_json(as_json, _NUMBERS):
            numbers = _without_minus_zero(_numbers(start, rod, diameter))
    except SpecError as error:
        key, problem = error.args
        raise SpecError(_OPTIONS.get(key, key), problem) from None
    if as_json:
        click.echo(json.dumps(numbers, indent=2))
    else:
        width = max(map(len, numbers))
        for name, value in numbers.items():
            shown = f"{value:.15g}" if isinstance(value, float) else value
            click.echo(f"{name:{width}}  {shown}")
    return 0 if numbers["status"] == "converged" else NOT_CONVERGED_EXIT_CODE


def _numbers(
    start: str, rod: tuple[float, float, float, float], diameter: float | None
) -> dict[str, float | int | str]:
    """Return what is said of the film asked for."""
    from eulerplateau.branches.conformal import Start, pinched_eight, thick_eight
    from eulerplateau.errors import SpecError

    if diameter is None:
        if start == Start.EIGHT.value:
            return {**pinched_eight(*rod).numbers()}
        return _followed(Start(start), rod)
    if start != Start.EIGHT.value:
        raise SpecError("diameter", "needs --start eight: no other film touches itself")
    load, twist_ratio, link, rest_curvature = rod
    if rest_curvature != 0:
        raise SpecError("rest_curvature", "should be 0 with a diameter")
    return thick_eight(load, diameter, twist_ratio, link).numbers()


def _without_minus_zero(
    numbers: dict[str, float | int | str],
) -> dict[str, float | int | str]:
    return {k: v + 0.0 if isinstance(v, float) else v for k, v in numbers.items()}


def _followed(
    start: Start, rod: tuple[float, float, float, float]
) -> dict[str, float | int | str]:
    """Return the numbers of a film; a terminal sees how far it has been followed."""
    from tqdm import tqdm

    from eulerplateau.branches.conformal import rod_film
    from eulerplateau.compiling import telling_of_compiling

    with tqdm(
        desc=start.value, unit="film", dynamic_ncols=True, disable=None, leave=False
    ) as bar:

        def tell(where: str) -> None:
            bar.set_postfix_str(where)
            bar.update()

        with telling_of_compiling(bar.set_postfix_str):
            return rod_film(start, *rod, tell=tell).numbers()
