"""Shapes that are described after the embedding was fitted are placed in it."""

import numpy as np
import pytest
from safetensors.numpy import save

from partwise.errors import NotFoundError
from partwise.testing.expect import raises
from partwise.testing.workspaces import ingest, publish_features, publish_meshes
from partwise.workspace.embedding_map import embedding_key, read_embedding_map
from partwise.workspace.first_shapes import select_first_shapes
from partwise.workspace.light_fields import light_fields
from partwise.workspace.placed_shapes import place_new_shapes, read_placed


@pytest.fixture
def embedded(filled):
    """Three shapes in two clusters."""
    filled.described()
    select_first_shapes(filled.workspace, filled.collection, 2, 1, seed=0)
    return filled


@pytest.fixture
def describe(embedded):
    """A further shape, described by numbers of a seed; its id."""

    def describe(name: str, seed: int) -> int:
        mesh = embedded.meshes["a.off"]
        (shape_id,) = ingest(embedded.workspace, embedded.collection, {name: mesh}).values()
        publish_meshes(embedded.workspace, {shape_id: mesh})
        publish_features(embedded.workspace, [shape_id], np.random.default_rng(seed))
        return shape_id

    return describe


def _placed(embedded):
    return read_placed(embedded.workspace, embedding_key(embedded.workspace, embedded.collection))


def test_a_new_shape_is_placed_and_the_others_stay(embedded, describe) -> None:
    before, shape_id = _placed(embedded), describe("new.off", 5)
    assert place_new_shapes(embedded.workspace, embedded.collection) == 1
    after = _placed(embedded)
    assert after.shape_ids.tolist() == [*before.shape_ids.tolist(), shape_id]
    np.testing.assert_array_equal(after.points[:3], before.points)
    np.testing.assert_array_equal(after.centres, before.centres)
    assert after.n_fitted == 3


def test_a_new_shape_lies_where_its_twin_does_and_in_its_cluster(embedded, describe) -> None:
    """The first of the shapes is described by the first numbers of its seed, and so is this one."""
    twin, shape_id = embedded.ids["a.off"], describe("twin.off", 0)
    place_new_shapes(embedded.workspace, embedded.collection)
    placed = _placed(embedded)
    row = placed.shape_ids.tolist().index(twin)
    np.testing.assert_allclose(placed.points[-1], placed.points[row], rtol=1e-4, atol=1e-2)
    clusters = embedded.workspace.catalog.clusters([twin, shape_id])
    assert clusters[shape_id] == clusters[twin]


def test_the_map_has_it(embedded, describe) -> None:
    before = embedding_key(embedded.workspace, embedded.collection)
    shape_id = describe("new.off", 5)
    place_new_shapes(embedded.workspace, embedded.collection)
    key = embedding_key(embedded.workspace, embedded.collection)
    assert key != before
    assert shape_id in read_embedding_map(embedded.workspace, key).shape_ids


def test_nothing_new_is_nothing_stored(embedded) -> None:
    before = embedding_key(embedded.workspace, embedded.collection)
    assert place_new_shapes(embedded.workspace, embedded.collection) == 0
    assert embedding_key(embedded.workspace, embedded.collection) == before


def test_the_one_before_is_kept_for_who_reads_it_and_older_ones_are_not(embedded, describe) -> None:
    keys = [embedding_key(embedded.workspace, embedded.collection)]
    read_embedding_map(embedded.workspace, keys[0])
    for seed in (5, 6):
        describe(f"{seed}.off", seed)
        place_new_shapes(embedded.workspace, embedded.collection)
        keys.append(embedding_key(embedded.workspace, embedded.collection))
    stored = set(embedded.workspace.arrays.list(f"embeddings/{embedded.collection.id}"))
    folder = keys[0].rpartition("/")[0]
    assert stored == {f"{folder}/embedding.safetensors", *keys[1:]}


def test_an_embedding_that_was_replaced_meanwhile_stays(embedded, describe, monkeypatch) -> None:
    describe("new.off", 5)
    workspace, collection = embedded.workspace, embedded.collection

    def fitted_meanwhile(*given):
        workspace.arrays.put_bytes("embeddings/1/x/y.safetensors", b"another fit")
        workspace.catalog.set_embedding(collection.id, "embeddings/1/x/y.safetensors")
        return light_fields(*given)

    monkeypatch.setattr("partwise.workspace.placed_shapes.light_fields", fitted_meanwhile)
    assert place_new_shapes(workspace, collection) == 0
    assert embedding_key(workspace, collection) == "embeddings/1/x/y.safetensors"
    assert workspace.arrays.get_bytes("embeddings/1/x/y.safetensors") == b"another fit"


def test_shapes_that_another_worker_placed_meanwhile_stay_where_they_are(embedded, describe, monkeypatch) -> None:
    describe("new.off", 5)
    workspace, collection, n_calls = embedded.workspace, embedded.collection, []

    def placed_meanwhile(*given):
        n_calls.append(1)
        if len(n_calls) == 1:
            assert place_new_shapes(workspace, collection) == 1
        return light_fields(*given)

    monkeypatch.setattr("partwise.workspace.placed_shapes.light_fields", placed_meanwhile)
    assert place_new_shapes(workspace, collection) == 0
    assert len(_placed(embedded).shape_ids) == 4


def test_one_that_was_stored_without_centres_takes_no_more(embedded) -> None:
    key = "embeddings/1/old.safetensors"
    points, ids = np.zeros((1, 2), dtype=np.float32), np.array([1], dtype=np.int64)
    embedded.workspace.arrays.put_bytes(key, save({"points": points, "shape_ids": ids}))
    embedded.workspace.catalog.set_embedding(embedded.collection.id, key)
    assert read_placed(embedded.workspace, key) is None
    with raises(NotFoundError, "fit it anew"):
        place_new_shapes(embedded.workspace, embedded.collection)


def test_one_that_was_lost_is_none(embedded) -> None:
    assert read_placed(embedded.workspace, "embeddings/1/gone.safetensors") is None
