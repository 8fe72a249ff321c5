"""What a mesh specification (meshes/*.toml) may say."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, field_validator

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh import polygon
from eulerplateau.settings import Settings

# Gmsh's numbers for its triangulations of a plane region.
ALGORITHMS = {
    "mesh-adapt": 1,
    "delaunay": 5,
    "frontal-delaunay": 6,
    "frontal-delaunay-quads": 8,
    "parallelograms": 9,
}


# Far more than a loop of a mesh that can be solved has.
_MOST_SIDES = 10_000

# Each is compared with each: a file with more corners is the loop of a mesh already.
_MOST_CORNERS = 2_000

# A longer ellipse has no mesh of at most a million vertices that fits into it.
_LONGEST = 1_000.0


class RegularPolygon(Settings):
    """The regular polygon of circumradius 1 with a corner on the x axis."""

    kind: Literal["regular"]
    sides: int = Field(ge=3, le=_MOST_SIDES)

    def corners(self, edge_length: float) -> FloatArray:
        """Return the corners (n, 2), counter-clockwise."""
        return polygon.regular(self.sides)


class StretchedHexagon(Settings):
    """The regular hexagon of circumradius 1, stretched by `factor` along a corner axis."""

    kind: Literal["stretched-hexagon"]
    factor: float = Field(ge=1 / _LONGEST, le=_LONGEST)

    def corners(self, edge_length: float) -> FloatArray:
        """Return the corners (6, 2), counter-clockwise."""
        return polygon.stretched_hexagon(self.factor)


class LengthenedHexagon(Settings):
    """The hexagon (+-a, 0), (+-(a - 1/sqrt 3), +-1), a = `half_length`; regular at 1.1547.

    Its corners keep their 120 degrees; only the two sides along x grow.
    """

    kind: Literal["lengthened-hexagon"]
    half_length: float = Field(gt=0.58, le=_LONGEST)

    def corners(self, edge_length: float) -> FloatArray:
        """Return the corners (6, 2), counter-clockwise."""
        return polygon.lengthened_hexagon(self.half_length)


class Ellipse(Settings):
    """Points at equal arc length on the ellipse of semi-axes `aspect` and 1.

    Without `sides`, one side is one edge of the loop.
    """

    kind: Literal["ellipse"]
    aspect: float = Field(ge=1, le=_LONGEST)
    sides: int | None = Field(default=None, ge=3, le=_MOST_SIDES)

    def corners(self, edge_length: float) -> FloatArray:
        """Return the corners (n, 2), counter-clockwise."""
        fitting = round(polygon.ellipse_perimeter(self.aspect) / edge_length)
        return polygon.ellipse(self.aspect, self.sides or max(fitting, 3))


class Circle(Settings):
    """The regular polygon in a circle of radius 1; without `sides`, a side is an edge."""

    kind: Literal["circle"]
    sides: int | None = Field(default=None, ge=3, le=_MOST_SIDES)

    def corners(self, edge_length: float) -> FloatArray:
        """Return the corners (n, 2), counter-clockwise."""
        fitting = round(polygon.ellipse_perimeter(1.0) / edge_length)
        return polygon.regular(self.sides or max(fitting, 3))


class Corners(Settings):
    """A polygon given corner by corner, in any unit and in either direction."""

    kind: Literal["corners"]
    points: tuple[tuple[float, float], ...]

    @field_validator("points")
    @classmethod
    def _bounds_a_region(
        cls, points: tuple[tuple[float, float], ...]
    ) -> tuple[tuple[float, float], ...]:
        if len(points) > _MOST_CORNERS:
            raise ValueError(
                f"should be at most {_MOST_CORNERS} corners, not {len(points)}: "
                "give a loop so fine as a mesh file"
            )
        ordered = polygon.counter_clockwise(points).tolist()
        return tuple((x, y) for x, y in ordered)

    def corners(self, edge_length: float) -> FloatArray:
        """Return the corners (n, 2), counter-clockwise."""
        return polygon.counter_clockwise(self.points)


Polygon = Annotated[
    RegularPolygon | StretchedHexagon | LengthenedHexagon | Ellipse | Circle | Corners,
    Field(discriminator="kind"),
]


class MeshSpec(Settings):
    """A polygon and how finely to triangulate it.

    Attributes
    ----------
    vertices : int
        Number of vertices to aim at, met within 2 % or one vertex.
    edge_length : float
        Instead of `vertices`: length of the loop's edges, in the polygon's units. With
        neither given, the mesh aims at 474 vertices, the paper's size.
    algorithm : int
        Gmsh's number of its triangulation, or a name in `ALGORITHMS`.
    grading : float
        Edge length deep inside over edge length at the loop.
    """

    polygon: Polygon
    vertices: int | None = Field(default=None, ge=4)
    edge_length: float | None = Field(default=None, gt=0)
    algorithm: int = ALGORITHMS["frontal-delaunay"]
    grading: float = Field(default=1.0, ge=1)

    @field_validator("edge_length")
    @classmethod
    def _only_one_size(cls, edge_length: float | None, info: Any) -> float | None:
        if edge_length is not None and info.data.get("vertices") is not None:
            raise ValueError("should not be given together with vertices: keep one of them")
        return edge_length

    @field_validator("algorithm", mode="before")
    @classmethod
    def _known_algorithm(cls, given: Any) -> Any:
        number = ALGORITHMS.get(given, given) if isinstance(given, str) else given
        if number not in ALGORITHMS.values() or isinstance(number, bool):
            known = ", ".join(f"{number} ({name})" for name, number in ALGORITHMS.items())
            raise ValueError(f"should be one of Gmsh's {known}")
        return number
