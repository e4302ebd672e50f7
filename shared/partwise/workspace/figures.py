"""How a collection is doing, in numbers that a graph over time can show: nothing of single shapes or people."""

from dataclasses import dataclass
from datetime import datetime

from partwise.store.records import Collection
from partwise.workspace.workspace import Workspace


@dataclass(frozen=True, slots=True)
class CollectionFigures:
    """n_free, n_held : labels that shapes wait for, and those in somebody's hands. oldest_s : for how long one waits.

    fresh_share : of the scored shapes, those scored by the newest model. Of that model `model_version`, `train_s`,
    `mean_score`, and `agreement`, how right people were on blind checks since. None where there is no such number.
    """

    n_free: int
    n_held: int
    oldest_s: float
    fresh_share: float | None
    model_version: int | None
    train_s: float | None
    mean_score: float | None
    agreement: float | None


def collection_figures(workspace: Workspace, collection: Collection, now: datetime) -> CollectionFigures:
    """Counted over the collection: for every minute or so, not for each page view."""
    catalog = workspace.catalog
    depth, score_name = catalog.queue_depth(collection.id), catalog.ranking_score(collection.id)
    newest = next(iter(catalog.model_rounds(collection.id, score_name)), None)
    scored = catalog.scored_by(collection.id, score_name)
    return CollectionFigures(
        n_free=depth.n_free,
        n_held=depth.n_held,
        oldest_s=0.0 if depth.oldest_at is None else (now - depth.oldest_at).total_seconds(),
        fresh_share=scored.get(newest.version, 0) / sum(scored.values()) if newest and scored else None,
        model_version=None if newest is None else newest.version,
        train_s=None if newest is None else newest.train_s,
        mean_score=None if newest is None else newest.mean_score,
        agreement=None if newest is None else newest.area_agreement,
    )


def stored_bytes(workspace: Workspace) -> int:
    """What the database and the blocks on record take, of all collections."""
    catalog = workspace.catalog
    return catalog.database_bytes() + sum(total.n_bytes for total in catalog.block_totals())
