"""A shape's mesh in and out of the array store: its row in a block, or kept for ever because labels depend on it."""

from collections.abc import Mapping

import numpy as np
from safetensors import SafetensorError
from safetensors.numpy import load, save

from partwise.errors import NotFoundError, StoreError
from partwise.mesh import TriMesh
from partwise.store.array_store import ArrayStore
from partwise.store.catalog import ShapeCatalog
from partwise.store.records import Mesh


def mesh_arrays(mesh: TriMesh) -> dict[str, np.ndarray]:
    """The quantities of `block_kinds.MESH`: vertices (n, 3) float32 and faces (m, 3) uint32; the content hash stays."""
    return {"vertices": mesh.vertices.astype(np.float32), "faces": mesh.faces.astype(np.uint32)}


def read_mesh(arrays: ArrayStore, mesh: Mesh) -> TriMesh:
    """The mesh on record, from its kept copy if there is one, else from its block.

    Raises
    ------
    NotFoundError : it is in neither place.
    StoreError : the store cannot be read, or holds another mesh than the record says.
    """
    if mesh.kept_key is not None and (mesh.block_name is None or arrays.exists(mesh.kept_key)):
        found = _trimesh(_loaded(arrays.get_bytes(mesh.kept_key), mesh.kept_key))
    elif mesh.block_name is not None and mesh.row is not None:
        found = _trimesh(arrays.read_many(mesh.block_name, mesh.row, ("vertices", "faces")))
    else:
        raise NotFoundError(f"mesh {mesh.mesh_hash[:12]}… is no longer stored; preprocess shape {mesh.shape_id} again")
    if (stored := found.content_hash()) != mesh.mesh_hash:
        raise StoreError(
            f"shape {mesh.shape_id} must have mesh {mesh.mesh_hash[:12]}… but the store holds {stored[:12]}…; "
            "preprocess it again"
        )
    return found


def kept_mesh_key(mesh_hash: str) -> str:
    """Where the bytes of a mesh that somebody labelled are kept."""
    return f"kept/meshes/{mesh_hash}"


def keep_mesh(catalog: ShapeCatalog, arrays: ArrayStore, mesh: Mesh) -> None:
    """Keep the bytes of a mesh for ever; call it before labels on the mesh are committed. Safe to repeat.

    A remesh cannot be repeated bit by bit, so a mesh that carries labels is part of what people made.
    """
    key = kept_mesh_key(mesh.mesh_hash)
    if mesh.kept_key == key and arrays.exists(key):
        return
    arrays.put_bytes(key, save(mesh_arrays(read_mesh(arrays, mesh))))
    catalog.keep_mesh(mesh.mesh_hash, key)


def _trimesh(values: Mapping[str, np.ndarray]) -> TriMesh:
    return TriMesh(values["vertices"].astype(np.float64), values["faces"].astype(np.int64))


def _loaded(data: bytes, key: str) -> Mapping[str, np.ndarray]:
    try:
        return load(data)
    except SafetensorError as error:
        raise StoreError(f"{key} must be a safetensors file but: {error}; restore it from a backup") from error
