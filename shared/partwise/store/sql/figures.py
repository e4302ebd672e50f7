"""How fast stages go, why shapes fail, who works on what, and what all of it takes, counted."""

from datetime import datetime

from sqlalchemy import Connection, case, func, select, text

from partwise.store import tables as t
from partwise.store.records import (
    BlockTotal,
    DraftOutcome,
    FailureKind,
    LeaseCounts,
    PersonFigures,
    RunStatus,
)
from partwise.store.sql.collections import schema_version
from partwise.store.sql.state import is_current_run, is_failed_run


def stage_paces(connection: Connection, collection_id: int, since: datetime) -> dict[str, int]:
    runs = t.stage_run.c
    # ids grow with time: walking back from the newest costs what was done since, not what was ever done
    older = select(runs.id).where(runs.finished_at < since).order_by(runs.id.desc()).limit(1)
    last_older = connection.execute(older).scalar() or 0
    query = (
        select(runs.stage, func.count().label("n_done"))
        .join_from(t.stage_run, t.shape)
        .where(runs.id > last_older, runs.status == RunStatus.DONE.value, t.shape.c.collection_id == collection_id)
        .group_by(runs.stage)
    )
    return {row.stage: row.n_done for row in connection.execute(query)}


def stages_of_model(connection: Connection, collection_id: int, model_version: int) -> dict[str, int]:
    schema_version(connection, collection_id)
    runs = t.stage_run.c
    query = (
        select(runs.stage, func.count().label("n_done"))
        .join_from(t.stage_run, t.shape)
        .where(
            is_current_run(),
            t.shape.c.collection_id == collection_id,
            runs.summary["model_version"].as_integer() == model_version,
            runs.summary["mesh_hash"].as_string() == t.shape.c.mesh_hash,
        )
        .group_by(runs.stage)
    )
    return {row.stage: row.n_done for row in connection.execute(query)}


def failure_kinds(connection: Connection, collection_id: int) -> dict[FailureKind, int]:
    kind = t.stage_run.c.summary["kind"].as_string()
    query = (
        select(kind, func.count())
        .join_from(t.stage_run, t.shape)
        .where(is_failed_run(), t.shape.c.collection_id == collection_id)
        .group_by(kind)
    )
    counts = dict.fromkeys(FailureKind, 0)
    for name, n_runs in connection.execute(query):
        known = FailureKind(name) if name in set(FailureKind) else FailureKind.ERROR
        counts[known] += n_runs
    return counts


def lease_counts(connection: Connection, collection_id: int, now: datetime) -> LeaseCounts:
    schema_version(connection, collection_id)
    lease = t.lease.c
    is_held = lease.expires_at >= now
    query = select(
        func.count().filter(is_held),
        func.count().filter(is_held, lease.is_prefetched),
        func.count().filter(~is_held),
        func.count(case((is_held, lease.person_id)).distinct()),
    ).where(lease.collection_id == collection_id, lease.released_at.is_(None))
    return LeaseCounts(*connection.execute(query).one())


def scored_by(connection: Connection, collection_id: int, score_name: str) -> dict[int, int]:
    schema_version(connection, collection_id)
    score = t.score.c
    counts = (
        select(score.model_id, func.count().label("n_scores"))
        .where(score.collection_id == collection_id, score.name == score_name)
        .group_by(score.model_id)
        .subquery()
    )
    query = select(t.model.c.version, counts.c.n_scores).join_from(counts, t.model, t.model.c.id == counts.c.model_id)
    return {row.version: row.n_scores for row in connection.execute(query.order_by(t.model.c.version))}


def block_totals(connection: Connection) -> list[BlockTotal]:
    block = t.block.c
    query = select(block.kind, func.count(), func.sum(block.n_bytes)).group_by(block.kind).order_by(block.kind)
    return [BlockTotal(kind, n_blocks, int(n_bytes)) for kind, n_blocks, n_bytes in connection.execute(query)]


def database_bytes(connection: Connection) -> int:
    if connection.dialect.name == "postgresql":
        return int(connection.execute(text("SELECT pg_database_size(current_database())")).scalar_one())
    pages, page_bytes = (
        connection.execute(text(f"PRAGMA {name}")).scalar_one() for name in ("page_count", "page_size")
    )
    return int(pages) * int(page_bytes)


def person_figures(connection: Connection, collection_id: int, since: datetime) -> list[PersonFigures]:
    schema_version(connection, collection_id)
    draft, check = t.draft.c, t.blind_check.c
    checks = (
        select(check.person_id, func.count().label("n_checks"), func.avg(check.area_agreement).label("mean"))
        .where(check.collection_id == collection_id, check.checked_at >= since)
        .group_by(check.person_id)
        .subquery()
    )
    done = (
        select(
            draft.person_id,
            func.count().label("n_confirmed"),
            func.count(draft.active_s).label("n_timed"),
            func.coalesce(func.sum(draft.active_s), 0.0).label("active_s"),
            func.coalesce(func.sum(draft.n_clicks), 0).label("n_clicks"),
            func.max(draft.closed_at).label("last_at"),
        )
        # written out: a partial index serves only a query whose text repeats its condition
        .where(text(f"draft.outcome = '{DraftOutcome.CONFIRMED}'"))
        .where(draft.collection_id == collection_id, draft.closed_at >= since)
        .group_by(draft.person_id)
        .subquery()
    )
    query = (
        select(t.person.c.id, t.person.c.name, done, checks.c.n_checks, checks.c.mean)
        .join_from(done, t.person, t.person.c.id == done.c.person_id)
        .join(checks, checks.c.person_id == done.c.person_id, isouter=True)
        .order_by(t.person.c.name)
    )
    return [
        PersonFigures(
            row.id,
            row.name,
            row.n_confirmed,
            row.n_timed,
            float(row.active_s),
            int(row.n_clicks),
            row.last_at,
            row.n_checks or 0,
            row.mean,
        )
        for row in connection.execute(query)
    ]
