"""Which rank a score gives a shape that waits, computed and compared in the database: of very many shapes few move."""

from sqlalchemy import BigInteger, ColumnElement, Connection, case, cast, exists, select

from partwise.store import tables as t
from partwise.store.sql.places import FIRST

FIRST_BY_SCORE = 1_000
"""The rank of the highest score there can be. Lower ranks are given whatever the score is."""

_HIGHEST = 16.0  # nats: no entropy of up to 65,535 parts comes near it, and a variation ratio is at most 1
_STEPS = 62_000_000  # ranks for a difference of 1, so that the lowest score comes before what nothing ranked


def score_rank(value: ColumnElement[float]) -> ColumnElement[int]:
    """Lower for higher scores; the same for scores that differ by less than 1.6e-8, and for all outside of [0, 16]."""
    within = case((value < 0.0, 0.0), (value > _HIGHEST, _HIGHEST), else_=value)
    return FIRST_BY_SCORE + cast((_HIGHEST - within) * _STEPS, BigInteger)


def highest_waiting(connection: Connection, collection_id: int, score_name: str, limit: int) -> list[int]:
    score = t.score.c
    waits = exists().where(t.queue_rank.c.shape_id == score.shape_id)
    query = select(score.shape_id).where(score.collection_id == collection_id, score.name == score_name, waits)
    return list(connection.execute(query.order_by(score.value.desc(), score.shape_id.desc()).limit(limit)).scalars())


def out_of_rank(connection: Connection, collection_id: int, score_name: str) -> dict[int, int]:
    place, score = t.queue_rank.c, t.score.c
    rank = score_rank(score.value)
    query = (
        select(place.shape_id, rank.label("due"))
        .join_from(t.queue_rank, t.score, place.shape_id == score.shape_id)
        .where(place.collection_id == collection_id, score.collection_id == collection_id, score.name == score_name)
        .where(place.rank != FIRST, place.rank != rank)
        .order_by("due", place.shape_id)
    )
    return {row.shape_id: row.due for row in connection.execute(query)}
