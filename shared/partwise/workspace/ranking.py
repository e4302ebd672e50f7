"""The order in which shapes are handed out: latest score first, of every kind of shape in turn.

Nothing here is on the way of somebody who claims a shape: ranks are written in pieces, while claims go on.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import islice
from typing import TypeVar

from partwise.store.catalog import Catalog
from partwise.store.records import Collection, Ordering
from partwise.workspace.shapes import PAGE
from partwise.workspace.workspace import Workspace

T = TypeVar("T")

BATCH = 64
"""Shapes that people label between two rankings, about."""

_ID_PAGE = 5_000
_RANKS_AT_ONCE = 200  # places that a claim cannot have for the moment that it takes to write them

_POOL = 4
"""As many candidates for each shape of a batch: the least certain, of which different ones are taken first."""


def rank_queue(workspace: Workspace, collection: Collection, score_name: str, *, descending: bool = True) -> int:
    """Ranks all that waits by its latest score, diversified; how many labels changed their place.

    The first `BATCH` shapes are taken from `_POOL` times as many with the highest scores, from each cluster in turn;
    the rest follow by score. Shapes without a score come after all others, the first shapes before any model exists.
    """
    catalog = workspace.catalog
    ranked = _waiting_by_score(catalog, collection.id, score_name, descending)
    if not ranked and catalog.latest_model(collection.id) is None:
        ranked = [first.shape_id for first in catalog.first_shapes(collection.id)]
    else:
        pool = ranked[: BATCH * _POOL]
        taken = diversified(pool, catalog.clusters(pool), BATCH)
        ranked = [*taken, *(shape_id for shape_id in ranked if shape_id not in set(taken))]
    places = enumerate(ranked, start=1)
    return sum(
        catalog.set_ranks(collection.id, {shape_id: rank for rank, shape_id in piece})
        for piece in _pieces(places, _RANKS_AT_ONCE)
    )


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
    """A new ordering to jump in, by a score or by id; the one it replaces is forgotten."""
    ordering = workspace.catalog.begin_ordering(collection.id, score_name)
    while workspace.catalog.extend_ordering(ordering.id):
        pass
    while workspace.catalog.prune_orderings():
        pass
    found = workspace.catalog.ordering(collection.id, score_name)
    return ordering if found is None else found


def _waiting_by_score(catalog: Catalog, collection_id: int, score_name: str, descending: bool) -> list[int]:
    """Ids of the shapes that wait, by score: as many numbers as shapes wait, no more is held."""
    waiting: set[int] = set()
    after = 0
    while page := catalog.waiting_shapes(collection_id, after=after, limit=_ID_PAGE):
        waiting.update(page)
        after = page[-1]
    scored: list[tuple[float, int]] = []
    for ids in _pieces(sorted(waiting), _ID_PAGE):
        scored.extend((score.value, shape_id) for shape_id, score in catalog.scores(ids, score_name).items())
    return [shape_id for _, shape_id in sorted(scored, reverse=descending)]


def _pieces(values: Iterable[T], size: int) -> Iterator[list[T]]:
    remaining = iter(values)
    while piece := list(islice(remaining, size)):
        yield piece
