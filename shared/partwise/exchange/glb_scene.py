"""The glTF document of a labelled mesh: a node and a material for each part, and what puts faces back in order."""

from typing import Any

import numpy as np

from partwise import __version__
from partwise.exchange.described_json import parts_document, provenance_document
from partwise.exchange.labelled_mesh import DescribedMesh
from partwise.exchange.parts import PartEntry, Rgb
from partwise.unlabelled import NO_CLASS

FORMAT, FORMAT_VERSION = "partwise.glb", 1
UNLABELLED_NODE = "unlabelled"
_FLOAT, _UINT32 = 5126, 5125
_TRIANGLES = 4


class GlbScene:
    """A glTF document under construction: `document` and `binary` are what goes into the file."""

    def __init__(self, described: DescribedMesh, unlabelled: Rgb) -> None:
        self._blocks: list[bytes] = []
        self._views: list[dict[str, int]] = []
        self._accessors: list[dict[str, Any]] = []
        self._meshes: list[dict[str, Any]] = []
        self._materials: list[dict[str, Any]] = []
        self._described = described
        self._nodes = [self._part_node(part) for part in described.parts.parts]
        self._link_children()
        roots = [k for k, part in enumerate(described.parts.parts) if part.parent_id is None]
        if (described.labels == NO_CLASS).any():
            roots.append(len(self._nodes))
            self._nodes.append(self._node(UNLABELLED_NODE, NO_CLASS, unlabelled, {}))
        self._scene = {"nodes": roots, "extras": self._scene_extras()}

    @property
    def binary(self) -> bytes:
        return b"".join(self._blocks)

    @property
    def document(self) -> dict[str, Any]:
        return {
            "asset": {"version": "2.0", "generator": f"partwise {__version__}"},
            "scene": 0,
            "scenes": [self._scene],
            "nodes": self._nodes,
            "meshes": self._meshes,
            "materials": self._materials,
            "accessors": self._accessors,
            "bufferViews": self._views,
            "buffers": [{"byteLength": sum(map(len, self._blocks))}],
        }

    def _part_node(self, part: PartEntry) -> dict[str, Any]:
        return self._node(part.name, part.id, part.rgb, {"gloss": part.gloss, "colour": part.colour})

    def _node(self, name: str, part_id: int, rgb: Rgb, extras: dict[str, Any]) -> dict[str, Any]:
        """A node with the faces of a label, if it has any; vertices are those its faces use."""
        node: dict[str, Any] = {"name": name, "extras": {"part_id": part_id, **extras}}
        face_ids = np.flatnonzero(self._described.labels == part_id)
        if not len(face_ids):
            return node
        mesh = self._described.mesh
        vertex_ids, corners = np.unique(mesh.faces[face_ids], return_inverse=True)
        primitive = {
            "attributes": {"POSITION": self._add(mesh.vertices[vertex_ids].astype("<f4"), "VEC3")},
            "indices": self._add(corners.astype("<u4").ravel(), "SCALAR"),
            "material": len(self._materials),
            "mode": _TRIANGLES,
        }
        order = {"face_ids": self._add(face_ids.astype("<u4"), "SCALAR")}
        order["vertex_ids"] = self._add(vertex_ids.astype("<u4"), "SCALAR")
        self._materials.append(_material(name, rgb))
        node["mesh"] = len(self._meshes)
        node["extras"] |= order
        self._meshes.append({"name": name, "primitives": [primitive]})
        return node

    def _link_children(self) -> None:
        parts = self._described.parts.parts
        for part, node in zip(parts, self._nodes, strict=True):
            children = [k for k, child in enumerate(parts) if child.parent_id == part.id]
            if children:  # glTF forbids an empty list
                node["children"] = children

    def _scene_extras(self) -> dict[str, Any]:
        """Counts, hashes, schema and provenance, and the vertices that no face uses."""
        mesh = self._described.mesh
        extras: dict[str, Any] = {
            "format": FORMAT,
            "format_version": FORMAT_VERSION,
            "mesh_hash": mesh.content_hash(),
            "n_vertices": mesh.n_vertices,
            "n_faces": mesh.n_faces,
            "schema": parts_document(self._described.parts),
            "provenance": provenance_document(self._described.provenance),
        }
        loose = np.setdiff1d(np.arange(mesh.n_vertices), mesh.faces)
        if len(loose):
            extras["loose_vertex_ids"] = self._add(loose.astype("<u4"), "SCALAR")
            extras["loose_positions"] = self._add(mesh.vertices[loose].astype("<f4"), "VEC3")
        return extras

    def _add(self, values: np.ndarray, kind: str) -> int:
        """Appends an accessor; every block is a multiple of four bytes, as alignment asks."""
        accessor: dict[str, Any] = {
            "bufferView": len(self._views),
            "componentType": _FLOAT if values.dtype.kind == "f" else _UINT32,
            "count": len(values),
            "type": kind,
        }
        if values.dtype.kind == "f":
            accessor |= {"min": values.min(axis=0).tolist(), "max": values.max(axis=0).tolist()}
        block = values.tobytes()
        self._views.append({"buffer": 0, "byteOffset": sum(map(len, self._blocks)), "byteLength": len(block)})
        self._blocks.append(block)
        self._accessors.append(accessor)
        return len(self._accessors) - 1


def _material(name: str, rgb: Rgb) -> dict[str, Any]:
    """Matt and seen from both sides, because labelled meshes need not be closed or oriented."""
    factors = {"baseColorFactor": [*map(_linear, rgb), 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0}
    return {"name": name, "pbrMetallicRoughness": factors, "doubleSided": True}


def _linear(channel: int) -> float:
    """An sRGB byte as linear light, which is what glTF's colour factors are."""
    value = channel / 255
    return round(value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4, 9)
