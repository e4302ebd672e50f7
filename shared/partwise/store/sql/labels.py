"""Label revisions: checked, compressed, committed, and never changed."""

from collections.abc import Collection as SizedIterable
from collections.abc import Sequence
from datetime import datetime
from typing import Any

import numpy as np
from jaxtyping import UInt16
from sqlalchemy import Connection, Row, Select, func, insert, select

from partwise.errors import LabelError, NotFoundError
from partwise.labels.checks import checked_labels
from partwise.labels.encoding import EncodedLabels, decode_labels, encode_labels
from partwise.store import tables as t
from partwise.store.records import LabelRevision, NewRevision, RevisionKind
from partwise.store.sql.collections import append_audit, parts
from partwise.store.sql.dialect import batches
from partwise.store.sql.shapes import refuse_unknown_shapes

_COLUMNS = tuple(column for column in t.label_revision.c if column.name != "labels")  # the blob only when asked for


def add_revision(connection: Connection, revision: NewRevision, now: datetime) -> LabelRevision:
    shape = refuse_unknown_shapes(connection, [revision.shape_id])[revision.shape_id]
    author = connection.execute(select(t.person.c.name).where(t.person.c.id == revision.author_id)).scalar()
    if author is None:
        raise NotFoundError(f"there is no person with id {revision.author_id}; add the author first")
    schema = parts(connection, shape.collection_id, revision.schema_version)
    encoded = encode_labels(checked_labels(revision.labels, _n_faces(connection, revision), schema))
    _refuse_foreign_parent(connection, revision)
    values = {
        "shape_id": revision.shape_id,
        "mesh_hash": revision.mesh_hash,
        "kind": RevisionKind(revision.kind).value,
        "parent_id": revision.parent_id,
        "author_id": revision.author_id,
        "schema_version": revision.schema_version,
        "n_faces": encoded.n_faces,
        "sha256": encoded.sha256,
        "created_at": now,
    }
    statement = insert(t.label_revision).values(**values, labels=encoded.blob).returning(t.label_revision.c.id)
    revision_id = connection.execute(statement).scalar_one()
    detail = {"kind": values["kind"], "shape_id": revision.shape_id, "sha256": encoded.sha256}
    append_audit(connection, author, "label", f"label_revision {revision_id}", detail, now)
    return LabelRevision(**{**values, "id": revision_id, "kind": revision.kind})


def _n_faces(connection: Connection, revision: NewRevision) -> int:
    query = (
        select(t.mesh.c.n_faces)
        .join_from(t.mesh, t.shape_mesh)
        .where(t.shape_mesh.c.shape_id == revision.shape_id, t.shape_mesh.c.mesh_hash == revision.mesh_hash)
    )
    n_faces = connection.execute(query).scalar()
    if n_faces is None:
        raise LabelError(
            f"labels must belong to a mesh of their shape but shape {revision.shape_id} has no mesh "
            f"{revision.mesh_hash[:12]}…; were they made on another mesh?"
        )
    return n_faces


def _refuse_foreign_parent(connection: Connection, revision: NewRevision) -> None:
    if revision.parent_id is None:
        return
    query = select(t.label_revision.c.shape_id).where(t.label_revision.c.id == revision.parent_id)
    owner = connection.execute(query).scalar()
    if owner != revision.shape_id:
        belongs = "does not exist" if owner is None else f"belongs to shape {owner}"
        raise LabelError(
            f"a parent must be a revision of the same shape but revision {revision.parent_id} {belongs} "
            f"and the labels are for shape {revision.shape_id}"
        )


def _record(row: Row[Any]) -> LabelRevision:
    return LabelRevision(**{**row._mapping, "kind": RevisionKind(row.kind)})


def revision(connection: Connection, revision_id: int) -> LabelRevision:
    row = connection.execute(select(*_COLUMNS).where(t.label_revision.c.id == revision_id)).first()
    if row is None:
        raise NotFoundError(f"there is no label revision {revision_id}")
    return _record(row)


def revisions(connection: Connection, shape_id: int) -> Sequence[LabelRevision]:
    query = select(*_COLUMNS).where(t.label_revision.c.shape_id == shape_id).order_by(t.label_revision.c.id)
    return [_record(row) for row in connection.execute(query)]


def labels(connection: Connection, revision_id: int) -> UInt16[np.ndarray, " m"]:
    columns = (t.label_revision.c.labels, t.label_revision.c.n_faces, t.label_revision.c.sha256)
    row = connection.execute(select(*columns).where(t.label_revision.c.id == revision_id)).first()
    if row is None:
        raise NotFoundError(f"there is no label revision {revision_id}")
    return decode_labels(EncodedLabels(bytes(row.labels), row.n_faces, row.sha256))


def _heads(kinds: Sequence[RevisionKind]) -> Select[Any]:
    """Per shape the id of its newest revision of these kinds: ids grow with time."""
    return (
        select(func.max(t.label_revision.c.id))
        .where(t.label_revision.c.kind.in_([RevisionKind(kind).value for kind in kinds]))
        .group_by(t.label_revision.c.shape_id)
    )


def head_revisions(
    connection: Connection, shape_ids: SizedIterable[int], kinds: Sequence[RevisionKind]
) -> dict[int, LabelRevision]:
    found = {}
    for some in batches(shape_ids):
        heads = _heads(kinds).where(t.label_revision.c.shape_id.in_(some)).scalar_subquery()
        for row in connection.execute(select(*_COLUMNS).where(t.label_revision.c.id.in_(heads))):
            found[row.shape_id] = _record(row)
    return found


def labelled_shapes(
    connection: Connection, collection_id: int, kinds: Sequence[RevisionKind], after: int, limit: int
) -> Sequence[LabelRevision]:
    heads = (
        _heads(kinds)
        .join_from(t.label_revision, t.shape, t.shape.c.id == t.label_revision.c.shape_id)
        .where(t.shape.c.collection_id == collection_id, t.label_revision.c.shape_id > after)
        .order_by(t.label_revision.c.shape_id)
        .limit(limit)
        .scalar_subquery()
    )
    query = select(*_COLUMNS).where(t.label_revision.c.id.in_(heads)).order_by(t.label_revision.c.shape_id)
    return [_record(row) for row in connection.execute(query)]
