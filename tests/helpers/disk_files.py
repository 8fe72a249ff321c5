"""One known disk in every variant of every format, as other programs write it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from eulerplateau.mesh.readers import __main__ as child, gmsh_files
from tests.helpers.shapes import hexagon_points

_PLANE, TRIANGLES = hexagon_points(3)
POINTS = np.column_stack([_PLANE, 0.3 * _PLANE[:, 0] * _PLANE[:, 1]])
# As text that says everything.
_PLACES = [" ".join(map(repr, map(float, place))) for place in POINTS]
_FACES = [" ".join(map(str, face)) for face in TRIANGLES.tolist()]
_N, _N_T = len(POINTS), len(TRIANGLES)


def lines(*parts: str | list[str]) -> bytes:
    every = [line for part in parts for line in ([part] if isinstance(part, str) else part)]
    return ("\n".join(every) + "\n").encode()


def off(
    head: str = f"OFF\n{_N} {_N_T} 0", vertex: str = "", face: str = "", comment: str = ""
) -> bytes:
    places = [f"{place}{vertex}{comment}" for place in _PLACES]
    return lines(head, places, [f"3 {corners}{face}" for corners in _FACES])


_PLY_HEAD = f"ply\nformat ascii 1.0\nelement vertex {_N}\n" + "\n".join(
    f"property double {axis}" for axis in "xyz"
)


def ply(
    name: str = "vertex_indices", extra: str = "", rest: str = "", colour: str = ""
) -> bytes:
    head = _PLY_HEAD + "".join(f"\nproperty uchar {c}" for c in colour)
    face = f"\nelement face {_N_T}\nproperty list uchar int {name}{extra}\nend_header"
    places = [place + " 7" * len(colour) for place in _PLACES]
    return lines(head + face, places, [f"3 {corners}{rest}" for corners in _FACES])


def ply_with_edges() -> bytes:
    head = f"{_PLY_HEAD}\nelement face {_N_T}\nproperty list uchar uint vertex_index"
    end = "\nelement edge 2\nproperty int vertex1\nproperty int vertex2\nend_header"
    return lines(head + end, _PLACES, [f"3 {corners}" for corners in _FACES], "0 1", "1 2")


def binary_ply(order: str) -> bytes:
    """Colours, double coordinates, and a texture list after the corners."""
    name = "little" if order == "<" else "big"
    head = _PLY_HEAD.replace("ascii", f"binary_{name}_endian") + "\nproperty uchar red\n"
    head += f"element face {_N_T}\nproperty list uchar int vertex_indices\n"
    head += "property list uchar float texcoord\nend_header\n"
    places = np.zeros(_N, np.dtype([("x", f"{order}f8", 3), ("red", "u1")]))
    places["x"] = POINTS
    fields = [("n", "u1"), ("v", f"{order}i4", 3), ("m", "u1"), ("t", f"{order}f4", 6)]
    faces = np.zeros(_N_T, np.dtype(fields))
    faces["n"], faces["v"], faces["m"] = 3, TRIANGLES, 6
    return head.encode() + places.tobytes() + faces.tobytes()


def mixed_binary_ply() -> bytes:
    """Texture lists of some faces only, so that rows are not equally long."""
    head = _PLY_HEAD.replace("ascii", "binary_little_endian")
    head += f"\nelement face {_N_T}\nproperty list uchar int vertex_indices\n"
    head += "property list uchar float texcoord\nend_header\n"
    body = POINTS.astype("<f8").tobytes()
    for number, face in enumerate(TRIANGLES):
        body += b"\3" + face.astype("<i4").tobytes()
        body += b"\6" + bytes(24) if number % 2 else b"\0"
    return head.encode() + body


def obj(corner: str = "{}", eol: str = "\n", back: bool = False) -> bytes:
    head = ["# a disk", "mtllib none.mtl", "o disk"]
    numbers = TRIANGLES - _N if back else TRIANGLES + 1
    faces = ["f " + " ".join(corner.format(v) for v in face) for face in numbers.tolist()]
    text = lines(head, [f"v {p}" for p in _PLACES], "vt 0 0", "vn 0 0 1", "s off", faces)
    return text.replace(b"\n", eol.encode())


def ascii_stl() -> bytes:
    def facet(face: Any) -> list[str]:
        inner = [f"vertex {_PLACES[corner]}" for corner in face]
        return ["facet normal 0 0 1", "outer loop", *inner, "endloop", "endfacet"]

    facets = [line for face in TRIANGLES for line in facet(face)]
    return lines("solid a disk", facets, "endsolid a disk")


def legacy(head: str = "", cells: str = "POLYGONS", metadata: str = "") -> bytes:
    grid = "UNSTRUCTURED_GRID" if cells == "CELLS" else "POLYDATA"
    start = f"# vtk DataFile Version 3.0\ndisk\nASCII\n{head}DATASET {grid}"
    faces = [f"{cells} {_N_T} {4 * _N_T}", *(f"3 {corners}" for corners in _FACES)]
    types = [f"CELL_TYPES {_N_T}", *["5"] * _N_T] if cells == "CELLS" else []
    colours = [f"POINT_DATA {_N}", "SCALARS a float", "LOOKUP_TABLE default", *["0"] * _N]
    points = [f"POINTS {_N} double", *_PLACES]
    return lines(start, points, metadata, faces, "", types, colours)


HAND_MADE: dict[str, bytes] = {
    "plain.off": off(),
    "one-line.off": off(f"OFF {_N} {_N_T} 0"),
    "no-keyword.off": off(f"{_N} {_N_T} 0"),
    "two-counts.off": off(f"OFF\n{_N} {_N_T}"),
    "comments.off": off(f"OFF # a disk\n# more\n\n{_N} {_N_T} 0 # counts", comment=" # v"),
    "face-colours.off": off(face=" 255 0 0"),
    "face-map.off": off(face=" 3"),
    "colours.off": off(f"COFF\n{_N} {_N_T} 0", vertex=" 255 0 0 255", face=" 1 0 0 .5"),
    "normals.off": off(f"NOFF\n{_N} {_N_T} 0", vertex=" 0 0 1"),
    "both.off": off(f"CNOFF {_N} {_N_T} 0", vertex=" 0 0 1 255 0 0"),
    "texture.off": off(f"STOFF\n{_N} {_N_T} 0", vertex=" 0 1"),
    "windows.off": off().replace(b"\n", b"\r\n"),
    "indices.ply": ply(),
    "index.ply": ply("vertex_index"),
    "texture.ply": ply(extra="\nproperty list uchar float texcoord", rest=" 2 0 1"),
    "face-colour.ply": ply(extra="\nproperty uchar red", rest=" 9"),
    "colours.ply": ply(colour="rgba"),
    "edges.ply": ply_with_edges(),
    "comment.ply": ply().replace(b"1.0\n", b"1.0\ncomment from end_header\nobj_info 1\n"),
    "windows.ply": ply().replace(b"\n", b"\r\n"),
    "little.ply": binary_ply("<"),
    "big.ply": binary_ply(">"),
    "mixed.ply": mixed_binary_ply(),
    "plain.obj": obj(),
    "texture.obj": obj("{}/1"),
    "normals.obj": obj("{}//1"),
    "all.obj": obj("{}/1/1"),
    "backwards.obj": obj(back=True),
    "windows.obj": obj(eol="\r\n"),
    "continued.obj": obj().replace(b"f ", b"f \\\n"),
    "text.stl": ascii_stl(),
    "capitals.stl": ascii_stl().replace(b"\n", b"\r\n  "),
    "polygons.vtk": legacy(),
    "grid.vtk": legacy(cells="CELLS"),
    "field.vtk": legacy(metadata="FIELD FieldData 1\nTIME 1 1 double\n0.5"),
    "metadata.vtk": legacy(
        metadata="METADATA\nINFORMATION 1\nNAME a LOCATION b\nDATA 1\n\n"
    ),
}


def vtk_surface() -> Any:
    import pyvista

    surface: Any = pyvista.PolyData.from_regular_faces(POINTS, TRIANGLES)
    surface.point_data["height"] = POINTS[:, 2]
    surface.field_data["TIME"] = np.array([0.5])
    return surface


def write_vtk(path: Path, version: int, text: bool, grid: bool) -> None:
    """Legacy files, of version 4.2 or 5.1."""
    from vtkmodules.vtkIOLegacy import vtkPolyDataWriter, vtkUnstructuredGridWriter

    surface = vtk_surface()
    writer: Any = vtkUnstructuredGridWriter() if grid else vtkPolyDataWriter()
    writer.SetInputData(surface.cast_to_unstructured_grid() if grid else surface)
    writer.SetFileName(str(path))
    writer.SetFileVersion(version)
    writer.SetFileTypeToASCII() if text else writer.SetFileTypeToBinary()
    writer.Write()


def write_xml(path: Path, mode: str, compressor: str, big_endian: bool = False) -> None:
    """VTK's XML files, by the extension of `path`."""
    from vtkmodules import vtkIOXML

    grid = path.suffix == ".vtu"
    surface = vtk_surface()
    name = "vtkXMLUnstructuredGridWriter" if grid else "vtkXMLPolyDataWriter"
    writer: Any = getattr(vtkIOXML, name)()
    writer.SetInputData(surface.cast_to_unstructured_grid() if grid else surface)
    writer.SetFileName(str(path))
    getattr(writer, f"SetCompressorTypeTo{compressor}")()
    if big_endian:
        writer.SetByteOrderToBigEndian()
    if mode in ("raw", "base64"):
        writer.SetDataModeToAppended()
        writer.SetEncodeAppendedData(mode == "base64")
    else:
        writer.SetDataModeToAscii() if mode == "text" else writer.SetDataModeToBinary()
    writer.Write()


def let_gmsh_read_here(patch: pytest.MonkeyPatch) -> None:
    """Read .msh files in this process: of a whole file a child makes no other disk."""

    def read(_: str, path: str, target: str, *, timeout: float) -> str:
        child._read(Path(path), Path(target))
        return ""

    patch.setattr(child, "_limit_memory", lambda path: None)
    patch.setattr(gmsh_files, "failure_of_child", read)


def write_msh(
    path: Path, version: float, binary: bool, order: int = 1, variant: str = ""
) -> None:
    """Gmsh's files of a triangulated circle of radius 1 about the origin."""
    import gmsh

    gmsh.initialize(readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.option.setNumber("Mesh.Binary", binary)
        gmsh.option.setNumber("Mesh.SaveParametric", variant == "parametric")
        shape = gmsh.model.occ
        shape.addDisk(0, 0, 0, 1, 1)
        shape.synchronize()
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.4)
        gmsh.option.setNumber("Mesh.RecombineAll", variant == "quads")
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.setOrder(order)
        if variant == "partitioned":
            gmsh.model.mesh.partition(3)
        if variant == "groups":
            gmsh.model.addPhysicalGroup(2, [1])
        gmsh.write(str(path))
    finally:
        gmsh.finalize()
