"""Which shapes a new model sees first."""

import numpy as np
import pytest
from safetensors.numpy import save

from partwise.store.records import NewModel, NewRevision, RevisionKind
from partwise.workspace.similarity import most_similar_first, nearest_distances, newly_confirmed


@pytest.fixture
def embedded(filled):
    """a and c lie close to each other, b far from both; what is embedded has no order."""
    filled.described()
    a, b, c = filled.ids.values()
    points = np.array([[10.0, 0.0], [0.0, 0.0], [1.0, 0.0]], dtype=np.float32)
    stored = save({"shape_ids": np.array([b, a, c], dtype=np.int64), "points": points})
    filled.workspace.arrays.put_bytes("embeddings/1/x.safetensors", stored)
    filled.workspace.catalog.set_embedding(filled.collection.id, "embeddings/1/x.safetensors")
    return filled


def _labelled(filled, shape_id: int) -> int:
    """The id of a new revision of a shape's labels."""
    catalog = filled.workspace.catalog
    mesh = catalog.meshes([shape_id])[shape_id]
    author = {person.name: person for person in catalog.list_people()}.get("ann") or catalog.add_person("ann")
    labels = np.ones(mesh.n_faces, dtype=np.uint16)
    new = NewRevision(shape_id, mesh.mesh_hash, RevisionKind.HUMAN, author.id, 1, labels, None)
    return catalog.add_revision(new).id


def _model(filled, *revision_ids: int):
    return filled.workspace.catalog.save_model(NewModel(filled.collection.id, {}, "models/x", revision_ids))


def test_the_most_similar_come_first(embedded) -> None:
    a, b, c = embedded.ids.values()
    model = _model(embedded, _labelled(embedded, c))
    assert most_similar_first(embedded.workspace, embedded.collection, model) == [c, a, b]


def test_what_the_model_before_knew_is_not_new(embedded) -> None:
    a, b, c = embedded.ids.values()
    first = _labelled(embedded, c)
    _model(embedded, first)
    model = _model(embedded, first, _labelled(embedded, b))
    assert newly_confirmed(embedded.workspace, embedded.collection, model) == [b]
    assert most_similar_first(embedded.workspace, embedded.collection, model) == [b, c, a]


def test_shapes_that_are_not_embedded_come_last(embedded) -> None:
    a, b, c = embedded.ids.values()
    stored = save({"shape_ids": np.array([b, c, 999], dtype=np.int64), "points": np.eye(3, dtype=np.float32)})
    embedded.workspace.arrays.put_bytes("embeddings/1/y.safetensors", stored)
    embedded.workspace.catalog.set_embedding(embedded.collection.id, "embeddings/1/y.safetensors")
    model = _model(embedded, _labelled(embedded, c))
    assert most_similar_first(embedded.workspace, embedded.collection, model) == [c, b, a]


def test_without_anything_new_they_come_by_id(embedded) -> None:
    model = _model(embedded)
    assert most_similar_first(embedded.workspace, embedded.collection, model) == sorted(embedded.ids.values())


def test_without_an_embedding_they_come_by_id(filled) -> None:
    filled.described()
    model = _model(filled, _labelled(filled, filled.ids["b.off"]))
    assert most_similar_first(filled.workspace, filled.collection, model) == sorted(filled.ids.values())


def test_an_embedding_that_was_lost_costs_only_the_order(embedded) -> None:
    embedded.workspace.catalog.set_embedding(embedded.collection.id, "embeddings/1/gone.safetensors")
    model = _model(embedded, _labelled(embedded, embedded.ids["b.off"]))
    assert most_similar_first(embedded.workspace, embedded.collection, model) == sorted(embedded.ids.values())


def test_distances_are_those_to_the_nearest() -> None:
    rng = np.random.default_rng(0)
    points, references = rng.normal(size=(5_000, 3)), rng.normal(size=(7, 3))
    expected = np.linalg.norm(points[:, None] - references, axis=2).min(axis=1)
    np.testing.assert_allclose(nearest_distances(points, references), expected, atol=1e-6)
