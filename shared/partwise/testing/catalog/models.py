"""Conformance: models, the queue, the selection, the embedding."""
# ruff: noqa: S101 # a test suite asserts

from partwise.errors import NotFoundError, ParameterError
from partwise.store.catalog import Catalog
from partwise.store.records import FirstShape, NewModel, NewScore, QueueAnchor, ShapeState
from partwise.testing.catalog.samples import add_collection, label, publish, publish_mesh, save_model
from partwise.testing.expect import raises


def _scored(catalog: Catalog, values: list[float]) -> tuple[int, list[int]]:
    """A collection whose shapes have these entropies: its id and theirs."""
    collection, ids = add_collection(catalog, len(values))
    model = save_model(catalog, collection.id)
    catalog.record_done([], [NewScore(i, model.id, "entropy", value) for i, value in zip(ids, values, strict=True)])
    return collection.id, ids


class ModelConformance:
    def test_versions_count_within_the_collection(self, catalog: Catalog) -> None:
        chairs, _ = add_collection(catalog, 0, "chairs")
        mugs, _ = add_collection(catalog, 0, "mugs")
        versions = [save_model(catalog, each.id).version for each in (chairs, mugs, chairs)]
        assert versions == [1, 1, 2]

    def test_model_comes_back_with_what_it_was_trained_on(self, catalog: Catalog) -> None:
        collection, ids = add_collection(catalog, 2)
        for shape_id in ids:
            publish_mesh(catalog, shape_id)
        revisions = tuple(label(catalog, shape_id).id for shape_id in (ids[0], ids[0], ids[1]))
        saved = catalog.save_model(NewModel(collection.id, {"rate": 0.01}, "models/x", revisions))
        assert catalog.model(collection.id, 1) == saved
        assert (saved.n_shapes, saved.recipe) == (2, {"rate": 0.01})
        assert tuple(catalog.trained_on(saved.id)) == revisions
        with raises(NotFoundError, "99"):
            catalog.trained_on(99)

    def test_latest_model_is_the_newest(self, catalog: Catalog) -> None:
        collection, _ = add_collection(catalog, 0)
        assert catalog.latest_model(collection.id) is None
        first, second = (save_model(catalog, collection.id) for _ in range(2))
        assert catalog.latest_model(collection.id) == second
        assert catalog.models(collection.id) == [second, first]

    def test_models_come_in_pages(self, catalog: Catalog) -> None:
        collection, _ = add_collection(catalog, 0)
        saved = [save_model(catalog, collection.id) for _ in range(3)]
        page = catalog.models(collection.id, limit=2)
        assert page == [saved[2], saved[1]]
        assert catalog.models(collection.id, before=page[-1].version, limit=2) == [saved[0]]

    def test_a_model_of_unknown_labels_is_refused(self, catalog: Catalog) -> None:
        collection, _ = add_collection(catalog, 0)
        with raises(NotFoundError, "99"):
            catalog.save_model(NewModel(collection.id, {}, "models/x", (99,)))
        with raises(NotFoundError, "version 1"):
            catalog.model(collection.id, 1)

    def test_queue_orders_by_score_both_ways(self, catalog: Catalog) -> None:
        collection_id, ids = _scored(catalog, [0.2, 0.9, 0.5])
        down = [row.shape.id for row in catalog.queue(collection_id, "entropy")]
        up = [row.shape.id for row in catalog.queue(collection_id, "entropy", descending=False)]
        assert down == [ids[1], ids[2], ids[0]]
        assert up == down[::-1]

    def test_queue_pages_cover_ties_once(self, catalog: Catalog) -> None:
        collection_id, ids = _scored(catalog, [0.5, 0.1, 0.5, 0.5, 0.9])
        for descending in (True, False):
            seen: list[int] = []
            after: QueueAnchor | None = None
            while page := catalog.queue(collection_id, "entropy", descending=descending, limit=2, after=after):
                seen += [row.shape.id for row in page]
                after = page[-1].anchor
            assert len(seen) == len(ids)
            assert sorted(seen) == sorted(ids)

    def test_queue_says_state_and_model(self, catalog: Catalog) -> None:
        collection_id, ids = _scored(catalog, [0.1, 0.2, 0.3])
        publish(catalog, ids[1:2])
        publish_mesh(catalog, ids[2])
        label(catalog, ids[2])
        rows = catalog.queue(collection_id, "entropy", descending=False)
        assert [row.state for row in rows] == [ShapeState.NEW, ShapeState.READY, ShapeState.CONFIRMED]
        assert {row.model_version for row in rows} == {1}

    def test_queue_can_leave_out_what_is_confirmed(self, catalog: Catalog) -> None:
        collection_id, ids = _scored(catalog, [0.1, 0.2])
        publish(catalog, ids)
        publish_mesh(catalog, ids[1])
        label(catalog, ids[1])
        rows = catalog.queue(collection_id, "entropy", states=[ShapeState.READY])
        assert [row.shape.id for row in rows] == ids[:1]

    def test_queue_knows_only_its_collection_and_score(self, catalog: Catalog) -> None:
        collection_id, _ = _scored(catalog, [0.1])
        mugs, _ = add_collection(catalog, 1, "mugs")
        assert catalog.queue(mugs.id, "entropy") == []
        assert catalog.queue(collection_id, "bald") == []

    def test_selection_is_replaced_as_a_whole(self, catalog: Catalog) -> None:
        collection, ids = add_collection(catalog, 3)
        catalog.replace_first_shapes(collection.id, [FirstShape(ids[0], 0, 0), FirstShape(ids[1], 1, 1)])
        chosen = [FirstShape(ids[2], 0, 4), FirstShape(ids[0], 1, 2)]
        catalog.replace_first_shapes(collection.id, chosen[::-1])
        assert catalog.first_shapes(collection.id) == chosen

    def test_an_empty_selection_clears(self, catalog: Catalog) -> None:
        collection, ids = add_collection(catalog, 1)
        catalog.replace_first_shapes(collection.id, [FirstShape(ids[0], 0, 0)])
        catalog.replace_first_shapes(collection.id, [])
        assert catalog.first_shapes(collection.id) == []

    def test_a_selection_with_a_place_or_a_shape_twice_is_refused(self, catalog: Catalog) -> None:
        collection, ids = add_collection(catalog, 2)
        for twice in ([FirstShape(ids[0], 0, 0), FirstShape(ids[1], 0, 0)], [FirstShape(ids[0], i, 0) for i in (0, 1)]):
            with raises(ParameterError, "twice"):
                catalog.replace_first_shapes(collection.id, twice)

    def test_a_selection_of_another_collection_is_refused(self, catalog: Catalog) -> None:
        collection, _ = add_collection(catalog, 1)
        _, (mug,) = add_collection(catalog, 1, "mugs")
        with raises(ParameterError, str(mug)):
            catalog.replace_first_shapes(collection.id, [FirstShape(mug, 0, 0)])

    def test_the_embedding_set_last_is_current(self, catalog: Catalog) -> None:
        collection, _ = add_collection(catalog, 0)
        assert catalog.embedding(collection.id) is None
        for key in ("embeddings/1", "embeddings/2"):
            catalog.set_embedding(collection.id, key)
        current = catalog.embedding(collection.id)
        assert current is not None
        assert current.key == "embeddings/2"

    def test_an_embedding_replaces_only_the_one_that_it_was_made_from(self, catalog: Catalog) -> None:
        collection, _ = add_collection(catalog, 0)
        assert catalog.set_embedding(collection.id, "embeddings/1")
        assert not catalog.set_embedding(collection.id, "embeddings/3", replacing="embeddings/2")
        assert catalog.set_embedding(collection.id, "embeddings/2", replacing="embeddings/1")
        current = catalog.embedding(collection.id)
        assert current is not None
        assert current.key == "embeddings/2"
