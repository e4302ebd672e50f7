"""What a lease tells of how its shape was ranked. For work that is not to be recognised it is what other work tells."""

from collections.abc import Sequence
from datetime import datetime
from typing import Any

from sqlalchemy import Connection, Row, func, select

from partwise.store import tables as t
from partwise.store.records import DEFAULT_RANKING
from partwise.store.sql.dialect import insert_for

TOLD = ("rank", "score_name", "score", "model_version")
"""Columns of a lease."""

_COUNTED = 10_000  # places ahead; further behind nothing is told


def record_ranking(connection: Connection, collection_id: int, score_name: str, now: datetime) -> None:
    statement = insert_for(connection, t.ranking).values(
        collection_id=collection_id, score_name=score_name, ranked_at=now
    )
    renewed = {"score_name": score_name, "ranked_at": now}
    connection.execute(statement.on_conflict_do_update(index_elements=["collection_id"], set_=renewed))


def ranking_score(connection: Connection, collection_id: int) -> str:
    """The score that the queue was ranked by last."""
    query = select(t.ranking.c.score_name).where(t.ranking.c.collection_id == collection_id)
    return connection.execute(query).scalar() or DEFAULT_RANKING


def told_of(connection: Connection, collection_id: int, shape_id: int, place: Row[Any] | None) -> dict[str, Any]:
    """Columns of a lease: the place's rank, and the shape's score that ranks. place : None if it has none."""
    name, value, version = _score(connection, collection_id, shape_id)
    rank = None if place is None else _rank(connection, place)
    return {"rank": rank, "score_name": name, "score": value, "model_version": version}


def told_instead(connection: Connection, place: Row[Any], neighbours: Sequence[int]) -> dict[str, Any]:
    """Columns of a lease that must look like any other: the rank of this place, a score between two neighbours'.

    neighbours : shapes that wait about there, at least one; the first two count.
    """
    scores = [_score(connection, place.collection_id, shape_id) for shape_id in neighbours[:2]]
    name, value, version = scores[0]
    values = [each[1] for each in scores if each[1] is not None]
    between = None if value is None else sum(values) / len(values)
    return {"rank": _rank(connection, place), "score_name": name, "score": between, "model_version": version}


def _score(connection: Connection, collection_id: int, shape_id: int) -> tuple[str | None, float | None, int | None]:
    """Name, value and model version."""
    of_collection = select(t.ranking.c.score_name).where(t.ranking.c.collection_id == collection_id)
    query = (
        select(t.score.c.name, t.score.c.value, t.model.c.version)
        .join_from(t.score, t.model, t.model.c.id == t.score.c.model_id)
        .where(t.score.c.shape_id == shape_id)
        .where(t.score.c.name == func.coalesce(of_collection.scalar_subquery(), DEFAULT_RANKING))
    )
    found = connection.execute(query).first()
    return (None, None, None) if found is None else (found.name, found.value, found.version)


def _rank(connection: Connection, place: Row[Any]) -> int | None:
    """From 1, among the free places."""
    other = t.queue_rank.c
    ahead = (
        select(other.shape_id)
        .where(other.collection_id == place.collection_id, other.lease_id.is_(None), other.person_id.is_(None))
        .where(other.rank < place.rank)
        .limit(_COUNTED)
    )
    n_ahead = connection.execute(select(func.count()).select_from(ahead.subquery("ahead"))).scalar_one()
    return n_ahead + 1 if n_ahead < _COUNTED else None
