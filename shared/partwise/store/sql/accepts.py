"""Bulk acceptance: labels of models become the shapes', but for a few that people label unknowing."""

from collections.abc import Sequence
from datetime import datetime
from typing import Any

import numpy as np
from jaxtyping import UInt16
from sqlalchemy import Connection, Row, case, func, insert, select, update

from partwise.errors import ConflictError, NotFoundError
from partwise.labels.checks import checked_labels
from partwise.labels.encoding import EncodedLabels, decode_labels, encode_labels
from partwise.store import tables as t
from partwise.store.records import (
    AcceptBatch,
    EventKind,
    LabelRevision,
    NewEvent,
    NewRevision,
    Recheck,
    RecheckResult,
    ShapeState,
)
from partwise.store.sql import leases
from partwise.store.sql.collections import append_audit, parts, schema_version
from partwise.store.sql.dialect import batches
from partwise.store.sql.events import append_events
from partwise.store.sql.labels import commit_revision
from partwise.store.sql.places import FIRST
from partwise.store.sql.shapes import lock_labels


def begin_accept(
    connection: Connection, collection_id: int, person_id: int, segmentation: str, agreement: float, now: datetime
) -> int:
    schema_version(connection, collection_id)
    name = leases.person_name(connection, person_id)
    values = {
        "collection_id": collection_id,
        "person_id": person_id,
        "segmentation": segmentation,
        "agreement": agreement,
        "n_accepted": 0,
        "accepted_at": now,
    }
    batch_id: int = connection.execute(
        insert(t.accept_batch).values(values).returning(t.accept_batch.c.id)
    ).scalar_one()
    detail = {"batch_id": batch_id, "segmentation": segmentation}
    append_audit(connection, name, "accept in bulk", f"collection {collection_id}", detail, now)
    return batch_id


def accept_shape(connection: Connection, batch_id: int, revision: NewRevision, now: datetime) -> LabelRevision:
    _refuse_busy(connection, _batch(connection, batch_id).collection_id, revision.shape_id, now)
    committed, _, events = commit_revision(connection, revision, None, now)
    is_it = t.accept_batch.c.id == batch_id
    connection.execute(update(t.accept_batch).where(is_it).values(n_accepted=t.accept_batch.c.n_accepted + 1))
    append_events(connection, events, now)
    return committed


def draw_shape(
    connection: Connection,
    batch_id: int,
    shape_id: int,
    mesh_hash: str,
    schema: int,
    labels: UInt16[np.ndarray, " m"],
    now: datetime,
) -> Recheck:
    batch = _batch(connection, batch_id)
    _refuse_busy(connection, batch.collection_id, shape_id, now)
    n_faces = connection.execute(select(t.mesh.c.n_faces).where(t.mesh.c.hash == mesh_hash)).scalar()
    if n_faces is None:
        raise NotFoundError(f"there is no mesh {mesh_hash[:12]}… on record; reload the shape")
    encoded = encode_labels(checked_labels(labels, n_faces, parts(connection, batch.collection_id, schema)))
    values = {
        "batch_id": batch_id,
        "collection_id": batch.collection_id,
        "shape_id": shape_id,
        "mesh_hash": mesh_hash,
        "labels": encoded.blob,
        "n_faces": encoded.n_faces,
        "sha256": encoded.sha256,
    }
    recheck_id = connection.execute(insert(t.recheck).values(values).returning(t.recheck.c.id)).scalar_one()
    _to_front(connection, [shape_id])
    return Recheck(recheck_id, batch_id, batch.collection_id, shape_id, mesh_hash, batch.agreement)


def _refuse_busy(connection: Connection, collection_id: int, shape_id: int, now: datetime) -> None:
    """Only what just waits is accepted: people's work is never passed over."""
    lock_labels(connection, [shape_id])
    facet = t.shape_facet.c
    known = select(facet.state).where(facet.shape_id == shape_id, facet.collection_id == collection_id)
    state = connection.execute(known).scalar()
    if state is None:
        raise NotFoundError(f"there is no shape {shape_id} in collection {collection_id}")
    if state != ShapeState.READY:
        raise ConflictError(f"labels are accepted for shapes that wait but shape {shape_id} is {state}")
    held = [each for each in leases.active_of_shape(connection, shape_id) if each.expires_at >= now]
    if held:
        raise ConflictError(f"somebody works on shape {shape_id}; accept it when they are done")
    is_checked = (t.recheck.c.shape_id == shape_id) & t.recheck.c.checked_at.is_(None)
    if connection.execute(select(t.recheck.c.id).where(is_checked)).first() is not None:
        raise ConflictError(f"shape {shape_id} waits to be checked; its labels come from whoever gets it")


def _to_front(connection: Connection, shape_ids: Sequence[int]) -> list[int]:
    """Those that have a free place that anybody may have."""
    place, moved = t.queue_rank.c, set[int]()
    for some in batches(sorted(shape_ids)):
        free = (place.shape_id.in_(some)) & place.lease_id.is_(None) & place.person_id.is_(None)
        statement = update(t.queue_rank).where(free).values(rank=FIRST).returning(place.shape_id)
        moved.update(connection.execute(statement).scalars())
    return sorted(moved)


def put_first(
    connection: Connection, collection_id: int, shape_ids: Sequence[int], person_id: int, now: datetime
) -> list[int]:
    schema_version(connection, collection_id)
    name = leases.person_name(connection, person_id)
    facet, own = t.shape_facet.c, list[int]()
    for some in batches(sorted(set(shape_ids))):
        query = select(facet.shape_id).where(facet.shape_id.in_(some), facet.collection_id == collection_id)
        own.extend(connection.execute(query).scalars())
    moved = _to_front(connection, own)
    detail = {"shape_ids": moved[:100], "n_shapes": len(moved)}
    append_audit(connection, name, "put first", f"collection {collection_id}", detail, now)
    payload = {"what": "selected", "n_shapes": len(moved)}
    append_events(connection, [NewEvent(EventKind.QUEUE, collection_id, payload)], now)
    return moved


def open_rechecks(
    connection: Connection, collection_id: int, shape_id: int | None, after: int, limit: int
) -> list[Recheck]:
    drawn = t.recheck.c
    query = (
        select(drawn.id, drawn.batch_id, drawn.collection_id, drawn.shape_id, drawn.mesh_hash)
        .add_columns(t.accept_batch.c.agreement)
        .join_from(t.recheck, t.accept_batch, t.accept_batch.c.id == drawn.batch_id)
        .where(drawn.collection_id == collection_id, drawn.checked_at.is_(None), drawn.id > after)
    )
    if shape_id is not None:
        query = query.where(drawn.shape_id == shape_id)
    return [Recheck(**row._mapping) for row in connection.execute(query.order_by(drawn.id).limit(limit))]


def recheck_labels(connection: Connection, recheck_id: int) -> UInt16[np.ndarray, " m"]:
    columns = (t.recheck.c.labels, t.recheck.c.n_faces, t.recheck.c.sha256)
    row = connection.execute(select(*columns).where(t.recheck.c.id == recheck_id)).first()
    if row is None:
        raise NotFoundError(f"there is no re-check {recheck_id}")
    return decode_labels(EncodedLabels(bytes(row.labels), row.n_faces, row.sha256))


def settle_recheck(connection: Connection, result: RecheckResult, now: datetime) -> bool:
    drawn = t.recheck.c
    query = (
        select(drawn.is_false, t.accept_batch.c.agreement)
        .join_from(t.recheck, t.accept_batch, t.accept_batch.c.id == drawn.batch_id)
        .where(drawn.id == result.recheck_id)
        .with_for_update(of=t.recheck)
    )
    known = connection.execute(query).first()
    if known is None:
        raise NotFoundError(f"there is no re-check {result.recheck_id}")
    if known.is_false is not None:
        return bool(known.is_false)
    is_false = result.closeness.area_agreement < known.agreement
    values = {
        "revision_id": result.revision_id,
        "area_agreement": result.closeness.area_agreement,
        "part_iou": result.closeness.part_iou,
        "boundary_distance": result.closeness.boundary_distance,
        "is_false": is_false,
        "checked_at": now,
    }
    connection.execute(update(t.recheck).where(drawn.id == result.recheck_id).values(values))
    return is_false


def accept_batches(connection: Connection, collection_id: int, before: int | None, limit: int) -> list[AcceptBatch]:
    schema_version(connection, collection_id)
    batch, drawn = t.accept_batch, t.recheck.c
    page = select(batch).where(batch.c.collection_id == collection_id)
    if before is not None:
        page = page.where(batch.c.id < before)
    rows = connection.execute(
        page.add_columns(t.person.c.name)
        .join(t.person, t.person.c.id == batch.c.person_id)
        .order_by(batch.c.id.desc())
        .limit(limit)
    ).all()
    counted = (
        select(
            drawn.batch_id,
            func.count().label("n_drawn"),
            func.count(drawn.checked_at).label("n_rechecked"),
            func.count(case((drawn.is_false, 1))).label("n_false"),
        )
        .where(drawn.batch_id.in_([row.id for row in rows]))
        .group_by(drawn.batch_id)
    )
    counts = {row.batch_id: row for row in connection.execute(counted)} if rows else {}
    return [_to_batch(row, counts.get(row.id)) for row in rows]


def _to_batch(row: Row[Any, Any, Any], counts: Row[Any, Any, Any] | None) -> AcceptBatch:
    values = dict(row._mapping)
    name = values.pop("name")
    n = (0, 0, 0) if counts is None else (counts.n_drawn, counts.n_rechecked, counts.n_false)
    return AcceptBatch(**values, person_name=name, n_drawn=n[0], n_rechecked=n[1], n_false=n[2])


def _batch(connection: Connection, batch_id: int) -> Row[Any, Any, Any]:
    found = connection.execute(select(t.accept_batch).where(t.accept_batch.c.id == batch_id)).first()
    if found is None:
        raise NotFoundError(f"there is no batch {batch_id} of accepted labels")
    return found
