"""The order of the queue: by score, of every kind in turn."""

from collections import Counter

from hypothesis import given, settings
from hypothesis import strategies as st

from partwise.store.records import NewClaim
from partwise.workspace import ranking
from partwise.workspace.ranking import (
    bring_into_order,
    diversified,
    materialise_ordering,
    rank_queue,
    refill_queue,
)


def test_clusters_take_turns_in_order_of_their_best() -> None:
    assert diversified([1, 2, 3, 4, 5], {1: 0, 2: 0, 3: 1, 4: 0, 5: 1}, 5) == [1, 3, 2, 5, 4]


def test_shapes_without_a_cluster_are_different_from_all() -> None:
    assert diversified([1, 2, 3], {1: 0, 2: 0}, 2) == [1, 3]


@settings(max_examples=30, deadline=None)
@given(st.lists(st.integers(0, 4), max_size=30), st.integers(0, 40))
def test_it_takes_as_many_as_wanted_and_evenly(clusters: list[int], n_wanted: int) -> None:
    taken = diversified(range(len(clusters)), dict(enumerate(clusters)), n_wanted)
    assert len(taken) == len(set(taken)) == min(n_wanted, len(clusters))
    counts, sizes = Counter(clusters[i] for i in taken), Counter(clusters)
    least = min((counts[cluster] for cluster in sizes if counts[cluster] < sizes[cluster]), default=None)
    assert least is None or max(counts.values(), default=0) <= least + 1


def _order(filled, name: str) -> list[int]:
    """The shapes in the order in which a new person gets them."""
    catalog = filled.workspace.catalog
    person = catalog.add_person(name)
    leases = [catalog.claim_next(NewClaim(filled.collection.id, person.id, 60, 0.5)) for _ in filled.ids]
    for lease in leases:
        assert lease is not None
        catalog.release_lease(lease.id, person.id)
    return [lease.shape_id for lease in leases if lease is not None]


def test_the_least_certain_shape_is_next(filled) -> None:
    filled.described()
    a, b, c = filled.ids.values()
    assert _order(filled, "ann") == [a, b, c]
    filled.evaluated()
    assert rank_queue(filled.workspace, filled.collection, "entropy") == 3
    assert _order(filled, "bob") == [c, b, a]
    assert rank_queue(filled.workspace, filled.collection, "entropy") == 0


def test_queue_and_table_are_brought_into_the_order_of_new_scores(filled) -> None:
    filled.described()
    filled.evaluated()
    bring_into_order(filled.workspace, filled.collection)
    a, b, c = filled.ids.values()
    assert _order(filled, "ann") == [c, b, a]
    catalog = filled.workspace.catalog
    assert [catalog.ordering(filled.collection.id, score) is None for score in (None, "entropy")] == [False, False]


def test_shapes_of_one_cluster_do_not_follow_on_each_other(filled) -> None:
    filled.described()
    filled.evaluated()
    a, b, c = filled.ids.values()
    filled.workspace.catalog.set_clusters(filled.collection.id, {a: 1, b: 0, c: 0})
    rank_queue(filled.workspace, filled.collection, "entropy")
    assert _order(filled, "ann") == [c, a, b]


def test_behind_the_first_ones_only_what_has_another_score_moves(filled, monkeypatch) -> None:
    monkeypatch.setattr(ranking, "BATCH", 1)
    filled.described()
    filled.evaluated()
    a, b, c = filled.ids.values()
    assert rank_queue(filled.workspace, filled.collection, "entropy") == 3
    assert _order(filled, "ann") == [c, b, a]
    filled.workspace.catalog.claim_shape(c, filled.workspace.catalog.add_person("bob").id, 60)
    assert rank_queue(filled.workspace, filled.collection, "entropy") == 0


def test_shapes_that_were_sent_back_stay_first(filled) -> None:
    filled.described()
    filled.evaluated()
    a, b, c = filled.ids.values()
    filled.workspace.catalog.reopen_shape(a, filled.workspace.catalog.add_person("oscar").id)
    rank_queue(filled.workspace, filled.collection, "entropy")
    assert _order(filled, "ann") == [a, c, b]


def test_an_ordering_is_made_anew(filled) -> None:
    filled.described()
    filled.evaluated()
    a, b, c = filled.ids.values()
    first = materialise_ordering(filled.workspace, filled.collection, "entropy")
    second = materialise_ordering(filled.workspace, filled.collection, "entropy")
    assert second.id > first.id
    assert filled.workspace.catalog.ordered_shapes(second.id, 0) == [a, b, c]
    assert materialise_ordering(filled.workspace, filled.collection).n_shapes == 3


def test_a_queue_is_refilled_for_more_labels(filled) -> None:
    filled.described()
    filled.workspace.catalog.update_collection_settings(filled.collection.id, {"labels_per_shape": 3})
    refill_queue(filled.workspace, filled.collection)
    assert filled.workspace.catalog.queue_depth(filled.collection.id).n_free == 9
