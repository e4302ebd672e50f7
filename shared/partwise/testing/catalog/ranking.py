"""Conformance: the ranks that scores give to what waits."""
# ruff: noqa: S101 # a test suite asserts

from partwise.store.catalog import Catalog
from partwise.store.records import Collection, NewScore
from partwise.testing.catalog.samples import claim, confirm, ready_shapes, save_model


def _scored(catalog: Catalog, values: list[float]) -> tuple[Collection, list[int]]:
    """A collection whose shapes wait and have these entropies."""
    collection, ids = ready_shapes(catalog, len(values))
    _score(catalog, collection, dict(zip(ids, values, strict=True)))
    return collection, ids


def _score(catalog: Catalog, collection: Collection, values: dict[int, float]) -> None:
    model = save_model(catalog, collection.id)
    catalog.record_done([], [NewScore(i, model.id, "entropy", value) for i, value in values.items()])


class RankingConformance:
    def test_the_highest_that_waits_comes_first(self, catalog: Catalog) -> None:
        collection, (low, high, middle) = _scored(catalog, [0.1, 0.9, 0.5])
        assert catalog.highest_waiting(collection.id, "entropy", 9) == [high, middle, low]
        confirm(catalog, catalog.claim_shape(high, catalog.add_person("ann").id, 60))
        assert catalog.highest_waiting(collection.id, "entropy", 1) == [middle]
        assert catalog.highest_waiting(collection.id, "bald", 9) == []

    def test_a_shape_with_many_labels_to_come_is_named_once(self, catalog: Catalog) -> None:
        collection, (shape_id,) = _scored(catalog, [0.5])
        catalog.update_collection_settings(collection.id, {"labels_per_shape": 3})
        catalog.fill_queue(collection.id)
        assert catalog.highest_waiting(collection.id, "entropy", 9) == [shape_id]
        due = catalog.out_of_rank(collection.id, "entropy")
        assert list(due) == [shape_id]
        assert catalog.set_ranks(collection.id, due) == 3
        assert catalog.out_of_rank(collection.id, "entropy") == {}

    def test_higher_scores_are_due_lower_ranks(self, catalog: Catalog) -> None:
        values = [0.0, 1e-7, 0.2, 0.2000001, 0.9, 1.386, 11.0]
        collection, ids = _scored(catalog, values)
        due = catalog.out_of_rank(collection.id, "entropy")
        assert list(due) == ids[::-1]
        assert list(due.values()) == sorted(set(due.values()))

    def test_ranks_of_scores_lie_between_those_given_and_those_of_nothing(self, catalog: Catalog) -> None:
        collection, ids = _scored(catalog, [-1e9, 0.0, 16.0, 1e300])
        due = catalog.out_of_rank(collection.id, "entropy")
        assert due[ids[0]] == due[ids[1]] < 1_000_000_000
        assert due[ids[2]] == due[ids[3]] == 1_000

    def test_only_what_has_another_score_is_out_of_rank(self, catalog: Catalog) -> None:
        collection, (first, second, third) = _scored(catalog, [0.1, 0.2, 0.3])
        catalog.set_ranks(collection.id, catalog.out_of_rank(collection.id, "entropy"))
        _score(catalog, collection, {second: 0.4, third: 0.3})
        assert list(catalog.out_of_rank(collection.id, "entropy")) == [second]
        assert first not in catalog.out_of_rank(collection.id, "entropy")

    def test_what_was_sent_back_and_what_has_no_score_is_due_no_rank(self, catalog: Catalog) -> None:
        collection, (sent_back, scored, without) = ready_shapes(catalog, 3)
        _score(catalog, collection, {sent_back: 0.9, scored: 0.1})
        catalog.reopen_shape(sent_back, catalog.add_person("oscar").id)
        assert list(catalog.out_of_rank(collection.id, "entropy")) == [scored]
        assert without not in catalog.out_of_rank(collection.id, "entropy")

    def test_of_another_collection_nothing_is_out_of_rank(self, catalog: Catalog) -> None:
        _scored(catalog, [0.5])
        mugs, _ = ready_shapes(catalog, 1, "mugs")
        assert catalog.out_of_rank(mugs.id, "entropy") == {}
        assert catalog.highest_waiting(mugs.id, "entropy", 9) == []

    def test_what_is_held_is_ranked_and_stays_held(self, catalog: Catalog) -> None:
        collection, _ = _scored(catalog, [0.5, 0.6])
        lease = claim(catalog, collection, catalog.add_person("ann"))
        due = catalog.out_of_rank(collection.id, "entropy")
        assert lease.shape_id in due
        assert catalog.set_ranks(collection.id, due) == 2
        assert catalog.leases_of(lease.person_id) == [lease]
