"""Labels that are put aside: to be compared with other people's, or with a reference."""

from datetime import date, datetime
from typing import Any

import numpy as np
from jaxtyping import UInt16
from sqlalchemy import ColumnElement, Connection, Row, func, insert, select

from partwise.errors import NotFoundError
from partwise.labels.checks import checked_labels
from partwise.labels.encoding import EncodedLabels, decode_labels, encode_labels
from partwise.store import tables as t
from partwise.store.records import (
    Answer,
    BlindCheck,
    BlindCheckDay,
    Closeness,
    Consensus,
    Draft,
    LeasePurpose,
    NewBlindCheck,
    NewConsensus,
)
from partwise.store.sql.collections import parts, schema_version

_COLUMNS = tuple(column for column in t.answer.c if column.name not in ("labels", "purpose"))
_CLOSENESS = ("area_agreement", "part_iou", "boundary_distance")


def add_answer(connection: Connection, draft: Draft, labels: UInt16[np.ndarray, " m"], now: datetime) -> Answer:
    n_faces = connection.execute(select(t.mesh.c.n_faces).where(t.mesh.c.hash == draft.mesh_hash)).scalar_one()
    version = schema_version(connection, draft.collection_id, for_share=True)  # no part is removed meanwhile
    checked = checked_labels(labels, n_faces, parts(connection, draft.collection_id, draft.schema_version))
    if draft.purpose is LeasePurpose.INDEPENDENT:  # they may become the shape's: with no part that is gone
        checked_labels(checked, n_faces, parts(connection, draft.collection_id, version))
    encoded = encode_labels(checked)
    values = {
        "shape_id": draft.shape_id,
        "slot": draft.slot,
        "round": draft.round,
        "person_id": draft.person_id,
        "draft_id": draft.id,
        "purpose": draft.purpose.value,
        "mesh_hash": draft.mesh_hash,
        "schema_version": draft.schema_version,
        "labels": encoded.blob,
        "n_faces": encoded.n_faces,
        "sha256": encoded.sha256,
        "created_at": now,
    }
    return _answer(connection.execute(insert(t.answer).values(values).returning(*_COLUMNS)).one())


def answers(connection: Connection, shape_id: int) -> list[Answer]:
    query = select(*_COLUMNS).where(t.answer.c.shape_id == shape_id).order_by(t.answer.c.id)
    return [_answer(row) for row in connection.execute(query)]


def answers_of_round(connection: Connection, shape_id: int, round_: int) -> list[Answer]:
    """The independent labels of a round so far."""
    query = select(*_COLUMNS).where(t.answer.c.shape_id == shape_id, t.answer.c.round == round_)
    query = query.where(t.answer.c.purpose == LeasePurpose.INDEPENDENT.value).order_by(t.answer.c.id)
    return [_answer(row) for row in connection.execute(query)]


def n_awaited(connection: Connection, draft: Draft) -> int:
    """Labels that the draft's round waits for beside those in and the draft's own."""
    place = t.queue_rank.c
    query = select(func.count()).where(place.shape_id == draft.shape_id, place.round == draft.round)
    return connection.execute(query.where(place.slot != draft.slot)).scalar_one()


def answer(connection: Connection, answer_id: int) -> Answer:
    row = connection.execute(select(*_COLUMNS).where(t.answer.c.id == answer_id)).first()
    if row is None:
        raise NotFoundError(f"there is no answer {answer_id}")
    return _answer(row)


def answer_labels(connection: Connection, answer_id: int) -> UInt16[np.ndarray, " m"]:
    columns = (t.answer.c.labels, t.answer.c.n_faces, t.answer.c.sha256)
    row = connection.execute(select(*columns).where(t.answer.c.id == answer_id)).first()
    if row is None:
        raise NotFoundError(f"there is no answer {answer_id}")
    return decode_labels(EncodedLabels(bytes(row.labels), row.n_faces, row.sha256))


def add_consensus(
    connection: Connection,
    draft: Draft,
    new: NewConsensus,
    answer_ids: list[int],
    medoid_id: int,
    revision_id: int,
    *,
    is_agreed: bool,
    now: datetime,
) -> None:
    values = {
        "shape_id": draft.shape_id,
        "round": draft.round,
        "answer_ids": answer_ids,
        "is_agreed": is_agreed,
        "medoid_id": medoid_id,
        "revision_id": revision_id,
        "settled_at": now,
    }
    connection.execute(insert(t.consensus).values(values | _columns(new.closeness)))


def consensus_of(connection: Connection, shape_id: int) -> list[Consensus]:
    query = select(t.consensus).where(t.consensus.c.shape_id == shape_id).order_by(t.consensus.c.id)
    return [
        Consensus(**{**_with_closeness(row), "answer_ids": tuple(row.answer_ids)}) for row in connection.execute(query)
    ]


def add_blind_check(connection: Connection, draft: Draft, answer_id: int, check: NewBlindCheck, now: datetime) -> None:
    values = {
        "collection_id": draft.collection_id,
        "shape_id": draft.shape_id,
        "person_id": draft.person_id,
        "answer_id": answer_id,
        "reference_id": check.reference_id,
        "checked_at": now,
    }
    connection.execute(insert(t.blind_check).values(values | _columns(check.closeness)))


def blind_checks(
    connection: Connection,
    collection_id: int,
    after: int,
    limit: int,
    person_id: int | None,
    but_person_id: int | None,
) -> list[BlindCheck]:
    check = t.blind_check
    query = select(check).where(check.c.collection_id == collection_id, check.c.id > after)
    if person_id is not None:
        query = query.where(check.c.person_id == person_id)
    if but_person_id is not None:
        query = query.where(check.c.person_id != but_person_id)
    return [BlindCheck(**_with_closeness(row)) for row in connection.execute(query.order_by(check.c.id).limit(limit))]


def blind_check_days(connection: Connection, collection_id: int) -> list[BlindCheckDay]:
    check = t.blind_check.c
    at: ColumnElement[datetime] = check.checked_at
    if connection.dialect.name == "postgresql":  # SQLite's times are in UTC as they are
        at = func.timezone("UTC", at)
    day = func.date(at).label("day")
    means = (func.avg(check.area_agreement), func.avg(check.part_iou), func.avg(check.boundary_distance))
    query = (
        select(check.person_id, day, func.count(), *means)
        .where(check.collection_id == collection_id)
        .group_by(check.person_id, day)
        .order_by(check.person_id, day)
    )
    return [
        BlindCheckDay(
            person_id, date.fromisoformat(str(on)), n_checks, Closeness(*(min(mean, 1.0) for mean in measured))
        )
        for person_id, on, n_checks, *measured in connection.execute(query)
    ]


def _columns(closeness: Closeness) -> dict[str, float]:
    return {name: getattr(closeness, name) for name in _CLOSENESS}


def _with_closeness(row: Row[Any]) -> dict[str, Any]:
    values = dict(row._mapping)
    return values | {"closeness": Closeness(**{name: values.pop(name) for name in _CLOSENESS})}


def _answer(row: Row[Any]) -> Answer:
    return Answer(**row._mapping)


def awaited_answers(connection: Connection, draft: Draft) -> tuple[list[Answer], int]:
    """The others' answers of a draft's round, and how many more it waits for beside the draft's own."""
    return answers_of_round(connection, draft.shape_id, draft.round), n_awaited(connection, draft)
