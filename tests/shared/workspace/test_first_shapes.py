"""Selecting the first shapes: embedded, clustered, put on record."""

import numpy as np
import pytest
from safetensors.numpy import load

from partwise.errors import NotEnoughDataError
from partwise.testing.expect import raises
from partwise.testing.workspaces import ingest, publish_features, publish_meshes
from partwise.workspace import light_fields
from partwise.workspace.first_shapes import select_first_shapes
from partwise.workspace.progress import RunProgress


def test_the_selection_is_put_on_record(filled) -> None:
    filled.described()
    firsts = select_first_shapes(filled.workspace, filled.collection, 2, 1, seed=0)
    assert list(filled.workspace.catalog.first_shapes(filled.collection.id)) == firsts
    assert len({first.shape_id for first in firsts}) == 2
    assert [first.ordinal for first in firsts] == [0, 1]


def test_every_shape_can_be_asked_for(filled) -> None:
    filled.described()
    firsts = select_first_shapes(filled.workspace, filled.collection, 3, 1, seed=0)
    assert {first.shape_id for first in firsts} == set(filled.ids.values())


def test_the_same_seed_selects_the_same_shapes(filled) -> None:
    filled.described()
    once, again = (select_first_shapes(filled.workspace, filled.collection, 2, 1, seed=3) for _ in range(2))
    assert once == again


def test_a_new_selection_replaces_the_old_one(filled) -> None:
    filled.described()
    select_first_shapes(filled.workspace, filled.collection, 3, 1, seed=0)
    firsts = select_first_shapes(filled.workspace, filled.collection, 1, 1, seed=0)
    assert list(filled.workspace.catalog.first_shapes(filled.collection.id)) == firsts


def test_the_embedding_has_a_point_for_each_described_shape(filled) -> None:
    filled.described()
    select_first_shapes(filled.workspace, filled.collection, 2, 1, seed=0)
    embedding = filled.workspace.catalog.embedding(filled.collection.id)
    arrays = load(filled.workspace.arrays.get_bytes(embedding.key))
    assert arrays["shape_ids"].tolist() == list(filled.ids.values())
    assert len(arrays["points"]) == 3


def test_every_embedded_shape_is_in_a_cluster(filled) -> None:
    filled.described()
    firsts = select_first_shapes(filled.workspace, filled.collection, 2, 1, seed=0)
    clusters = filled.workspace.catalog.clusters(filled.ids.values())
    assert set(clusters) == set(filled.ids.values())
    assert {first.shape_id: first.cluster for first in firsts}.items() <= clusters.items()


def test_what_progress_raises_leaves_all_as_it_was(filled) -> None:
    def stop(_: RunProgress) -> None:
        raise KeyboardInterrupt

    filled.described()
    with pytest.raises(KeyboardInterrupt):
        select_first_shapes(filled.workspace, filled.collection, 2, 1, seed=0, on_progress=stop)
    assert filled.workspace.catalog.embedding(filled.collection.id) is None


def test_descriptors_are_read_in_batches(filled, monkeypatch: pytest.MonkeyPatch) -> None:
    filled.described()
    whole = _points(filled)
    monkeypatch.setattr(light_fields, "AT_ONCE", 2)
    np.testing.assert_allclose(_points(filled), whole, rtol=1e-4, atol=1e-2)  # of distances of some 30,000


def _points(filled) -> np.ndarray:
    select_first_shapes(filled.workspace, filled.collection, 2, 1, seed=0)
    embedding = filled.workspace.catalog.embedding(filled.collection.id)
    return load(filled.workspace.arrays.get_bytes(embedding.key))["points"]


def test_shapes_that_are_not_described_are_left_out(filled) -> None:
    filled.preprocessed()
    two = [filled.ids["a.off"], filled.ids["b.off"]]
    publish_features(filled.workspace, two, np.random.default_rng(0))
    firsts = select_first_shapes(filled.workspace, filled.collection, 2, 1, seed=0)
    assert {first.shape_id for first in firsts} == set(two)


@pytest.mark.parametrize(("n_clusters", "n_per_cluster"), [(4, 1), (2, 2), (1, 4)])
def test_too_few_described_shapes_say_how_many_there_are(filled, n_clusters: int, n_per_cluster: int) -> None:
    filled.described()
    with raises(NotEnoughDataError, "needs 4", "has 3", "partwise preprocess"):
        select_first_shapes(filled.workspace, filled.collection, n_clusters, n_per_cluster, seed=0)


def _twins(filled, names: list[str]) -> list[int]:
    """Shapes with the same descriptors."""
    ids = ingest(filled.workspace, filled.collection, dict.fromkeys(names, filled.meshes["a.off"]))
    publish_meshes(filled.workspace, dict.fromkeys(ids.values(), filled.meshes["a.off"]))
    for shape_id in ids.values():
        publish_features(filled.workspace, [shape_id], np.random.default_rng(7))
    return list(ids.values())


def test_one_of_two_twins_is_enough(filled) -> None:
    filled.described()
    twins = _twins(filled, ["x.off", "y.off"])
    firsts = select_first_shapes(filled.workspace, filled.collection, 4, 1, seed=0)
    selected = {first.shape_id for first in firsts}
    assert selected >= set(filled.ids.values())
    assert len(selected & set(twins)) == 1


@pytest.mark.filterwarnings("ignore::sklearn.exceptions.ConvergenceWarning")  # it says the same
def test_more_clusters_than_different_shapes_are_refused(filled) -> None:
    filled.described()
    _twins(filled, ["x.off", "y.off"])
    with raises(NotEnoughDataError, "only 4 differ", "ask for fewer"):
        select_first_shapes(filled.workspace, filled.collection, 5, 1, seed=0)


def test_nothing_but_twins_is_refused(filled) -> None:
    _twins(filled, ["x.off", "y.off"])
    with raises(NotEnoughDataError, "all 2 are equal"):
        select_first_shapes(filled.workspace, filled.collection, 2, 1, seed=0)
