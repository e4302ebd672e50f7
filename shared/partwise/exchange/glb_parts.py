"""GLB with a node for each part, named, coloured and nested as the parts are, and reading it back.

A node's `extras.part_id` says which part it is. Unlabelled faces are in a node "unlabelled" with part id −1; parts
without faces are nodes without a mesh. Nodes hold the vertices that their faces use, so an editor takes parts apart
cleanly. Accessors named in a node's extras (`face_ids`, `vertex_ids`) say where its faces and vertices were, so that
reading here gives the mesh back exactly, in its face order; other programs see faces part by part.

Source: glTF 2.0 specification. Differs: nothing; extras are left to applications there.
"""

from pathlib import Path
from typing import Any

import numpy as np

from partwise.errors import FileFormatError, LabelError, MeshError, ParameterError
from partwise.exchange.described_json import parts_from_document, provenance_from_document
from partwise.exchange.glb_scene import FORMAT, FORMAT_VERSION, GlbScene
from partwise.exchange.label_files import read_label_bytes
from partwise.exchange.labelled_mesh import DescribedMesh, LabelledMesh, check_mesh_hash
from partwise.exchange.parts import Rgb
from partwise.exchange.ply_labels import UNLABELLED_COLOUR
from partwise.io.atomic import write_atomically
from partwise.io.glb import pack_glb, unpack_glb
from partwise.io.gltf_accessors import GltfAccessors
from partwise.io.limits import ReadLimits
from partwise.mesh import TriMesh
from partwise.unlabelled import NO_CLASS

_ROW_BYTES = 12  # of a position or a face


def write_glb_parts(path: Path | str, described: DescribedMesh, unlabelled: Rgb = UNLABELLED_COLOUR) -> None:
    """Writes a node for each part of the schema, float32 positions.

    Raises
    ------
    ParameterError : coordinates beyond float32.
    StoreError : the file cannot be written.
    """
    largest = float(np.abs(described.mesh.vertices).max())
    if largest > float(np.finfo(np.float32).max):
        raise ParameterError(f"{path}: coordinates must fit float32 but reach {largest:.3g}; export as NPZ")
    scene = GlbScene(described, unlabelled)
    write_atomically(path, pack_glb(scene.document, scene.binary))


def read_glb_parts(path: Path | str, data: bytes | None = None) -> DescribedMesh:
    """What `write_glb_parts` wrote, faces in their original order.

    Raises
    ------
    FileFormatError : no GLB, truncated, not written by Partwise, edited since, or of absurd size.
    LabelError : the mesh is not the one that the labels were made on.
    """
    data = read_label_bytes(path, data)
    try:
        document, binary = unpack_glb(data)
        return _described(document, GltfAccessors(document, binary), len(binary))
    except MeshError as error:
        raise FileFormatError(f"{path}: {error}") from error
    except (FileFormatError, LabelError) as error:
        raise type(error)(f"{path}: {error}") from error
    except (KeyError, IndexError, TypeError, AttributeError, ValueError, OverflowError) as error:
        raise FileFormatError(
            f"{path}: a GLB's JSON must follow glTF 2.0 but {type(error).__name__} {error} came up; export it again"
        ) from error


def _described(document: dict[str, Any], accessors: GltfAccessors, n_bytes: int) -> DescribedMesh:
    extras = document["scenes"][0].get("extras", {})
    if (extras.get("format"), extras.get("format_version")) != (FORMAT, FORMAT_VERSION):
        raise FileFormatError(
            f"a GLB of parts must say {FORMAT} {FORMAT_VERSION} in its scene's extras but says "
            f"{str(extras.get('format'))[:40]!r}; other programs' files have no face order to read labels in"
        )
    n_vertices, n_faces = extras["n_vertices"], extras["n_faces"]
    ReadLimits().check_faces(n_faces)
    if max(n_faces, n_vertices) * _ROW_BYTES > n_bytes:  # before memory is taken
        raise FileFormatError(
            f"{n_faces} faces and {n_vertices} vertices must fit in {n_bytes} bytes but do not; was the file edited?"
        )
    vertices = np.full((n_vertices, 3), np.nan)
    faces = np.full((n_faces, 3), -1, dtype=np.int64)
    labels = np.full(n_faces, NO_CLASS, dtype=np.int64)
    n_placed = 0
    if "loose_vertex_ids" in extras:
        _place(vertices, accessors, extras["loose_vertex_ids"], accessors.read(extras["loose_positions"]))
    for node in document["nodes"]:
        if "mesh" not in node:
            continue
        primitive = document["meshes"][node["mesh"]]["primitives"][0]
        vertex_ids = _place(vertices, accessors, node["extras"]["vertex_ids"], _positions(accessors, primitive))
        corners = vertex_ids[accessors.read(primitive["indices"]).ravel()].reshape(-1, 3)
        face_ids = _place(faces, accessors, node["extras"]["face_ids"], corners)
        labels[face_ids] = node["extras"]["part_id"]
        n_placed += len(face_ids)
    if n_placed != n_faces or (faces < 0).any():
        raise FileFormatError(
            f"each of {n_faces} faces must be in one node but nodes have {n_placed} faces; was the file edited?"
        )
    mesh = TriMesh(vertices, faces)
    described = DescribedMesh(
        LabelledMesh(mesh, labels),
        parts_from_document(extras["schema"]),
        provenance_from_document(extras["provenance"]),
    )
    check_mesh_hash(mesh.content_hash(), str(extras["mesh_hash"]))
    return described


def _positions(accessors: GltfAccessors, primitive: dict[str, Any]) -> np.ndarray:
    return accessors.read(primitive["attributes"]["POSITION"])


def _place(into: np.ndarray, accessors: GltfAccessors, ids_accessor: int, rows: np.ndarray) -> np.ndarray:
    """Writes `rows` where the accessor's ids say, and returns the ids."""
    ids = accessors.read(ids_accessor).ravel()
    if ids.dtype.kind != "u" or len(ids) != len(rows) or (len(ids) and int(ids.max()) >= len(into)):
        raise FileFormatError(
            f"a node must name the place of each of its {len(rows)} rows among {len(into)} but names {len(ids)}; "
            "was the file edited?"
        )
    into[ids] = rows
    return ids.astype(np.int64)
