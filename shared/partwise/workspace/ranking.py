"""The order in which shapes are handed out: latest score first, of every kind of shape in turn.

Nothing here is on the way of somebody who claims a shape: ranks are written in pieces, while claims go on.
"""

from collections.abc import Mapping, Sequence
from itertools import islice

from partwise.store.records import BY_NAME, Collection, Ordering
from partwise.workspace.choices import ScoreName
from partwise.workspace.shapes import PAGE
from partwise.workspace.workspace import Workspace

BATCH = 64
"""Shapes that people label between two rankings, about."""

_RANKS_AT_ONCE = 200  # places that a claim cannot have for the moment that it takes to write them

_POOL = 4
"""As many candidates for each shape of a batch: the least certain, of which different ones are taken first."""


def rank_queue(workspace: Workspace, collection: Collection, score_name: str) -> int:
    """Ranks all that waits by its latest score, diversified; how many labels changed their place.

    The first `BATCH` shapes are taken from `_POOL` times as many with the highest scores, from each cluster in turn;
    the rest follow by score. Shapes without a score come after all others, the first shapes before any model exists.
    Only what changed is read and written: behind the first ones a shape's rank depends on its own score alone. Shapes
    that were sent back stay first, and what is held stays as it is.
    """
    catalog = workspace.catalog
    pool = catalog.highest_waiting(collection.id, score_name, BATCH * _POOL)
    if not pool and catalog.latest_model(collection.id) is None:
        first = [first.shape_id for first in catalog.first_shapes(collection.id)]
    else:
        first = diversified(pool, catalog.clusters(pool), BATCH)
    catalog.record_ranking(collection.id, score_name)
    ranks = {shape_id: rank for rank, shape_id in enumerate(first, start=1)}
    for shape_id, rank in catalog.out_of_rank(collection.id, score_name).items():
        ranks.setdefault(shape_id, rank)
    remaining, n_moved = iter(ranks.items()), 0
    while piece := dict(islice(remaining, _RANKS_AT_ONCE)):  # nobody waits for all of them
        n_moved += catalog.set_ranks(collection.id, piece)
    return n_moved


def diversified(ranked: Sequence[int], clusters: Mapping[int, int], n_wanted: int) -> list[int]:
    """The first `n_wanted` of a ranking with the clusters in turn, each one's best first.

    Clusters come in the order of their best shape. Shapes without a cluster are each a cluster of their own.
    """
    lines: dict[object, list[int]] = {}
    for shape_id in ranked:
        lines.setdefault(clusters.get(shape_id, ("alone", shape_id)), []).append(shape_id)
    taken: list[int] = []
    turn = 0
    while len(taken) < min(n_wanted, len(ranked)):
        taken.extend(line[turn] for line in lines.values() if turn < len(line))
        turn += 1
    return taken[:n_wanted]


def refill_queue(workspace: Workspace, collection: Collection) -> None:
    """Brings the queue in line with `labels_per_shape`, after that was changed."""
    after: int | None = 0
    while after is not None:
        after = workspace.catalog.fill_queue(collection.id, after=after, limit=PAGE)


def materialise_ordering(workspace: Workspace, collection: Collection, score_name: str | None = None) -> Ordering:
    """A new ordering to jump in, by a score, by name or by id; the one it replaces is forgotten."""
    ordering = workspace.catalog.begin_ordering(collection.id, score_name)
    while workspace.catalog.extend_ordering(ordering.id):
        pass
    while workspace.catalog.prune_orderings():
        pass
    found = workspace.catalog.ordering(collection.id, score_name)
    return ordering if found is None else found


def make_orderings(workspace: Workspace, collection: Collection) -> None:
    """Makes the orders anew in which one jumps about the table of shapes: by id, name and each score there is."""
    has_scores = workspace.catalog.latest_model(collection.id) is not None
    for score in (None, BY_NAME, *(ScoreName if has_scores else ())):
        materialise_ordering(workspace, collection, score)


def bring_into_order(workspace: Workspace, collection: Collection) -> None:
    """Ranks the queue, and makes the table's orders anew: after shapes have become ready, were chosen or scored."""
    rank_queue(workspace, collection, ScoreName.ENTROPY)
    make_orderings(workspace, collection)
