"""Finding collections, shapes and their meshes."""

import numpy as np
import pytest

from partwise.errors import ConflictError, NotFoundError
from partwise.mesh import TriMesh
from partwise.store.records import Collection, NewShape, ShapeState
from partwise.testing.expect import raises
from partwise.testing.workspaces import publish_meshes
from partwise.workspace import shapes
from partwise.workspace.labelling import keep_mesh
from partwise.workspace.shapes import all_shapes, find_collection, find_shape, load_mesh, pages_of_shapes, shape_mesh
from partwise.workspace.workspace import Workspace


def test_the_only_collection_needs_no_name(workspace: Workspace, collection: Collection) -> None:
    assert find_collection(workspace, None) == collection


def test_a_collection_is_found_by_name(workspace: Workspace, collection: Collection) -> None:
    workspace.catalog.create_collection("chairs", ["seat"])
    assert find_collection(workspace, "mugs") == collection


def test_several_collections_need_a_name(workspace: Workspace, collection: Collection) -> None:
    workspace.catalog.create_collection("chairs", ["seat"])
    with raises(NotFoundError, "chairs, mugs", "--collection"):
        find_collection(workspace, None)


def test_no_collection_says_how_to_make_one(workspace: Workspace) -> None:
    with raises(NotFoundError, "has none", "partwise init"):
        find_collection(workspace, None)


def test_an_unknown_collection_names_those_there_are(workspace: Workspace, collection: Collection) -> None:
    with raises(NotFoundError, "'cups'", "mugs"):
        find_collection(workspace, "cups")


def test_a_shape_is_found_by_source_key_and_by_number(filled) -> None:
    shape = filled.shape("sub/c.off")
    assert find_shape(filled.workspace, filled.collection, "sub/c.off") == shape
    assert find_shape(filled.workspace, filled.collection, str(shape.id)) == shape


def test_an_unknown_shape_is_named(filled) -> None:
    with raises(NotFoundError, "'d.off'"):
        find_shape(filled.workspace, filled.collection, "d.off")


def test_a_shape_of_another_collection_is_not_found(filled) -> None:
    other = filled.workspace.catalog.create_collection("chairs", ["seat"])
    with raises(NotFoundError, "chairs"):
        find_shape(filled.workspace, other, str(filled.ids["a.off"]))


def test_shapes_come_page_by_page_in_order_of_id(filled, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shapes, "PAGE", 2)
    pages = list(pages_of_shapes(filled.workspace.catalog, filled.collection.id))
    assert [[shape.source_key for shape in page] for page in pages] == [["a.off", "b.off"], ["sub/c.off"]]


def test_shapes_can_be_of_one_state(filled) -> None:
    ready = all_shapes(filled.described().workspace.catalog, filled.collection.id, ShapeState.READY)
    assert [shape.source_key for shape in ready] == ["a.off", "b.off", "sub/c.off"]
    assert list(all_shapes(filled.workspace.catalog, filled.collection.id, ShapeState.NEW)) == []


def test_a_shape_without_a_mesh_says_what_to_run(filled) -> None:
    with raises(ConflictError, "a.off", "partwise preprocess"):
        shape_mesh(filled.workspace, filled.shape("a.off"))


def test_a_mesh_comes_back_from_its_block(filled) -> None:
    filled.preprocessed()
    mesh = load_mesh(filled.workspace, shape_mesh(filled.workspace, filled.shape("b.off")))
    assert np.array_equal(mesh.faces, filled.meshes["b.off"].faces)
    assert np.allclose(mesh.vertices, filled.meshes["b.off"].vertices)


def test_a_kept_mesh_outlives_its_block(filled) -> None:
    filled.preprocessed()
    shape = filled.shape("b.off")
    mesh = shape_mesh(filled.workspace, shape)
    keep_mesh(filled.workspace, mesh)
    filled.workspace.arrays.delete_block(mesh.block_name)
    assert load_mesh(filled.workspace, shape_mesh(filled.workspace, shape)).n_faces == mesh.n_faces


def test_the_newest_mesh_of_a_shape_counts(filled, tetrahedron: TriMesh) -> None:
    filled.preprocessed()
    publish_meshes(filled.workspace, {filled.ids["b.off"]: tetrahedron}, key="mesh-2")
    assert shape_mesh(filled.workspace, filled.shape("b.off")).mesh_hash == tetrahedron.content_hash()


def test_a_shape_that_is_not_in_the_catalog_has_no_mesh(workspace: Workspace, collection: Collection) -> None:
    workspace.catalog.add_shapes(collection.id, [NewShape("a.off", "0" * 64, ".off")])
    shape = workspace.catalog.shape_by_key(collection.id, "a.off")
    with pytest.raises(ConflictError):
        shape_mesh(workspace, shape)
