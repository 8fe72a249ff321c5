"""`eulerplateau mesh`: make a mesh file from a mesh specification."""

from __future__ import annotations

from pathlib import Path

import click

from eulerplateau.cli.options import writes_to


@click.command()
@click.argument("spec", type=click.Path(path_type=Path))
@writes_to(
    "The mesh file; its suffix chooses the format: .vtp .vtu .vtk .msh .off .ply ...",
    required=True,
)
@click.option("--quiet", is_flag=True, help="Print nothing but errors.")
def mesh(spec: Path, out: Path, quiet: bool) -> None:
    """Make the triangulated disk of SPEC (meshes/*.toml) with Gmsh and write it.

    SPEC may also be a mesh file, which is then checked and converted.
    """
    from eulerplateau.mesh import read_disk, write_mesh

    made = read_disk(spec)
    write_mesh(made, out)
    if not quiet:
        click.echo(
            f"{out}: {made.n_v} vertices, {len(made.triangles)} triangles, "
            f"{made.n_b} loop edges, L = {made.length:.6g}"
        )
