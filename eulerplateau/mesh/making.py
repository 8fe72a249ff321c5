"""A disk from a polygon in one call, as one makes it in Python."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from eulerplateau.mesh.generation import generate
from eulerplateau.mesh.spec import ALGORITHMS, MeshSpec

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from eulerplateau.mesh.disk import Disk


def mesh_polygon(
    polygon: str | ArrayLike,
    *,
    vertices: int | None = None,
    edge_length: float | None = None,
    algorithm: int | str = ALGORITHMS["frontal-delaunay"],
    grading: float = 1.0,
    **shape: Any,
) -> Disk:
    """Return the triangulated disk that a polygon bounds, made by Gmsh.

    Parameters
    ----------
    polygon : "regular", "stretched-hexagon", "lengthened-hexagon", "ellipse" or "circle"
        With what it needs as `shape`: sides=6; factor=2.0; half_length=2.2; aspect=1.5.
        Or its corners (n, 2), in any unit and in either direction.
    vertices : int
        Number of vertices to aim at, met within 2 % or one vertex; by default 474.
    edge_length : float
        Instead of `vertices`: length of the loop's edges, in the polygon's units.
    algorithm : int or str
        Gmsh's number of its triangulation, or one of its names here.
    grading : float
        Edge length deep inside over edge length at the loop.

    Raises
    ------
    SpecError : for an unknown polygon, one that crosses itself, or a wrong size
    MissingLibraryError : where Gmsh cannot be loaded; it says what to install
    """
    kind = {"kind": polygon} if isinstance(polygon, str) else {"kind": "corners"}
    corners = {} if isinstance(polygon, str) else {"points": polygon}
    spec: MeshSpec = MeshSpec(
        polygon={**kind, **corners, **shape},
        vertices=vertices,
        edge_length=edge_length,
        algorithm=algorithm,
        grading=grading,
    )
    return generate(spec)
