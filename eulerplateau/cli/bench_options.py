"""Options that say of which line a loop is made, in quantities with units."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

import click

if TYPE_CHECKING:
    from eulerplateau.units import Measure, Quantity

Command = TypeVar("Command", bound=Callable[..., Any])


def line_options(command: Command) -> Command:
    """Add --young, --diameter and --bending-rigidity."""
    for option in (
        click.option("--bending-rigidity", help='EI in place of both: "1.6e-7 N m^2".'),
        click.option("--diameter", help='Of the round line: "0.2 mm".'),
        click.option("--young", help='Young\'s modulus of the line: "2 GPa".'),
    ):
        command = option(command)
    return command


def quantity(option: str, text: str, measure: Measure) -> Quantity:
    """Return the value of an option; raises SpecError, which shows an example."""
    from eulerplateau.errors import SpecError

    try:
        return measure.read(text)
    except ValueError as error:
        raise SpecError(option, f"found {text!r}; {error}") from None


def rigidity(young: str | None, diameter: str | None, given: str | None) -> float | None:
    """Return EI in N m^2 by the options; None where they say nothing; raises SpecError."""
    from eulerplateau.errors import SpecError
    from eulerplateau.exact import bending_rigidity
    from eulerplateau.units import DIAMETER, RIGIDITY, YOUNG

    if given is not None:
        if young is not None:
            problem = "says again what --bending-rigidity says: leave one out"
            raise SpecError("--young", problem)
        return quantity("--bending-rigidity", given, RIGIDITY).value
    if young is None:
        return None
    if diameter is None:
        raise SpecError("--young", f'needs --diameter, as "{DIAMETER.example}"')
    wide = quantity("--diameter", diameter, DIAMETER).value
    return bending_rigidity(quantity("--young", young, YOUNG).value, wide)
