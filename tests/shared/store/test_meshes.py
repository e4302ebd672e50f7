"""Meshes through both stores: the same mesh comes back, and a labelled one outlives its block."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings

from partwise.errors import NotFoundError, StoreError
from partwise.mesh import TriMesh
from partwise.store.block_kinds import MESH
from partwise.store.meshes import keep_mesh, kept_mesh_key, mesh_arrays, read_mesh
from partwise.store.records import Mesh, NewBlock, NewMesh, NewStageRun
from partwise.store.sql_catalog import SqlCatalog
from partwise.store.zarr_store import ZarrArrayStore
from partwise.testing.catalog.samples import add_collection
from partwise.testing.meshes import meshes

_MESH = TriMesh(np.random.default_rng(0).random((5, 3)), np.array([[0, 1, 2], [2, 3, 4]]))


def _published(catalog: SqlCatalog, store: ZarrArrayStore) -> Mesh:
    _, (shape_id,) = add_collection(catalog, 1)
    address = store.write_block(MESH, [mesh_arrays(_MESH)])
    block = NewBlock(address.name, "mesh", 1, address.n_bytes, address.checksum)
    new = NewMesh(shape_id, _MESH.content_hash(), _MESH.n_vertices, _MESH.n_faces, 0)
    catalog.publish_block(block, [NewStageRun(shape_id, "mesh", "k1", 0)], meshes=[new])
    return catalog.mesh(shape_id, _MESH.content_hash())


@settings(max_examples=25, deadline=None)
@given(meshes())
def test_stored_arrays_keep_the_hash(mesh: TriMesh) -> None:
    values = mesh_arrays(mesh)
    assert TriMesh(values["vertices"], values["faces"]).content_hash() == mesh.content_hash()


def test_mesh_comes_back_from_its_block(catalog: SqlCatalog, store: ZarrArrayStore) -> None:
    found = read_mesh(store, _published(catalog, store))
    np.testing.assert_array_equal(found.faces, _MESH.faces)
    np.testing.assert_array_equal(found.vertices, _MESH.vertices.astype(np.float32))


def test_a_kept_mesh_outlives_its_block(catalog: SqlCatalog, store: ZarrArrayStore) -> None:
    mesh = _published(catalog, store)
    keep_mesh(catalog, store, mesh)
    kept = catalog.mesh(mesh.shape_id, mesh.mesh_hash)
    keep_mesh(catalog, store, kept)
    assert kept.kept_key == kept_mesh_key(mesh.mesh_hash)
    assert mesh.block_name is not None
    store.delete_block(mesh.block_name)
    assert read_mesh(store, kept).content_hash() == _MESH.content_hash()


def test_a_lost_kept_mesh_is_kept_again_from_its_block(catalog: SqlCatalog, store: ZarrArrayStore) -> None:
    mesh = _published(catalog, store)
    keep_mesh(catalog, store, mesh)
    store.delete(kept_mesh_key(mesh.mesh_hash))
    keep_mesh(catalog, store, catalog.mesh(mesh.shape_id, mesh.mesh_hash))
    assert store.exists(kept_mesh_key(mesh.mesh_hash))


def test_a_mesh_stored_nowhere_is_not_found(catalog: SqlCatalog, store: ZarrArrayStore) -> None:
    gone = dataclasses.replace(_published(catalog, store), block_name=None, row=None)
    with pytest.raises(NotFoundError, match="preprocess"):
        read_mesh(store, gone)


def test_another_mesh_than_on_record_is_refused(catalog: SqlCatalog, store: ZarrArrayStore) -> None:
    wrong = dataclasses.replace(_published(catalog, store), mesh_hash="0" * 64)
    with pytest.raises(StoreError, match="must have mesh 000000000000"):
        read_mesh(store, wrong)


def test_a_damaged_kept_mesh_is_refused(catalog: SqlCatalog, store: ZarrArrayStore) -> None:
    mesh = dataclasses.replace(_published(catalog, store), kept_key="kept/meshes/x")
    store.put_bytes("kept/meshes/x", b"not tensors")
    with pytest.raises(StoreError, match="backup"):
        read_mesh(store, mesh)
