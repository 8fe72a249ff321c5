"""`eulerplateau film`: a soap film without a mesh, bounded by a rod that resists twist."""

from __future__ import annotations

import json

import click

# What the command line calls the arguments of `rod_film`.
_OPTIONS = {
    "load": "--sigma-hat",
    "twist_ratio": "--twist-ratio",
    "link": "--link",
    "rest_curvature": "--rest-curvature",
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
    help="The rod's natural curvature over 2 pi / L; not with a link.",
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON, in full precision.")
def film(
    sigma_hat: float,
    start: str,
    twist_ratio: float,
    link: float,
    rest_curvature: float,
    as_json: bool,
) -> int:
    """Print the numbers of a film of true area, to ten digits (L = 1, energies in alpha/L).

    Starts: the flat disk; the flat film of two lobes; the least twisted film of no link;
    the flat figure eight, whose pinch the twist opens or presses. Ends with 4 where the
    film is not resolved, is pinched, or does not exist.
    """
    from eulerplateau.branches.conformal import Start, pinched_eight, rod_film
    from eulerplateau.errors import NOT_CONVERGED_EXIT_CODE, SpecError
    from eulerplateau.threads import one_thread

    rod = sigma_hat, twist_ratio, link, rest_curvature
    try:
        with one_thread():
            if start == Start.EIGHT.value:
                numbers = pinched_eight(*rod).numbers()
            else:
                numbers = rod_film(Start(start), *rod).numbers()
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
