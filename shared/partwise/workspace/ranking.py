"""The order in which shapes are handed out: latest score first, of every kind of shape in turn.

Nothing here is on the way of somebody who claims a shape: ranks are written in pieces, while claims go on.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import islice
from typing import TypeVar

import numpy as np

from partwise.store.catalog import Catalog
from partwise.store.records import BY_NAME, Collection, Ordering
from partwise.workspace.choices import ScoreName
from partwise.workspace.shapes import PAGE
from partwise.workspace.workspace import Workspace

T = TypeVar("T")

BATCH = 64
"""Shapes that people label between two rankings, about."""

_ID_PAGE = 5_000
_RANKS_AT_ONCE = 200  # places that a claim cannot have for the moment that it takes to write them

_FIRST_BY_SCORE = 1_000  # behind the diversified ones, and with 29 bits of score before those that nothing ranked

_POOL = 4
"""As many candidates for each shape of a batch: the least certain, of which different ones are taken first."""


def rank_queue(workspace: Workspace, collection: Collection, score_name: str, *, descending: bool = True) -> int:
    """Ranks all that waits by its latest score, diversified; how many labels changed their place.

    The first `BATCH` shapes are taken from `_POOL` times as many with the highest scores, from each cluster in turn;
    the rest follow by score. Shapes without a score come after all others, the first shapes before any model exists.
    Only what changed is written: behind the first ones a shape's rank depends on its own score alone. Shapes that were
    sent back stay first, and what is held stays as it is.
    """
    catalog = workspace.catalog
    scored = _waiting_by_score(catalog, collection.id, score_name, descending)
    if not scored and catalog.latest_model(collection.id) is None:
        ranks = {first.shape_id: rank for rank, first in enumerate(catalog.first_shapes(collection.id), start=1)}
    else:
        pool = [shape_id for _, shape_id in scored[: BATCH * _POOL]]
        ranks = {shape_id: score_rank(value, descending=descending) for value, shape_id in scored}
        taken = diversified(pool, catalog.clusters(pool), BATCH)
        ranks.update({shape_id: rank for rank, shape_id in enumerate(taken, start=1)})
    in_order = sorted(ranks, key=ranks.__getitem__)
    catalog.record_ranking(collection.id, score_name)
    return sum(
        catalog.set_ranks(collection.id, {shape_id: ranks[shape_id] for shape_id in piece})
        for piece in _pieces(in_order, _RANKS_AT_ONCE)
    )


def score_rank(value: float, *, descending: bool = True) -> int:
    """The rank of a score behind the diversified ones: lower for higher scores, for lower ones if not `descending`.

    Equal for scores that differ by less than a millionth of their size.
    """
    bits = int(np.float32(value).view(np.uint32))
    ascending = (bits | 1 << 31) if bits < 1 << 31 else (1 << 32) - 1 - bits  # floats in order as whole numbers
    coarse = ascending >> 3
    return _FIRST_BY_SCORE + ((1 << 29) - 1 - coarse if descending else coarse)


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


def _waiting_by_score(
    catalog: Catalog, collection_id: int, score_name: str, descending: bool
) -> list[tuple[float, int]]:
    """Scores and ids of the shapes that wait, by score: as many numbers as shapes wait, no more is held."""
    scored: list[tuple[float, int]] = []
    after = 0
    while page := catalog.waiting_shapes(collection_id, after=after, limit=_ID_PAGE):
        scored.extend((score.value, shape_id) for shape_id, score in catalog.scores(page, score_name).items())
        after = page[-1]
    return sorted(scored, reverse=descending)


def _pieces(values: Iterable[T], size: int) -> Iterator[list[T]]:
    remaining = iter(values)
    while piece := list(islice(remaining, size)):
        yield piece
