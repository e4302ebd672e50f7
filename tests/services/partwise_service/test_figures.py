"""Models and the embedding's map."""

import numpy as np
import pytest
from safetensors.numpy import save

from partwise.store.records import FirstShape, NewModel


@pytest.fixture
def embedded(workspace, mugs) -> str:
    """An embedding of the collection, its shapes in no order; its key."""
    ids = np.array([mugs.ids["sub/c.off"], mugs.ids["a.off"], mugs.ids["b.off"]], dtype=np.int64)
    points = np.array([[3, 30, 300], [1, 10, 100], [2, 20, 200]], dtype=np.float32)
    key = f"embeddings/{mugs.collection_id}/{'ab' * 32}.safetensors"
    workspace.arrays.put_bytes(key, save({"points": points, "shape_ids": ids}))
    workspace.catalog.set_embedding(mugs.collection_id, key)
    return key


def _path(mugs, ending: str) -> str:
    return f"/collections/{mugs.collection_id}/{ending}"


def test_models_are_listed(annotator, mugs) -> None:
    assert [model["version"] for model in annotator.get(_path(mugs, "models")).json()["items"]] == [1]


def test_models_come_in_pages_newest_first(annotator, workspace, mugs) -> None:
    workspace.catalog.save_model(NewModel(mugs.collection_id, {}, "models/2", ()))
    page = annotator.get(_path(mugs, "models"), params={"limit": 1}).json()
    assert ([model["version"] for model in page["items"]], page["next"]) == ([2], "2")
    rest = annotator.get(_path(mugs, "models"), params={"before": page["next"]}).json()
    assert ([model["version"] for model in rest["items"]], rest["next"]) == ([1], None)
    assert "revision_ids" not in rest["items"][0]


def test_before_there_is_an_embedding(annotator, mugs) -> None:
    assert annotator.get(_path(mugs, "embedding")).status_code == 404


def test_the_map_is_in_two_dimensions_by_shape(annotator, workspace, mugs, embedded) -> None:
    workspace.catalog.set_clusters(mugs.collection_id, {mugs.ids["b.off"]: 4})
    shown = annotator.get(_path(mugs, "embedding")).json()
    assert (shown["x"], shown["y"], shown["clusters"]) == ([1, 2, 3], [10, 20, 30], [None, 4, None])
    assert shown["shape_ids"] == [mugs.ids[key] for key in ("a.off", "b.off", "sub/c.off")]
    assert (shown["n_shapes"], shown["next"]) == (3, None)


def test_the_map_says_where_shapes_stand_and_which_come_first(annotator, workspace, mugs, embedded) -> None:
    workspace.catalog.replace_first_shapes(mugs.collection_id, [FirstShape(mugs.ids["b.off"], 0, 4)])
    shown = annotator.get(_path(mugs, "embedding")).json()
    states = workspace.catalog.shape_states(shown["shape_ids"])
    assert shown["states"] == [states[shape_id].value for shape_id in shown["shape_ids"]]
    assert shown["first_shape_ids"] == [mugs.ids["b.off"]]


def test_pages_of_the_map(annotator, mugs, embedded) -> None:
    first = annotator.get(_path(mugs, "embedding"), params={"limit": 2}).json()
    second = annotator.get(_path(mugs, "embedding"), params={"limit": 2, "after": first["next"]}).json()
    assert (first["x"], second["x"], second["next"]) == ([1, 2], [3], None)


def test_a_new_embedding_is_a_new_map(annotator, workspace, mugs, embedded) -> None:
    before = annotator.get(_path(mugs, "embedding")).json()
    key = embedded.replace("ab", "cd")
    one = np.array([mugs.ids["a.off"]], dtype=np.int64)
    workspace.arrays.put_bytes(key, save({"points": np.array([[7]], dtype=np.float32), "shape_ids": one}))
    workspace.catalog.set_embedding(mugs.collection_id, key)
    after = annotator.get(_path(mugs, "embedding")).json()
    assert (after["x"], after["y"]) == ([7], [0])
    assert after["embedding"] != before["embedding"]
