"""The command line `eulerplateau`; each command loads what it needs when it runs."""

from __future__ import annotations

import logging
import os
import sys
from typing import NoReturn

import click

from eulerplateau import __version__
from eulerplateau.cli.branches import branches
from eulerplateau.cli.catalogue import catalogue
from eulerplateau.cli.cell import cell
from eulerplateau.cli.collect import collect
from eulerplateau.cli.doctor import doctor
from eulerplateau.cli.ensemble import ensemble
from eulerplateau.cli.estimate import estimate
from eulerplateau.cli.examples import examples
from eulerplateau.cli.film import film
from eulerplateau.cli.fit import fit
from eulerplateau.cli.gallery import gallery
from eulerplateau.cli.live import live
from eulerplateau.cli.locus import locus
from eulerplateau.cli.mesh import mesh
from eulerplateau.cli.planar import planar
from eulerplateau.cli.plot import plot
from eulerplateau.cli.render import render
from eulerplateau.cli.sweep import sweep
from eulerplateau.errors import EulerPlateauError, OutputError
from eulerplateau.interruption import Interrupted, heed, stop_listening, working_on

_INTERRUPTED = 130

EXIT_CODES = """\b
Exit codes: 0 all is well; 1 a library is missing, or a case of an ensemble
died; 2 the specification or the arguments are wrong; 3 the mesh is wrong;
4 a load did not converge; 5 a file could not be read or written; 6 the
folder holds another run; 130, 143, 129 interrupted by SIGINT, SIGTERM,
SIGHUP."""


@click.group(epilog=EXIT_CODES, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="eulerplateau")
def commands() -> None:
    """Shapes of elastic loops spanned by soap films: the Euler-Plateau problem."""
    working_on(lambda: "")


commands.add_command(branches)
commands.add_command(catalogue)
commands.add_command(cell)
commands.add_command(collect)
commands.add_command(doctor)
commands.add_command(ensemble)
commands.add_command(estimate)
commands.add_command(examples)
commands.add_command(film)
commands.add_command(fit)
commands.add_command(gallery)
commands.add_command(live)
commands.add_command(locus)
commands.add_command(mesh)
commands.add_command(planar)
commands.add_command(plot)
commands.add_command(render)
commands.add_command(sweep)


def main() -> NoReturn:
    """Run the command line; every error a user can cause is one line and an exit code."""
    # None of pydantic's plugins is for what is read here; to look for them takes long.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    logging.basicConfig(format="eulerplateau: %(message)s", level=logging.WARNING)
    try:
        code = _code()
        stop_listening()
    except Interrupted as end:
        _say(str(end))
        code = end.code
    sys.exit(code)


def _code() -> int:
    """Carry out the command; return its exit code."""
    try:
        heed()
        try:
            code = commands.main(prog_name="eulerplateau", standalone_mode=False)
        except click.exceptions.Exit as end:
            code = end.exit_code
        _flush()
    except click.ClickException as error:
        error.show()
        code = error.exit_code
    except (click.Abort, KeyboardInterrupt):  # where nobody listens to signals
        _say("interrupted")
        code = _INTERRUPTED
    except EulerPlateauError as error:
        _say(str(error))
        code = error.exit_code
    except OSError as error:
        _say(f"{error.filename or 'a file'}: {error.strerror or error}")
        code = OutputError.exit_code
        # What could not be written is not tried again at the end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    return code if isinstance(code, int) else 0


def _flush() -> None:
    """See to it that what was said is written; raises OSError if it cannot be."""
    try:
        sys.stdout.flush()
    except OSError as error:
        error.filename = "standard output"
        raise


def _say(text: str) -> None:
    click.echo(f"eulerplateau: {text}", err=True)
