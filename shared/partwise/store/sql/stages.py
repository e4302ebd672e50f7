"""Stage runs: what is done, what failed, and the moment a block becomes visible."""

import math
from collections.abc import Collection as SizedIterable
from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import Any

from sqlalchemy import ColumnElement, Connection, Row, Select, and_, case, delete, func, insert, or_, select, update

from partwise.errors import ConflictError, NotFoundError, ParameterError
from partwise.store import tables as t
from partwise.store.records import (
    Failure,
    FailureKind,
    NewBlock,
    NewFailure,
    NewMesh,
    NewScore,
    NewStageRun,
    RunStatus,
    Score,
    Shape,
    StageCount,
    StageRun,
)
from partwise.store.sql.dialect import batches, insert_for
from partwise.store.sql.facets import copy_facets, lock_facets, renew_facets
from partwise.store.sql.places import renew_places
from partwise.store.sql.rounds import tally_scores
from partwise.store.sql.shapes import add_meshes, refuse_unknown_shapes
from partwise.store.sql.state import is_current_run, is_failed_run


def publish_block(
    connection: Connection,
    block: NewBlock,
    runs: Sequence[NewStageRun],
    scores: Sequence[NewScore],
    meshes: Sequence[NewMesh],
    now: datetime,
) -> int:
    for row in [run.row for run in runs] + [mesh.row for mesh in meshes]:
        if row is None or not 0 <= row < block.n_shapes:
            raise ParameterError(f"a row must be 0 to {block.n_shapes - 1} in block {block.name} but is {row}")
    if connection.execute(select(t.block.c.id).where(t.block.c.name == block.name)).first():
        raise ConflictError(f"a block is published once but {block.name} already was; write it again under a new name")
    block_id = connection.execute(
        insert(t.block)
        .values(
            name=block.name,
            kind=block.kind,
            n_shapes=block.n_shapes,
            n_bytes=block.n_bytes,
            checksum=block.checksum,
            created_at=now,
        )
        .returning(t.block.c.id)
    ).scalar_one()
    shapes = refuse_unknown_shapes(connection, {mesh.shape_id for mesh in meshes})
    add_meshes(connection, block_id, meshes, now)
    record_done(connection, runs, scores, now, block_id, shapes)
    return block_id


def record_done(
    connection: Connection,
    runs: Sequence[NewStageRun],
    scores: Sequence[NewScore],
    now: datetime,
    block_id: int | None = None,
    known_shapes: Mapping[int, Shape] | None = None,
) -> None:
    ids = {run.shape_id for run in runs} | {score.shape_id for score in scores}
    shapes = refuse_unknown_shapes(connection, ids - set(known_shapes or {})) | dict(known_shapes or {})
    if len({(run.shape_id, run.stage) for run in runs}) < len(runs):
        raise ParameterError("a shape must have one run of a stage at a time but two were given; keep the last")
    for stage in {run.stage for run in runs}:
        _make_room(connection, stage, [run.shape_id for run in runs if run.stage == stage])
    if runs:
        statement = _upsert_run(connection)
        connection.execute(statement, [_done_row(run, block_id, now) for run in runs])
        _renew(connection, {run.shape_id for run in runs}, now)
    _upsert_scores(connection, scores, shapes, now)


def _renew(connection: Connection, shape_ids: SizedIterable[int], now: datetime) -> None:
    """Brings the table of shapes and the queue up to date with stage runs."""
    renew_facets(connection, shape_ids)
    renew_places(connection, shape_ids, now)


def _make_room(connection: Connection, stage: str, shape_ids: Sequence[int]) -> None:
    """Supersede the current runs and clear the failed ones of a stage."""
    for some in batches(shape_ids):
        of_stage = and_(t.stage_run.c.shape_id.in_(some), t.stage_run.c.stage == stage)
        connection.execute(update(t.stage_run).where(of_stage, is_current_run()).values(is_superseded=True))
        connection.execute(delete(t.stage_run).where(of_stage, is_failed_run()))


def _done_row(run: NewStageRun, block_id: int | None, now: datetime) -> dict[str, Any]:
    return {
        "shape_id": run.shape_id,
        "stage": run.stage,
        "key": run.key,
        "status": RunStatus.DONE.value,
        "reason": None,
        "attempts": run.attempts,
        "seconds": run.seconds,
        "summary": dict(run.summary),
        "block_id": block_id,
        "row": run.row,
        "finished_at": now,
        "is_superseded": False,
    }


def _upsert_run(connection: Connection) -> Any:
    """Insert a run, or renew the one with the same key, which a return to earlier parameters finds superseded."""
    statement = insert_for(connection, t.stage_run)
    renewed = ("status", "reason", "attempts", "seconds", "summary", "block_id", "row", "finished_at", "is_superseded")
    return statement.on_conflict_do_update(
        index_elements=["shape_id", "stage", "key"], set_={name: statement.excluded[name] for name in renewed}
    )


def _upsert_scores(
    connection: Connection, scores: Sequence[NewScore], shapes: Mapping[int, Shape], now: datetime
) -> None:
    for score in scores:
        if not math.isfinite(score.value):
            raise ParameterError(f"a score must be finite but {score.name} of shape {score.shape_id} is {score.value}")
    _refuse_foreign_models(connection, scores, shapes)
    if not scores:
        return
    tally_scores(connection, scores)
    statement = insert_for(connection, t.score)
    rows = [
        {
            "shape_id": score.shape_id,
            "name": score.name,
            "model_id": score.model_id,
            "value": score.value,
            "scored_at": now,
            "collection_id": shapes[score.shape_id].collection_id,
        }
        for score in scores
    ]
    newer, scored = statement.excluded, list(batches(sorted({score.shape_id for score in scores})))
    for some in scored:
        lock_facets(connection, some)
    connection.execute(
        statement.on_conflict_do_update(
            index_elements=["shape_id", "name"],
            set_={"model_id": newer.model_id, "value": newer.value, "scored_at": newer.scored_at},
            where=t.score.c.model_id <= newer.model_id,  # an evaluation that ends late does not undo a newer model's
        ),
        rows,
    )
    for some in scored:
        copy_facets(connection, some)


def _refuse_foreign_models(connection: Connection, scores: Sequence[NewScore], shapes: Mapping[int, Shape]) -> None:
    model_ids = {score.model_id for score in scores}
    query = select(t.model.c.id, t.model.c.collection_id).where(t.model.c.id.in_(model_ids))
    owners: dict[int, int] = {row.id: row.collection_id for row in connection.execute(query)}
    for score in scores:
        owner = owners.get(score.model_id)
        if owner is None:
            raise NotFoundError(f"there is no model with id {score.model_id}; save the model before its scores")
        if owner != shapes[score.shape_id].collection_id:
            raise ParameterError(
                f"a shape is scored by models of its own collection but shape {score.shape_id} of collection "
                f"{shapes[score.shape_id].collection_id} has a score of model {score.model_id} of {owner}"
            )


def record_failure(connection: Connection, failure: NewFailure, now: datetime) -> None:
    refuse_unknown_shapes(connection, [failure.shape_id])
    values = {
        "shape_id": failure.shape_id,
        "stage": failure.stage,
        "key": failure.key,
        "status": RunStatus.FAILED.value,
        "reason": failure.reason,
        "attempts": failure.attempts,
        "seconds": failure.seconds,
        "summary": dict(failure.detail),
        "block_id": None,
        "row": None,
        "finished_at": now,
        "is_superseded": False,
    }
    of_stage = and_(t.stage_run.c.shape_id == failure.shape_id, t.stage_run.c.stage == failure.stage)
    # what failed under other parameters says nothing any more, and would name the shape twice
    connection.execute(delete(t.stage_run).where(of_stage, is_failed_run(), t.stage_run.c.key != failure.key))
    statement = insert_for(connection, t.stage_run)
    renewed = {name: statement.excluded[name] for name in values if name not in ("shape_id", "stage", "key")}
    connection.execute(
        statement.on_conflict_do_update(
            index_elements=["shape_id", "stage", "key"],
            set_=renewed,
            where=or_(is_failed_run(), t.stage_run.c.is_superseded),
        ),
        values,
    )
    _renew(connection, [failure.shape_id], now)


def clear_failures(
    connection: Connection,
    collection_id: int,
    stage: str | None,
    shape_ids: SizedIterable[int] | None,
    kind: FailureKind | None,
    reason_contains: str,
    now: datetime,
) -> int:
    in_collection = t.stage_run.c.shape_id.in_(select(t.shape.c.id).where(t.shape.c.collection_id == collection_id))
    statement = delete(t.stage_run).where(is_failed_run(), in_collection)
    if stage is not None:
        statement = statement.where(t.stage_run.c.stage == stage)
    if kind is not None:
        statement = statement.where(_is_of_kind(kind))
    if reason_contains:
        statement = statement.where(t.stage_run.c.reason.icontains(reason_contains, autoescape=True))
    some_statements = (
        [statement]
        if shape_ids is None
        else [statement.where(t.stage_run.c.shape_id.in_(some)) for some in batches(shape_ids)]
    )
    cleared = [
        shape_id
        for some in some_statements
        for shape_id in connection.execute(some.returning(t.stage_run.c.shape_id)).scalars()
    ]
    _renew(connection, set(cleared), now)
    return len(cleared)


def _is_of_kind(kind: FailureKind) -> ColumnElement[bool]:
    return t.stage_run.c.summary["kind"].as_string() == kind.value


def _runs(*columns: Any) -> Select[Any]:
    is_in_block = t.stage_run.c.block_id == t.block.c.id
    return select(t.stage_run, t.block.c.name.label("block_name"), *columns).join_from(
        t.stage_run, t.block, is_in_block, isouter=True
    )


def _run(row: Row[Any]) -> StageRun:
    values = dict(row._mapping)
    values.pop("source_key", None)
    return StageRun(**{**values, "status": RunStatus(values["status"])})


def _by_shape(
    connection: Connection, shape_ids: SizedIterable[int], stage: str, condition: ColumnElement[bool]
) -> dict[int, StageRun]:
    found = {}
    for some in batches(shape_ids):
        query = _runs().where(t.stage_run.c.shape_id.in_(some), t.stage_run.c.stage == stage, condition)
        # the last row that a shape gets is its latest run
        for row in connection.execute(query.order_by(t.stage_run.c.finished_at, t.stage_run.c.id)):
            found[row.shape_id] = _run(row)
    return found


def stage_runs(connection: Connection, shape_ids: SizedIterable[int], stage: str) -> dict[int, StageRun]:
    return _by_shape(connection, shape_ids, stage, is_current_run())


def failed_runs(connection: Connection, shape_ids: SizedIterable[int], stage: str) -> dict[int, StageRun]:
    return _by_shape(connection, shape_ids, stage, is_failed_run())


def failures(
    connection: Connection, collection_id: int, stage: str | None, kind: FailureKind | None, after: int, limit: int
) -> Sequence[Failure]:
    query = (
        _runs(t.shape.c.source_key)
        .join(t.shape, t.shape.c.id == t.stage_run.c.shape_id)
        .where(t.shape.c.collection_id == collection_id, is_failed_run(), t.stage_run.c.id > after)
        .order_by(t.stage_run.c.id)
        .limit(limit)
    )
    if stage is not None:
        query = query.where(t.stage_run.c.stage == stage)
    if kind is not None:
        query = query.where(_is_of_kind(kind))
    return [Failure(_run(row), row.source_key) for row in connection.execute(query)]


def stage_counts(connection: Connection, collection_id: int) -> Sequence[StageCount]:
    query = (
        select(
            t.stage_run.c.stage,
            func.sum(case((is_current_run(), 1), else_=0)),
            func.count(case((is_failed_run(), t.stage_run.c.shape_id)).distinct()),
        )
        .join_from(t.stage_run, t.shape)
        .where(t.shape.c.collection_id == collection_id)
        .group_by(t.stage_run.c.stage)
        .order_by(t.stage_run.c.stage)
    )
    return [StageCount(stage, int(n_done), n_failed) for stage, n_done, n_failed in connection.execute(query)]


def scores(connection: Connection, shape_ids: SizedIterable[int], name: str) -> dict[int, Score]:
    columns = (t.score.c.shape_id, t.score.c.model_id, t.score.c.name, t.score.c.value, t.score.c.scored_at)
    found = {}
    for some in batches(shape_ids):
        rows = connection.execute(select(*columns).where(t.score.c.shape_id.in_(some), t.score.c.name == name))
        found.update({row.shape_id: Score(**row._mapping) for row in rows})
    return found
