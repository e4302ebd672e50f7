"""What it takes to draw shapes: their labels of each kind, whose they are, and who is at them."""

from collections.abc import Sequence
from typing import Any

from sqlalchemy import BindParameter, Connection, Row, Select, bindparam, select

from partwise.store import tables as t
from partwise.store.catalog import SHOWN_KINDS
from partwise.store.records import Holder, ShapeTile
from partwise.store.sql.dialect import batches
from partwise.store.sql.state import is_current_run

_PREDICTED, _REFINED = "evaluate", "refine"
"""The stages that leave predicted and refined labels behind."""
_IDS: BindParameter[int] = bindparam("ids", expanding=True)


def shape_tiles(connection: Connection, shape_ids: Sequence[int]) -> dict[int, ShapeTile]:
    found: dict[int, ShapeTile] = {}
    for some in batches(shape_ids):
        versions, holders = _model_versions(connection, some), _holders(connection, some)
        for row in connection.execute(_TILES, {"ids": some}):
            found[row.id] = _tile(row, versions, tuple(holders.get(row.id, ())))
    return found


def _tile(row: Row[Any], versions: dict[tuple[int, str], tuple[str, int]], holders: tuple[Holder, ...]) -> ShapeTile:
    def version(stage: str) -> int | None:
        mesh_hash, model_version = versions.get((row.id, stage), (None, None))
        return model_version if mesh_hash == row.mesh_hash else None  # else made before the shape got this mesh

    return ShapeTile(
        n_faces=row.n_faces,
        revision_id=row.revision_id,
        author_name=row.author_name,
        has_confirmed=row.revision_id is not None and row.labelled_mesh == row.mesh_hash,
        predicted_version=version(_PREDICTED),
        refined_version=version(_REFINED),
        holders=holders,
    )


def _model_versions(connection: Connection, shape_ids: Sequence[int]) -> dict[tuple[int, str], tuple[str, int]]:
    """By shape and stage: the mesh and the model version of its present labels."""
    return {
        (row.shape_id, row.stage): (row.summary["mesh_hash"], row.summary["model_version"])
        for row in connection.execute(_RUNS, {"ids": shape_ids})
        if {"mesh_hash", "model_version"} <= row.summary.keys()
    }


def _holders(connection: Connection, shape_ids: Sequence[int]) -> dict[int, list[Holder]]:
    found: dict[int, list[Holder]] = {}
    for row in connection.execute(_HOLDERS, {"ids": shape_ids}):
        found.setdefault(row.shape_id, []).append(Holder(row.person_id, row.name, row.expires_at))
    return found


def _tiles() -> Select[Any]:
    """Shapes with their meshes and their newest shown labels."""
    newest = t.label_revision.alias("newest")
    kinds = [kind.value for kind in SHOWN_KINDS]
    of_shape = select(newest.c.id).where(newest.c.shape_id == t.shape.c.id, newest.c.kind.in_(kinds))
    head = t.label_revision.c
    return (
        select(
            t.shape.c.id,
            t.shape.c.mesh_hash,
            t.mesh.c.n_faces,
            head.id.label("revision_id"),
            head.mesh_hash.label("labelled_mesh"),
            t.person.c.name.label("author_name"),
        )
        .join_from(t.shape, t.mesh, t.mesh.c.hash == t.shape.c.mesh_hash, isouter=True)
        .join(
            t.label_revision, head.id == of_shape.order_by(newest.c.id.desc()).limit(1).scalar_subquery(), isouter=True
        )
        .join(t.person, t.person.c.id == head.author_id, isouter=True)
        .where(t.shape.c.id.in_(_IDS))
    )


# Built once: every page of the table asks them.
_TILES = _tiles()
_RUNS = select(t.stage_run.c.shape_id, t.stage_run.c.stage, t.stage_run.c.summary).where(
    t.stage_run.c.shape_id.in_(_IDS), t.stage_run.c.stage.in_((_PREDICTED, _REFINED)), is_current_run()
)
_HOLDERS = (
    select(t.lease.c.shape_id, t.lease.c.person_id, t.person.c.name, t.lease.c.expires_at)
    .join_from(t.lease, t.person, t.person.c.id == t.lease.c.person_id)
    .where(t.lease.c.shape_id.in_(_IDS), t.lease.c.released_at.is_(None))
    .order_by(t.lease.c.id)
)
