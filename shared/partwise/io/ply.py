"""PLY meshes: vertices, faces and per-face integer properties such as labels."""

import numpy as np
from jaxtyping import Int, UInt8

from partwise.errors import FileFormatError
from partwise.io.limits import ReadLimits
from partwise.io.ply_elements import PlyElement, PlyHeader, PlyList, PlyTable, parse_elements, parse_header
from partwise.io.polygons import fan_triangles
from partwise.mesh import TriMesh

_FLOAT64_WHOLE_LIMIT = 2.0**53
_DEFAULT_LIMITS = ReadLimits()
_CORNER_NAMES = ("vertex_indices", "vertex_index")


def parse_ply(data: bytes, limits: ReadLimits) -> TriMesh:
    """Mesh of an ASCII or binary PLY file, faces in file order. Polygons become fans; other properties are read over.

    Raises
    ------
    FileFormatError : not PLY, truncated, without vertex positions or faces, or over a limit.
    """
    header = parse_header(data)
    _check_declared(header, limits)
    tables = parse_elements(data, header, limits)
    vertex = tables["vertex"]
    columns = [vertex.get(axis) for axis in "xyz"]
    if not all(isinstance(column, np.ndarray) for column in columns):
        raise FileFormatError(f"vertices must have numbers x, y and z but have {sorted(vertex)}; export positions")
    corners = _corners(tables["face"])
    limits.check_faces(int(np.maximum(corners.lengths - 2, 0).sum()))
    faces = fan_triangles(corners.lengths, _whole(corners.values, "vertex indices"))
    return TriMesh(np.stack([np.asarray(column, dtype=np.float64) for column in columns], axis=1), faces)


def parse_ply_face_property(data: bytes, name: str, limits: ReadLimits = _DEFAULT_LIMITS) -> Int[np.ndarray, " p"]:
    """One whole number per face as the file has faces, (p,) int64; p exceeds the triangles' number if polygons do.

    Raises
    ------
    FileFormatError : the property is missing, is a list, or holds fractions; the file is over a limit.
    """
    header = parse_header(data)
    _check_records(header, limits)
    face = parse_elements(data, header, limits).get("face", {})
    column = face.get(name)
    if not isinstance(column, np.ndarray):
        raise FileFormatError(f"faces must have a number {name!r} but have {sorted(face)}; export the labels into it")
    return _whole(column, f"face property {name}")


def format_ply(
    mesh: TriMesh,
    face_colours: UInt8[np.ndarray, "m 3"] | None = None,
    face_labels: Int[np.ndarray, " m"] | None = None,
) -> bytes:
    """Binary little-endian PLY: float32 positions, int32 corners, then `red green blue` and int32 `label` if given."""
    fields: list[tuple[str, str] | tuple[str, str, tuple[int]]] = [("n", "u1"), ("corners", "<i4", (3,))]
    lines = [
        *("ply", "format binary_little_endian 1.0", "comment partwise", f"element vertex {mesh.n_vertices}"),
        *("property float x", "property float y", "property float z"),
        *(f"element face {mesh.n_faces}", "property list uchar int vertex_indices"),
    ]
    if face_colours is not None:
        fields.append(("colour", "u1", (3,)))
        lines += [f"property uchar {channel}" for channel in ("red", "green", "blue")]
    if face_labels is not None:
        fields.append(("label", "<i4"))
        lines.append("property int label")
    records = np.zeros(mesh.n_faces, dtype=np.dtype(fields))
    records["n"] = 3
    records["corners"] = mesh.faces
    if face_colours is not None:
        records["colour"] = face_colours
    if face_labels is not None:
        records["label"] = face_labels
    header = "\n".join([*lines, "end_header", ""]).encode("ascii")
    return header + mesh.vertices.astype("<f4").tobytes() + records.tobytes()


def _check_declared(header: PlyHeader, limits: ReadLimits) -> None:
    declared: dict[str, PlyElement] = {element.name: element for element in header.elements}
    if "vertex" not in declared or "face" not in declared:
        remedy = "expand the strips first" if "tristrips" in declared else "is it a point cloud?"
        raise FileFormatError(f"a PLY mesh must have elements vertex and face but has {sorted(declared)}; {remedy}")
    limits.check_faces(declared["face"].n_records)
    limits.check_vertices(declared["vertex"].n_records)
    _check_records(header, limits)


def _check_records(header: PlyHeader, limits: ReadLimits) -> None:
    for element in header.elements:
        if element.n_records > limits.max_vertices:
            raise FileFormatError(
                f"an element may have {limits.max_vertices} records but {element.name[:80]!a} has {element.n_records}; "
                "drop what is not needed or raise max_faces"
            )


def _corners(face: PlyTable) -> PlyList:
    for name in _CORNER_NAMES:
        corners = face.get(name)
        if isinstance(corners, PlyList):
            return corners
    raise FileFormatError(f"faces must have a list {_CORNER_NAMES[0]} but have {sorted(face)}; export the faces again")


def _whole(values: np.ndarray, what: str) -> Int[np.ndarray, " n"]:
    is_whole = (np.abs(values) < _FLOAT64_WHOLE_LIMIT) & (values == np.trunc(values))
    if values.dtype.kind == "f" and not is_whole.all():
        raise FileFormatError(f"{what} must be whole numbers but some are not; is the file damaged?")
    return values.astype(np.int64)
