"""What it takes to draw shapes: their labels of each kind, whose they are, and who is at them."""

from collections.abc import Sequence
from typing import Any

from sqlalchemy import Connection, Row, select

from partwise.store import tables as t
from partwise.store.catalog import SHOWN_KINDS
from partwise.store.records import Holder, LabelRevision, ShapeTile
from partwise.store.sql.dialect import batches
from partwise.store.sql.labels import head_revisions
from partwise.store.sql.state import is_current_run

_PREDICTED, _REFINED = "evaluate", "refine"
"""The stages that leave predicted and refined labels behind."""


def shape_tiles(connection: Connection, shape_ids: Sequence[int]) -> dict[int, ShapeTile]:
    found: dict[int, ShapeTile] = {}
    for some in batches(shape_ids):
        heads = head_revisions(connection, some, SHOWN_KINDS)
        names = _names(connection, {head.author_id for head in heads.values()})
        versions, holders = _model_versions(connection, some), _holders(connection, some)
        query = (
            select(t.shape.c.id, t.shape.c.mesh_hash, t.mesh.c.n_faces)
            .join_from(t.shape, t.mesh, t.mesh.c.hash == t.shape.c.mesh_hash, isouter=True)
            .where(t.shape.c.id.in_(some))
        )
        for row in connection.execute(query):
            found[row.id] = _tile(row, heads.get(row.id), names, versions, tuple(holders.get(row.id, ())))
    return found


def _tile(
    row: Row[Any, Any, Any],
    head: LabelRevision | None,
    names: dict[int, str],
    versions: dict[tuple[int, str], tuple[str, int]],
    holders: tuple[Holder, ...],
) -> ShapeTile:
    def version(stage: str) -> int | None:
        mesh_hash, model_version = versions.get((row.id, stage), (None, None))
        return model_version if mesh_hash == row.mesh_hash else None  # else made before the shape got this mesh

    return ShapeTile(
        n_faces=row.n_faces,
        revision_id=None if head is None else head.id,
        author_name=None if head is None else names[head.author_id],
        has_confirmed=head is not None and head.mesh_hash == row.mesh_hash,
        predicted_version=version(_PREDICTED),
        refined_version=version(_REFINED),
        holders=holders,
    )


def _names(connection: Connection, person_ids: set[int]) -> dict[int, str]:
    if not person_ids:
        return {}
    query = select(t.person.c.id, t.person.c.name).where(t.person.c.id.in_(person_ids))
    return {row.id: row.name for row in connection.execute(query)}


def _model_versions(connection: Connection, shape_ids: Sequence[int]) -> dict[tuple[int, str], tuple[str, int]]:
    """By shape and stage: the mesh and the model version of its present labels."""
    run = t.stage_run.c
    query = select(run.shape_id, run.stage, run.summary).where(
        run.shape_id.in_(shape_ids), run.stage.in_((_PREDICTED, _REFINED)), is_current_run()
    )
    return {
        (row.shape_id, row.stage): (row.summary["mesh_hash"], row.summary["model_version"])
        for row in connection.execute(query)
        if {"mesh_hash", "model_version"} <= row.summary.keys()
    }


def _holders(connection: Connection, shape_ids: Sequence[int]) -> dict[int, list[Holder]]:
    lease = t.lease.c
    query = (
        select(lease.shape_id, lease.person_id, t.person.c.name, lease.expires_at)
        .join_from(t.lease, t.person, t.person.c.id == lease.person_id)
        .where(lease.shape_id.in_(shape_ids), lease.released_at.is_(None))
        .order_by(lease.id)
    )
    found: dict[int, list[Holder]] = {}
    for row in connection.execute(query):
        found.setdefault(row.shape_id, []).append(Holder(row.person_id, row.name, row.expires_at))
    return found
