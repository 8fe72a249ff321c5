"""`eulerplateau gallery`: runs as one page to open in a browser or hand to a colleague."""

from __future__ import annotations

from pathlib import Path

import click

from eulerplateau.cli.options import writes_to


@click.command()
@click.argument(
    "folders", metavar="DIR...", nargs=-1, required=True, type=click.Path(path_type=Path)
)
@writes_to(
    "The page to write.",
    default=Path("gallery.html"),
    show_default=True,
)
@click.option("--quiet", is_flag=True, help="No summary: for batches.")
def gallery(folders: tuple[Path, ...], out: Path, quiet: bool) -> None:
    """Show the run folders DIR, of sweeps or branches, in one page.

    The page holds the diagram, every shape in 3D and the numbers of its row. It needs no
    server and no network: open it in a browser, on a computer or a phone.
    """
    from eulerplateau.mesh import write_whole
    from eulerplateau.pictures.gallery import collect, page

    shown = collect(folders)
    content = page(shown)
    write_whole(out, content)
    if not quiet:
        shapes = sum(len(exhibit.x) for exhibit in shown.exhibits)
        click.echo(
            f"{out}: {shapes} shapes of {len(shown.exhibits)} run(s), "
            f"{len(content) / 1e6:.1f} MB"
        )
