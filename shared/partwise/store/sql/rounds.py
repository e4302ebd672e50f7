"""Model by model: how it scored, and how right people were while it was the newest."""

from bisect import bisect_right
from collections.abc import Iterable
from math import fsum

from sqlalchemy import Connection, select

from partwise.store import tables as t
from partwise.store.records import ModelRound, NewScore
from partwise.store.sql.collections import schema_version
from partwise.store.sql.dialect import insert_for


def tally_scores(connection: Connection, scores: Iterable[NewScore]) -> None:
    """Counts scores to their models: newer models' take their place, the tally stays."""
    values: dict[tuple[int, str], list[float]] = {}
    for score in scores:
        values.setdefault((score.model_id, score.name), []).append(score.value)
    tally = t.score_tally
    for (model_id, name), given in sorted(values.items()):
        new = insert_for(connection, tally).values(model_id=model_id, name=name, n_scores=len(given), total=fsum(given))
        sums = {
            "n_scores": tally.c.n_scores + new.excluded.n_scores,
            "total": tally.c.total + new.excluded.total,
        }
        connection.execute(new.on_conflict_do_update(index_elements=["model_id", "name"], set_=sums))


def model_rounds(connection: Connection, collection_id: int, score_name: str) -> list[ModelRound]:
    schema_version(connection, collection_id)
    model, tally = t.model.c, t.score_tally.c
    is_scored = (tally.model_id == model.id) & (tally.name == score_name)
    columns = (model.version, model.trained_at, model.recipe, model.n_shapes, tally.n_scores, tally.total)
    query = (
        select(*columns)
        .join_from(t.model, t.score_tally, is_scored, isouter=True)
        .where(model.collection_id == collection_id)
        .order_by(model.version)
    )
    rows = connection.execute(query).all()
    starts = [row.trained_at for row in rows]
    checked: list[list[float]] = [[] for _ in rows]
    check = t.blind_check.c
    of_collection = select(check.checked_at, check.area_agreement).where(check.collection_id == collection_id)
    for each in connection.execute(of_collection.order_by(check.id)):
        newest = bisect_right(starts, each.checked_at) - 1
        if newest >= 0:  # else there was no model yet
            checked[newest].append(each.area_agreement)
    made = [
        ModelRound(
            version=row.version,
            trained_at=row.trained_at,
            train_s=row.recipe.get("train_s"),
            n_shapes=row.n_shapes,
            n_scores=row.n_scores or 0,
            mean_score=row.total / row.n_scores if row.n_scores else None,
            n_checks=len(agreements),
            area_agreement=fsum(agreements) / len(agreements) if agreements else None,
        )
        for row, agreements in zip(rows, checked, strict=True)
    ]
    return made[::-1]
