"""Conformance: the table of shapes."""
# ruff: noqa: S101 # a test suite asserts

from collections.abc import Sequence

import pytest

from partwise.errors import NotFoundError
from partwise.store.catalog import Catalog
from partwise.store.records import (
    ANY_STAGE,
    BY_NAME,
    Collection,
    Holder,
    ListAnchor,
    NewFailure,
    NewScore,
    NewShape,
    NewStageRun,
    RevisionKind,
    ShapeFilter,
    ShapeOrder,
    ShapeState,
)
from partwise.store.reviews import NewReview, ReviewReason
from partwise.testing.catalog.samples import (
    N_FACES,
    add_collection,
    claim,
    label,
    mesh_hash,
    publish,
    publish_mesh,
    ready_shapes,
    save_model,
)
from partwise.testing.expect import raises

VALUES = (0.5, 0.9, 0.5, 0.1)


def _scored(catalog: Catalog, values: Sequence[float] = VALUES) -> tuple[Collection, list[int]]:
    """A collection whose shapes have these entropies, and one shape without."""
    collection, shape_ids = add_collection(catalog, len(values) + 1)
    model = save_model(catalog, collection.id)
    scores = [NewScore(shape_ids[i], model.id, "entropy", value) for i, value in enumerate(values)]
    catalog.record_done([], scores)
    return collection, shape_ids


def _named(catalog: Catalog, *names: str) -> tuple[Collection, list[int]]:
    """A collection of shapes with these names, each with a score."""
    collection = catalog.create_collection("things", ["body"])
    added = catalog.add_shapes(collection.id, [NewShape(name, "0" * 64, ".off") for name in names])
    shape_ids = [each.shape_id for each in added]
    model = save_model(catalog, collection.id)
    catalog.record_done([], [NewScore(i, model.id, "entropy", n % 3 / 3) for n, i in enumerate(shape_ids)])
    return collection, shape_ids


def _ids(catalog: Catalog, collection: Collection, where: ShapeFilter, order: ShapeOrder | None = None) -> list[int]:
    """All ids, read two at a time."""
    found: list[int] = []
    after: ListAnchor | None = None
    while page := catalog.list_shapes(collection.id, where=where, order=order, after=after, limit=2):
        found += [row.shape.id for row in page]
        after = page[-1].anchor
    return found


class ListingConformance:
    @pytest.mark.parametrize("descending", [False, True])
    def test_pages_in_order_of_ids(self, catalog: Catalog, descending: bool) -> None:
        collection, shape_ids = add_collection(catalog, 5)
        found = _ids(catalog, collection, ShapeFilter(), ShapeOrder(None, descending))
        assert found == sorted(shape_ids, reverse=descending)

    def test_pages_in_order_of_a_score(self, catalog: Catalog) -> None:
        collection, (a, b, c, d, _) = _scored(catalog)
        assert _ids(catalog, collection, ShapeFilter(), ShapeOrder("entropy")) == [d, a, c, b]
        assert _ids(catalog, collection, ShapeFilter(), ShapeOrder("entropy", descending=True)) == [b, c, a, d]
        assert _ids(catalog, collection, ShapeFilter(), ShapeOrder("bald")) == []

    @pytest.mark.parametrize("descending", [False, True])
    def test_pages_in_order_of_names(self, catalog: Catalog, descending: bool) -> None:
        collection, shape_ids = add_collection(catalog, 11)
        by_name = sorted(shape_ids, key=lambda i: f"{shape_ids.index(i)}.off", reverse=descending)
        assert _ids(catalog, collection, ShapeFilter(), ShapeOrder(BY_NAME, descending)) == by_name

    @pytest.mark.parametrize("name", [None, BY_NAME, "entropy"])
    @pytest.mark.parametrize("descending", [False, True])
    def test_ranks_count_as_the_pages_go(self, catalog: Catalog, name: str | None, descending: bool) -> None:
        collection, shape_ids = _scored(catalog)
        catalog.set_clusters(collection.id, dict.fromkeys(shape_ids[1:], 1))
        order = ShapeOrder(name, descending)
        for where in (ShapeFilter(), ShapeFilter(cluster=1)):
            listed = _ids(catalog, collection, where, order)
            assert catalog.count_shapes(collection.id, where=where, order=order) == len(listed)
            for rank in range(len(listed) + 1):
                found = catalog.shapes_from_rank(collection.id, rank, where=where, order=order, limit=2)
                assert [row.shape.id for row in found] == listed[rank : rank + 2]

    def test_scores_that_exist(self, catalog: Catalog) -> None:
        collection, (a, b, *_) = _scored(catalog)
        assert catalog.score_names(collection.id) == ["entropy"]
        model = save_model(catalog, collection.id)
        catalog.record_done([], [NewScore(i, model.id, "bald", 0.5) for i in (a, b)])
        assert catalog.score_names(collection.id) == ["bald", "entropy"]

    def test_tiles_say_whose_the_labels_are_and_who_is_at_them(self, catalog: Catalog) -> None:
        collection, (a, b) = ready_shapes(catalog, 2)
        revision = label(catalog, a)
        ben = catalog.add_person("ben")
        lease = claim(catalog, collection, ben)
        assert lease.shape_id == b
        tiles = catalog.shape_tiles([a, b, 99])
        assert tiles.keys() == {a, b}
        assert (tiles[a].revision_id, tiles[a].author_name, tiles[a].has_confirmed) == (revision.id, "ann", True)
        assert (tiles[a].n_faces, tiles[a].holders) == (N_FACES, ())
        assert tiles[b].holders == (Holder(ben.id, "ben", lease.expires_at),)

    def test_tiles_say_which_model_labelled_the_present_mesh(self, catalog: Catalog) -> None:
        _, (a, b) = ready_shapes(catalog, 2)
        about = {"mesh_hash": mesh_hash(a), "model_version": 3}
        catalog.record_done([NewStageRun(a, "evaluate", "e", summary=about)])
        catalog.record_done([NewStageRun(b, "refine", "r", summary={"mesh_hash": "another", "model_version": 3})])
        tiles = catalog.shape_tiles([a, b])
        assert (tiles[a].predicted_version, tiles[a].refined_version) == (3, None)
        assert (tiles[b].predicted_version, tiles[b].refined_version) == (None, None)

    def test_orderings_by_name(self, catalog: Catalog) -> None:
        collection, shape_ids = add_collection(catalog, 11)
        begun = catalog.begin_ordering(collection.id, BY_NAME)
        while catalog.extend_ordering(begun.id, limit=4):
            pass
        by_name = sorted(shape_ids, key=lambda i: f"{shape_ids.index(i)}.off")
        assert catalog.ordered_shapes(begun.id, 0) == by_name

    def test_a_row_says_what_the_table_shows(self, catalog: Catalog) -> None:
        collection, shape_ids = _scored(catalog)
        (row,) = catalog.list_shapes(collection.id, order=ShapeOrder("entropy", descending=True), limit=1)
        assert (row.shape, row.state) == (catalog.shape(shape_ids[1]), ShapeState.NEW)
        assert (row.value, row.model_version) == (0.9, 1)
        assert (row.author_id, row.cluster, row.failed_stage) == (None, None, None)

    def test_filters_meet_all_that_is_asked(self, catalog: Catalog) -> None:
        collection, (a, b, c, d, e) = _scored(catalog)
        for shape_id in (a, b):
            publish_mesh(catalog, shape_id)
        publish(catalog, [a, b, c])
        catalog.record_failure(NewFailure(d, "mesh", "k", "no faces"))
        author = label(catalog, a, labels=(1, 1, 1, 1, 1, 1)).author_id
        label(catalog, b, RevisionKind.REFERENCE)
        catalog.set_clusters(collection.id, {a: 7, b: 7, c: 8})
        expected = {
            ShapeFilter(state=ShapeState.CONFIRMED): [a],
            ShapeFilter(state=ShapeState.READY): [b, c],
            ShapeFilter(state=ShapeState.NEW): [e],
            ShapeFilter(failed_stage="mesh"): [d],
            ShapeFilter(failed_stage=ANY_STAGE): [d],
            ShapeFilter(part_id=1, state=ShapeState.CONFIRMED): [a],
            ShapeFilter(author_id=author): [a],
            ShapeFilter(part_id=1): [a],
            ShapeFilter(part_id=2): [],
            ShapeFilter(cluster=7): [a, b],
            ShapeFilter(cluster=7, state=ShapeState.READY): [b],
        }
        for where, ids in expected.items():
            assert _ids(catalog, collection, where) == ids
            assert _ids(catalog, collection, where, ShapeOrder(BY_NAME)) == ids
            assert _ids(catalog, collection, where, ShapeOrder("entropy")) == sorted(
                set(ids) - {e}, key=lambda i: (VALUES[(a, b, c, d).index(i)], i)
            )

    def test_names_are_searched_for_a_part_of_them(self, catalog: Catalog) -> None:
        collection, (a, b, c) = _named(catalog, "Chairs/Old_100%.off", "chairs/old-100.off", "mugs/é.OFF")
        expected = {
            "CHAIRS/": [a, b],
            "old": [a, b],
            ".off": [a, b, c],
            "d_1": [a],
            "100%": [a],
            "é": [c],
            "É": [],
            "/": [a, b, c],
        }
        for name, ids in expected.items():
            for order in (ShapeOrder(), ShapeOrder(BY_NAME), ShapeOrder("entropy")):
                where = ShapeFilter(name=name)
                assert sorted(_ids(catalog, collection, where, order)) == ids, (name, order)
                assert catalog.count_shapes(collection.id, where=where, order=order) == len(ids)
        assert _ids(catalog, collection, ShapeFilter(name="chairs/o_d")) == []
        assert _ids(catalog, collection, ShapeFilter(name="%")) == [a]

    @pytest.mark.parametrize("name", [None, BY_NAME, "entropy"])
    @pytest.mark.parametrize("descending", [False, True])
    def test_names_go_with_all_other_filters_and_orders(
        self, catalog: Catalog, name: str | None, descending: bool
    ) -> None:
        collection, shape_ids = _named(catalog, *(f"{kind}/{n}.off" for n in range(4) for kind in ("chair", "stool")))
        catalog.set_clusters(collection.id, dict.fromkeys(shape_ids[:5], 1))
        order, where = ShapeOrder(name, descending), ShapeFilter(name="CHAIR", cluster=1)
        everything = _ids(catalog, collection, ShapeFilter(), order)
        listed = _ids(catalog, collection, where, order)
        assert listed == [each for each in everything if each in (shape_ids[0], shape_ids[2], shape_ids[4])]
        found = catalog.shapes_from_rank(collection.id, 1, where=where, order=order)
        assert [row.shape.id for row in found] == listed[1:]

    def test_states_in_the_table_are_the_derived_ones(self, catalog: Catalog) -> None:
        collection, (a, b, c, d) = add_collection(catalog, 4)
        for shape_id in (a, b):
            publish_mesh(catalog, shape_id)
        name = publish(catalog, [a, b, c])
        first = label(catalog, a)
        label(catalog, b, RevisionKind.IMPORTED)
        self._agree(catalog, collection)
        review = catalog.add_review(first.id, NewReview(ReviewReason.MAP_BACK))
        catalog.record_failure(NewFailure(d, "mesh", "k", "no faces"))
        self._agree(catalog, collection)
        catalog.accept_review(review.id, first.author_id)
        catalog.clear_failures(collection.id)
        catalog.supersede_block(name)
        self._agree(catalog, collection)

    @staticmethod
    def _agree(catalog: Catalog, collection: Collection) -> None:
        rows = catalog.list_shapes(collection.id)
        assert {row.shape.id: row.state for row in rows} == catalog.shape_states([row.shape.id for row in rows])

    def test_parts_are_those_of_the_newest_labels(self, catalog: Catalog) -> None:
        collection, (shape_id,) = add_collection(catalog, 1)
        publish_mesh(catalog, shape_id)
        label(catalog, shape_id, labels=(1, 1, 1, 1, 1, 1))
        label(catalog, shape_id, labels=(2, 2, 2, 2, 2, 2))
        assert _ids(catalog, collection, ShapeFilter(part_id=1)) == []
        assert _ids(catalog, collection, ShapeFilter(part_id=2)) == [shape_id]

    def test_rows_of_given_shapes(self, catalog: Catalog) -> None:
        _, (a, *_, e) = _scored(catalog)
        found = catalog.listed_shapes([a, e, 99], "entropy")
        assert {shape_id: row.value for shape_id, row in found.items()} == {a: 0.5, e: None}

    def test_clusters_come_back(self, catalog: Catalog) -> None:
        collection, (a, b, c) = add_collection(catalog, 3)
        _, (foreign,) = add_collection(catalog, 1, "mugs")
        catalog.set_clusters(collection.id, {a: 0, b: 1, foreign: 5})
        assert catalog.clusters([a, b, c, foreign]) == {a: 0, b: 1}
        assert catalog.cluster_sizes(collection.id) == {0: 1, 1: 1}

    def test_an_ordering_is_jumped_into(self, catalog: Catalog) -> None:
        collection, (a, b, c, d, _) = _scored(catalog)
        assert catalog.ordering(collection.id, "entropy") is None
        begun = catalog.begin_ordering(collection.id, "entropy")
        while catalog.extend_ordering(begun.id, limit=3):
            assert catalog.ordering(collection.id, "entropy") is None
        ordering = catalog.ordering(collection.id, "entropy")
        assert ordering is not None
        assert (ordering.id, ordering.n_shapes) == (begun.id, 4)
        assert catalog.ordered_shapes(ordering.id, 1, 2) == [a, c]
        assert catalog.ordered_shapes(ordering.id, 0, 2, descending=True) == [b, c]
        assert catalog.ordered_shapes(ordering.id, 3, 9, descending=True) == [d]
        assert catalog.ordered_shapes(ordering.id, 9) == []

    def test_orderings_by_id_need_no_score(self, catalog: Catalog) -> None:
        collection, shape_ids = add_collection(catalog, 3)
        begun = catalog.begin_ordering(collection.id)
        assert [catalog.extend_ordering(begun.id, limit=2) for _ in range(3)] == [2, 1, 0]
        assert catalog.ordered_shapes(begun.id, 0) == shape_ids

    def test_newer_orderings_replace_older_ones(self, catalog: Catalog) -> None:
        collection, _ = add_collection(catalog, 3)
        ids = []
        for _ in range(2):
            begun = catalog.begin_ordering(collection.id)
            while catalog.extend_ordering(begun.id):
                pass
            ids.append(begun.id)
        assert [catalog.prune_orderings(limit=2) for _ in range(3)] == [2, 1, 0]
        newest = catalog.ordering(collection.id)
        assert newest is not None
        assert newest.id == ids[1]
        assert len(catalog.ordered_shapes(newest.id, 0)) == 3
        with raises(NotFoundError, "ordering"):
            catalog.ordered_shapes(ids[0], 0)

    def test_unknown_collections_are_refused(self, catalog: Catalog) -> None:
        with raises(NotFoundError, "99"):
            catalog.list_shapes(99)
        with raises(NotFoundError, "99"):
            catalog.begin_ordering(99)
