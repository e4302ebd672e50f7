"""GLB (binary glTF 2.0): every triangle of the scene, placed by its nodes, in document order."""

import json
from collections.abc import Iterator
from typing import Any

import numpy as np
from jaxtyping import Float, Int, UInt8

from partwise.errors import FileFormatError
from partwise.io.gltf_accessors import GltfAccessors
from partwise.io.limits import ReadLimits
from partwise.io.weld import weld_equal_vertices
from partwise.mesh import TriMesh

_JSON_CHUNK, _BINARY_CHUNK = 0x4E4F534A, 0x004E4942
_TRIANGLES, _STRIP, _FAN = 4, 5, 6
_MAX_JSON_MARKS = 5_000_000  # each may be a value that takes many times its bytes
_LARGEST_TRANSFORM = 1e12  # map coordinates fit; what a damaged file holds does not


def parse_glb(data: bytes, limits: ReadLimits) -> TriMesh:
    """Mesh of the file's scene: nodes depth first in document order, their primitives in order, faces in order.

    Vertices at exactly one position after placement are welded (GLB repeats them along seams of normals and texture).
    Mirroring nodes have their faces' winding turned, as glTF asks. Skins and morph targets stay at rest; points and
    lines are left out.

    Raises
    ------
    FileFormatError : not GLB 2, truncated, compressed, pointing outside itself, or without triangles.
    """
    document, binary_chunk = unpack_glb(data)
    try:
        return _read_scene(document, GltfAccessors(document, binary_chunk), limits)
    except FileFormatError:
        raise
    except (KeyError, IndexError, TypeError, AttributeError, ValueError, OverflowError) as error:
        raise FileFormatError(
            f"a GLB's JSON must follow glTF 2.0 but {type(error).__name__} {error} came up; export the file again"
        ) from error


def format_glb(mesh: TriMesh, face_colours: UInt8[np.ndarray, "m 3"] | None = None) -> bytes:
    """One node, one primitive, float32. Face colours need three vertices a face, which reading welds again."""
    if face_colours is None:
        positions, indices = mesh.vertices.astype("<f4"), mesh.faces.astype("<u4")
    else:
        positions = mesh.vertices[mesh.faces].reshape(-1, 3).astype("<f4")
        indices = np.arange(len(positions), dtype="<u4").reshape(-1, 3)
    blocks = [positions.tobytes(), indices.tobytes()]
    accessors: list[dict[str, Any]] = [
        {"bufferView": 0, "componentType": 5126, "count": len(positions), "type": "VEC3"}
        | {"min": positions.min(axis=0).tolist(), "max": positions.max(axis=0).tolist()},
        {"bufferView": 1, "componentType": 5125, "count": indices.size, "type": "SCALAR"},
    ]
    primitive: dict[str, Any] = {"attributes": {"POSITION": 0}, "indices": 1, "mode": _TRIANGLES}
    if face_colours is not None:
        opaque = np.concatenate([face_colours, np.full((mesh.n_faces, 1), 255, dtype=np.uint8)], axis=1)
        blocks.append(np.repeat(opaque, 3, axis=0).tobytes())
        primitive["attributes"]["COLOR_0"] = 2
        accessors.append(
            {"bufferView": 2, "componentType": 5121, "normalized": True, "count": len(positions), "type": "VEC4"}
        )
    offsets = np.cumsum([0, *map(len, blocks)]).tolist()
    document = {
        "asset": {"version": "2.0", "generator": "partwise"},
        **{"scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "meshes": [{"primitives": [primitive]}]},
        **{"accessors": accessors, "buffers": [{"byteLength": offsets[-1]}]},
        "bufferViews": [
            {"buffer": 0, "byteOffset": offset, "byteLength": len(block)}
            for offset, block in zip(offsets, blocks, strict=False)
        ],
    }
    return pack_glb(document, b"".join(blocks))


def pack_glb(document: dict[str, Any], binary: bytes) -> bytes:
    """A GLB file of a glTF document and its buffer, whose length must be a multiple of four."""
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)  # chunks are padded to four bytes
    chunks = _chunk(_JSON_CHUNK, text) + _chunk(_BINARY_CHUNK, binary)
    return b"glTF" + np.array([2, 12 + len(chunks)], dtype="<u4").tobytes() + chunks


def _chunk(kind: int, content: bytes) -> bytes:
    return np.array([len(content), kind], dtype="<u4").tobytes() + content


def unpack_glb(data: bytes) -> tuple[dict[str, Any], bytes]:
    """The glTF document and the binary chunk of a GLB file; FileFormatError if it is none or is truncated."""
    if data[:4] != b"glTF":
        raise FileFormatError(f"a GLB file must start with glTF but starts with {data[:4]!r}; is the suffix right?")
    version, length = (int.from_bytes(data[k : k + 4], "little") for k in (4, 8))
    if version != 2:
        raise FileFormatError(f"a GLB file must be version 2 but is {version}; convert it")
    if length > len(data):
        raise FileFormatError(f"the header promises {length} bytes but there are {len(data)}; is the file truncated?")
    found: dict[int, bytes] = {}
    offset = 12
    while offset + 8 <= length:
        n_bytes, kind = (int.from_bytes(data[k : k + 4], "little") for k in (offset, offset + 4))
        if offset + 8 + n_bytes > length:
            raise FileFormatError(
                f"a chunk promises {n_bytes} bytes but {length - offset - 8} are left; is the file truncated?"
            )
        found.setdefault(kind, data[offset + 8 : offset + 8 + n_bytes])
        offset += 8 + n_bytes
    text = found.get(_JSON_CHUNK, b"")
    if sum(map(text.count, (b",", b"[", b"{"))) > _MAX_JSON_MARKS:
        raise FileFormatError(f"a GLB's JSON may have {_MAX_JSON_MARKS} commas and brackets; simplify the scene")
    try:
        document = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise FileFormatError(f"a GLB file must hold a JSON chunk but {error}; export the file again") from error
    if not isinstance(document, dict):
        raise FileFormatError("a GLB's JSON must be an object but is not; export the file again")
    return document, found.get(_BINARY_CHUNK, b"")


def _read_scene(document: dict[str, Any], accessors: GltfAccessors, limits: ReadLimits) -> TriMesh:
    vertices: list[np.ndarray] = []
    faces: list[np.ndarray] = []
    n_vertices = n_faces = 0
    for mesh_index, transform in _placed_meshes(document):
        for primitive in document["meshes"][mesh_index]["primitives"]:
            if primitive.get("mode", _TRIANGLES) not in (_TRIANGLES, _STRIP, _FAN):
                continue
            V, F = _read_primitive(primitive, accessors, limits)
            n_faces += len(F)
            vertices.append(V @ transform[:3, :3].T + transform[:3, 3])
            mirrored = np.linalg.det(transform[:3, :3]) < 0
            faces.append((F[:, [0, 2, 1]] if mirrored else F) + n_vertices)
            n_vertices += len(V)
            limits.check_faces(n_faces)  # before the next one: one mesh can be placed any number of times
            limits.check_vertices(n_vertices)
    if not n_faces:
        raise FileFormatError("a GLB scene must have triangles but has 0; is it empty, or lines and points?")
    return TriMesh(*weld_equal_vertices(np.concatenate(vertices), np.concatenate(faces)))


def _placed_meshes(document: dict[str, Any]) -> Iterator[tuple[int, Float[np.ndarray, "4 4"]]]:
    """Mesh index and world transform of each node with a mesh, depth first in document order."""
    nodes = document.get("nodes", [])
    if not nodes:
        yield from ((k, np.eye(4)) for k in range(len(document.get("meshes", []))))
        return
    if "scenes" in document:
        roots = document["scenes"][document.get("scene", 0)].get("nodes", [])
    else:
        children = {child for node in nodes for child in node.get("children", [])}
        roots = [k for k in range(len(nodes)) if k not in children]
    stack = [(k, np.eye(4)) for k in reversed(roots)]
    n_visited = 0
    while stack:
        index, parent = stack.pop()
        n_visited += 1
        if n_visited > len(nodes):  # in a tree each node is met once
            raise FileFormatError(f"nodes must form a tree but node {index} is met again; export the file again")
        transform = parent @ _local_transform(nodes[index])
        if "mesh" in nodes[index]:
            yield nodes[index]["mesh"], transform
        stack += [(child, transform) for child in reversed(nodes[index].get("children", []))]


def _local_transform(node: dict[str, Any]) -> Float[np.ndarray, "4 4"]:
    if "matrix" in node:
        return _numbers(node, "matrix", np.eye(4).ravel()).reshape(4, 4).T
    x, y, z, w = _numbers(node, "rotation", np.array([0.0, 0.0, 0.0, 1.0]))
    transform = np.eye(4)
    transform[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    transform[:3, :3] *= _numbers(node, "scale", np.ones(3))  # T·R·S: scale acts on columns
    transform[:3, 3] = _numbers(node, "translation", np.zeros(3))
    return transform


def _numbers(node: dict[str, Any], key: str, default: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
    """As many finite, sane numbers as the default has."""
    try:
        values = np.array(node.get(key, default), dtype=np.float64)
    except ValueError as error:
        raise FileFormatError(f"a node's {key} must be numbers but {error}; export the file again") from error
    if values.shape != default.shape or not (np.abs(values) < _LARGEST_TRANSFORM).all():
        raise FileFormatError(
            f"a node's {key} must be {len(default)} numbers below {_LARGEST_TRANSFORM:g} but is {values.tolist()}; "
            "export the file again"
        )
    return values


def _read_primitive(
    primitive: dict[str, Any], accessors: GltfAccessors, limits: ReadLimits
) -> tuple[Float[np.ndarray, "n 3"], Int[np.ndarray, "m 3"]]:
    if "KHR_draco_mesh_compression" in primitive.get("extensions", {}):
        raise FileFormatError("geometry must be uncompressed but uses Draco compression; export without it")
    limits.check_vertices(accessors.count(primitive["attributes"]["POSITION"]))
    if "indices" in primitive:
        limits.check_faces(accessors.count(primitive["indices"]) // 3)
    V = accessors.read(primitive["attributes"]["POSITION"]).astype(np.float64)
    if V.shape[1] != 3:
        raise FileFormatError(f"positions must have 3 columns but have {V.shape[1]}; export the file again")
    corners = np.arange(len(V)) if "indices" not in primitive else accessors.read(primitive["indices"]).ravel()
    F = _triangles(corners.astype(np.int64), primitive.get("mode", _TRIANGLES))
    if len(F) and int(F.max()) >= len(V):  # here, because after concatenation it would name another primitive's vertex
        raise FileFormatError(
            f"faces contain index {int(F.max())} but the primitive has {len(V)} vertices; export again"
        )
    return V, F


def _triangles(corners: Int[np.ndarray, " c"], mode: int) -> Int[np.ndarray, "m 3"]:
    if mode == _TRIANGLES:
        if len(corners) % 3:
            raise FileFormatError(f"triangles must have 3 corners each but there are {len(corners)}; export again")
        return corners.reshape(-1, 3)
    k = np.arange(max(len(corners) - 2, 0))
    if mode == _FAN:
        return np.stack([corners[k + 1], corners[k + 2], np.broadcast_to(corners[:1], k.shape)], axis=1)
    odd = k % 2  # every other triangle of a strip winds the other way
    return np.stack([corners[k], corners[k + 1 + odd], corners[k + 2 - odd]], axis=1)
