"""A catalog of very many shapes, made by the database itself in a minute: rows as they are after months of work.

What a shape has (state, author, cluster, parts, scores, a place in the queue) follows from its number and a seed.
Scores go with the state and the cluster, as they do where a model learned from what was confirmed, so that a filter may
well want just those shapes that an order has last.
"""

from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

import numpy as np
from sqlalchemy import (
    BigInteger,
    ColumnElement,
    Connection,
    Double,
    Engine,
    Integer,
    Table,
    and_,
    case,
    cast,
    exists,
    func,
    insert,
    literal,
    select,
    text,
)

from partwise.labels.encoding import encode_labels
from partwise.store import tables as t
from partwise.store.engine import writing
from partwise.store.records import RevisionKind, RunStatus, ShapeState
from partwise.store.reviews import ReviewReason
from partwise.store.tables.listing import FACETS
from partwise.workspace.choices import ScoreName
from partwise.workspace.segmentations import DESCRIBE, EVALUATE, MESH, REFINE, REMESH

N_CLUSTERS = 64
N_PARTS = 4
SHARES = {
    ShapeState.NEW: 0.06,
    ShapeState.FAILED: 0.04,
    ShapeState.REVIEW: 0.03,
    ShapeState.CONFIRMED: 0.17,
    ShapeState.READY: 0.70,
}
"""Of the shapes; scored are all but new and failed ones."""
_PART_SHARES = (1.0, 0.5, 0.1, 0.01)
_FIRST_AUTHOR_SHARE = 0.5
_PRIME = 1_000_003
_AT = datetime(2026, 1, 1, tzinfo=UTC)
_LABELLED = (ShapeState.CONFIRMED.value, ShapeState.REVIEW.value)
_UNSURFACED = (ShapeState.NEW.value, ShapeState.FAILED.value)


@dataclass(frozen=True, slots=True)
class RowsRequest:
    """What the rows belong to. person_ids : authors of labels, the first of half of them. mesh_hash : of every shape
    that has a surface, of `n_faces` faces, in row 0 of the block `block_id`.
    """

    collection_id: int
    schema_version: int
    n_shapes: int
    person_ids: tuple[int, ...]
    model_id: int
    mesh_hash: str
    n_faces: int
    block_id: int
    seed: int


def fill_rows(engine: Engine, request: RowsRequest) -> None:
    """Adds the shapes with all that belongs to them, and has PostgreSQL gather the statistics that it would in time."""
    with writing(engine) as connection:
        _add_shapes(connection, request)
        _add_facets(connection, request)
        _add_labels(connection, request)
        _add_runs(connection, request)
        _add_scores(connection, request)
        _add_places(connection, request)
        _add_orderings(connection, request)
    if engine.dialect.name == "postgresql":
        with engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
            connection.execute(text("VACUUM ANALYZE"))


def _uniform(shape_id: ColumnElement[int], seed: int, salt: str) -> ColumnElement[float]:
    """A number in [0, 1) that looks drawn for each shape and salt."""
    rng = np.random.default_rng([seed, *salt.encode()])
    a, b, c = (int(value) for value in rng.integers(1, _PRIME, 3))
    big = cast(shape_id, BigInteger)
    drawn = (big * big % _PRIME * a % _PRIME * (big * b % _PRIME) + big * c) % _PRIME
    return cast(cast(drawn, Double) / float(_PRIME), Double)


def _add_shapes(connection: Connection, request: RowsRequest) -> None:
    numbers = select(literal(1).label("i")).cte("numbers", recursive=True)
    numbers = numbers.union_all(select(numbers.c.i + 1).where(numbers.c.i < request.n_shapes))
    columns = ("collection_id", "source_key", "source_hash", "source_suffix", "ingested_at")
    name = literal("shapes/") + func.substr(cast(numbers.c.i + 10_000_000, t.shape.c.source_key.type), 2) + ".off"
    values = (literal(request.collection_id), name, literal("0" * 64), literal(".off"), _time())
    connection.execute(insert(t.shape).from_select(columns, select(*values)))


def _time() -> ColumnElement[datetime]:
    return literal(_AT, t.shape.c.ingested_at.type)


def _add_facets(connection: Connection, request: RowsRequest) -> None:
    shape_id = t.shape.c.id
    drawn, bound, bounds = _uniform(shape_id, request.seed, "state"), 0.0, []
    for each, share in SHARES.items():
        bound += share
        bounds.append((drawn < bound, each.value))
    state = case(*bounds, else_=ShapeState.READY.value)
    people = request.person_ids
    other = cast(func.floor(_uniform(shape_id, request.seed, "author") * len(people)), Integer) + people[0]
    is_firsts = _uniform(shape_id, request.seed, "first author") < _FIRST_AUTHOR_SHARE
    author = case((state.in_(_LABELLED), case((is_firsts, people[0]), else_=other)))
    place = _uniform(shape_id, request.seed, "cluster")
    cluster = case(
        (state != ShapeState.NEW.value, cast(func.floor(place * place * N_CLUSTERS), Integer)),
    )
    is_late = _uniform(shape_id, request.seed, "stage") < 0.2
    failed = case((state == ShapeState.FAILED.value, case((is_late, DESCRIBE), else_=REMESH)))
    columns = ("shape_id", "collection_id", "source_key", "state", "author_id", "failed_stage", "cluster")
    rows = select(shape_id, t.shape.c.collection_id, t.shape.c.source_key, state, author, failed, cluster)
    is_known = exists().where(t.shape_facet.c.shape_id == shape_id)
    rows = rows.where(t.shape.c.collection_id == request.collection_id, ~is_known).order_by(shape_id)
    connection.execute(insert(t.shape_facet).from_select(columns, rows))
    facet = t.shape_facet.c
    surfaced = select(facet.shape_id).where(facet.collection_id == request.collection_id)
    surfaced = surfaced.where(facet.state.not_in(_UNSURFACED))
    hashed = {"mesh_hash": request.mesh_hash, "original_mesh_hash": request.mesh_hash}
    connection.execute(t.shape.update().where(shape_id.in_(surfaced)).values(hashed))
    of_surfaced = select(facet.shape_id, literal(request.mesh_hash), literal(request.block_id), literal(0)).where(
        facet.collection_id == request.collection_id, facet.state.not_in(_UNSURFACED)
    )
    connection.execute(insert(t.shape_mesh).from_select(("shape_id", "mesh_hash", "block_id", "row"), of_surfaced))


def _rows_of(request: RowsRequest, states: tuple[str, ...], *values: Any, but: bool = False) -> Any:
    facet = t.shape_facet.c
    of_state = facet.state.not_in(states) if but else facet.state.in_(states)
    return select(*values).where(facet.collection_id == request.collection_id, of_state).order_by(facet.shape_id)


def _add_labels(connection: Connection, request: RowsRequest) -> None:
    facet, encoded = t.shape_facet.c, encode_labels(np.ones(request.n_faces, dtype=np.uint16))
    revision = {
        "shape_id": facet.shape_id,
        "mesh_hash": literal(request.mesh_hash),
        "kind": literal(RevisionKind.HUMAN.value),
        "author_id": facet.author_id,
        "schema_version": literal(request.schema_version),
        "labels": literal(encoded.blob, t.label_revision.c.labels.type),
        "n_faces": literal(encoded.n_faces),
        "sha256": literal(encoded.sha256),
        "created_at": _time(),
    }
    connection.execute(_insert(t.label_revision, revision, request, _LABELLED))
    made = t.label_revision.c
    review = {
        "collection_id": facet.collection_id,
        "shape_id": facet.shape_id,
        "revision_id": select(made.id).where(made.shape_id == facet.shape_id).scalar_subquery(),
        "reason": literal(ReviewReason.CHECK.value),
        "detail": literal({}, t.review.c.detail.type),
        "created_at": _time(),
    }
    connection.execute(_insert(t.review, review, request, (ShapeState.REVIEW.value,)))
    for part_id, share in enumerate(_PART_SHARES, start=1):
        part = {"collection_id": facet.collection_id, "part_id": literal(part_id), "shape_id": facet.shape_id}
        has_part = _uniform(facet.shape_id, request.seed, f"part {part_id}") < share
        rows = _rows_of(request, _LABELLED, *part.values()).where(has_part)
        connection.execute(insert(t.head_part).from_select(list(part), rows))


def _insert(table: Table, values: dict[str, Any], request: RowsRequest, states: tuple[str, ...]) -> Any:
    return insert(table).from_select(list(values), _rows_of(request, states, *values.values()))


def _add_runs(connection: Connection, request: RowsRequest) -> None:
    facet = t.shape_facet.c
    run = {
        "shape_id": facet.shape_id,
        "key": literal("synthetic"),
        "attempts": literal(1),
        "seconds": literal(1.0),
        "summary": literal({"mesh_hash": request.mesh_hash}, t.stage_run.c.summary.type),
        "finished_at": _time(),
        "is_superseded": literal(False),
    }
    for stage in (MESH, DESCRIBE, EVALUATE, REFINE):
        done = {**run, "stage": literal(stage), "status": literal(RunStatus.DONE.value)}
        rows = _rows_of(request, _UNSURFACED, *done.values(), but=True)
        connection.execute(insert(t.stage_run).from_select(list(done), rows))
    reason = literal("error: a synthetic failure")
    failed = {**run, "stage": facet.failed_stage, "status": literal(RunStatus.FAILED.value), "reason": reason}
    connection.execute(_insert(t.stage_run, failed, request, (ShapeState.FAILED.value,)))


def _add_scores(connection: Connection, request: RowsRequest) -> None:
    facet = t.shape_facet.c
    is_labelled = case((facet.state.in_(_LABELLED), 0.0), else_=1.0)
    for name in ScoreName:
        drawn = _uniform(facet.shape_id, request.seed, name.value)
        value = drawn * 0.4 + is_labelled * 0.4 + cast(facet.cluster, Double) / N_CLUSTERS * 0.2
        score = {
            "shape_id": facet.shape_id,
            "name": literal(name.value),
            "model_id": literal(request.model_id),
            "value": value,
            "scored_at": _time(),
            "collection_id": facet.collection_id,
            **{name: facet[name] for name in FACETS},
        }
        rows = _rows_of(request, _UNSURFACED, *score.values(), but=True)
        connection.execute(insert(t.score).from_select(list(score), rows))


def _add_places(connection: Connection, request: RowsRequest) -> None:
    facet = t.shape_facet.c
    is_it = and_(t.score.c.shape_id == facet.shape_id, t.score.c.name == ScoreName.ENTROPY.value)
    place = {
        "shape_id": facet.shape_id,
        "slot": literal(0),
        "collection_id": facet.collection_id,
        "rank": func.row_number().over(order_by=(t.score.c.value.desc(), facet.shape_id)),
        "round": literal(1),
        "n_slots": literal(1),
        "opened_at": _time(),
    }
    rows = select(*place.values()).join_from(t.shape_facet, t.score, is_it)
    rows = rows.where(facet.collection_id == request.collection_id, facet.state == ShapeState.READY.value)
    connection.execute(insert(t.queue_rank).from_select(list(place), rows))


def _add_orderings(connection: Connection, request: RowsRequest) -> None:
    for name in (None, *ScoreName):
        score, shape = t.score.c, t.shape.c
        if name is None:
            ranked = select(shape.id, func.row_number().over(order_by=shape.id) - 1)
            ranked = ranked.where(shape.collection_id == request.collection_id)
        else:
            ranked = select(score.shape_id, func.row_number().over(order_by=(score.value, score.shape_id)) - 1)
            ranked = ranked.where(score.collection_id == request.collection_id, score.name == name.value)
        n_shapes = connection.execute(select(func.count()).select_from(ranked.subquery())).scalar_one()
        values = {"score_name": name and name.value, "n_shapes": n_shapes, "built_at": _AT, "is_complete": True}
        made = insert(t.ordering).values(collection_id=request.collection_id, **values).returning(t.ordering.c.id)
        ordering_id = connection.execute(made).scalar_one()
        rows = ranked.add_columns(literal(ordering_id))
        connection.execute(insert(t.ordering_row).from_select(("shape_id", "rank", "ordering_id"), rows))
