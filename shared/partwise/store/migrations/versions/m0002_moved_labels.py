"""Labels that follow their shape to another mesh: present meshes, reviews, parts in use, parents of parts.

Shapes that were ingested before get their newest mesh as working and as original mesh: there was no other then.
"""

import numpy as np
import sqlalchemy as sa
from alembic import op
from numcodecs import Zstd  # type: ignore[import-untyped]  # ships no types

revision = "0002"
down_revision = "0001"
branch_labels = None
depends_on = None

_TIME = sa.DateTime(timezone=True)
_PAGE = 500


def upgrade() -> None:
    """Add columns and tables, then fill them from what is there."""
    _parts_with_parents()
    _present_meshes()
    op.add_column("label_revision", sa.Column("origin", sa.JSON))
    _label_parts()
    _reviews()
    _fill_present_meshes()
    _fill_label_parts()


def _parts_with_parents() -> None:
    if op.get_context().dialect.name != "sqlite":
        op.add_column("part", sa.Column("parent_id", sa.Integer))
        op.create_foreign_key(
            "fk_part_collection_id_parent_id", "part", "part", ["collection_id", "parent_id"], ["collection_id", "id"]
        )
        return
    # SQLite adds no constraint of two columns to a table, so that it is made anew; nothing refers to it yet.
    op.create_table(
        "new_part",
        sa.Column("collection_id", sa.Integer, nullable=False),
        sa.Column("id", sa.Integer, nullable=False, autoincrement=False),
        sa.Column("name", sa.String(64), nullable=False),
        sa.Column("colour", sa.String(7), nullable=False),
        sa.Column("gloss", sa.Text, nullable=False),
        sa.Column("ordinal", sa.Integer, nullable=False),
        sa.Column("schema_version_added", sa.Integer, nullable=False),
        sa.Column("schema_version_removed", sa.Integer),
        sa.Column("parent_id", sa.Integer),
        sa.PrimaryKeyConstraint("collection_id", "id", name="pk_part"),
        sa.ForeignKeyConstraint(["collection_id"], ["collection.id"], name="fk_part_collection_id"),
        sa.ForeignKeyConstraint(
            ["collection_id", "parent_id"], ["part.collection_id", "part.id"], name="fk_part_collection_id_parent_id"
        ),
        sa.CheckConstraint("id >= 1 AND id <= 65535", name="ck_part_id"),
    )
    columns = "collection_id, id, name, colour, gloss, ordinal, schema_version_added, schema_version_removed"
    op.execute(f"INSERT INTO new_part ({columns}) SELECT {columns} FROM part")  # noqa: S608 # columns are ours
    op.drop_table("part")
    op.rename_table("new_part", "part")
    op.create_index(
        "uq_part_current_name",
        "part",
        ["collection_id", "name"],
        unique=True,
        sqlite_where=sa.text("schema_version_removed IS NULL"),
    )


def _present_meshes() -> None:
    for column in ("mesh_hash", "original_mesh_hash"):  # in SQL: for SQLite the constraint must come with the column
        op.execute(
            f"ALTER TABLE shape ADD COLUMN {column} VARCHAR(64) CONSTRAINT fk_shape_{column} REFERENCES mesh (hash)"
        )


def _label_parts() -> None:
    op.create_table(
        "label_part",
        sa.Column("collection_id", sa.Integer, nullable=False, autoincrement=False),
        sa.Column("part_id", sa.Integer, nullable=False, autoincrement=False),
        sa.Column("revision_id", sa.Integer, nullable=False, autoincrement=False),
        sa.PrimaryKeyConstraint("collection_id", "part_id", "revision_id", name="pk_label_part"),
        sa.ForeignKeyConstraint(
            ["collection_id", "part_id"], ["part.collection_id", "part.id"], name="fk_label_part_collection_id_part_id"
        ),
        sa.ForeignKeyConstraint(["revision_id"], ["label_revision.id"], name="fk_label_part_revision_id"),
    )


def _reviews() -> None:
    op.create_table(
        "review",
        sa.Column("id", sa.Integer),
        sa.Column("collection_id", sa.Integer, nullable=False),
        sa.Column("shape_id", sa.Integer, nullable=False),
        sa.Column("revision_id", sa.Integer, nullable=False),
        sa.Column("reason", sa.String(16), nullable=False),
        sa.Column("detail", sa.JSON, nullable=False),
        sa.Column("created_at", _TIME, nullable=False),
        sa.Column("resolved_at", _TIME),
        sa.Column("resolved_by", sa.Integer),
        sa.Column("outcome", sa.String(16)),
        sa.PrimaryKeyConstraint("id", name="pk_review"),
        sa.ForeignKeyConstraint(["collection_id"], ["collection.id"], name="fk_review_collection_id"),
        sa.ForeignKeyConstraint(["shape_id"], ["shape.id"], name="fk_review_shape_id"),
        sa.ForeignKeyConstraint(["revision_id"], ["label_revision.id"], name="fk_review_revision_id"),
        sa.ForeignKeyConstraint(["resolved_by"], ["person.id"], name="fk_review_resolved_by"),
        sa.CheckConstraint("(resolved_at IS NULL) = (outcome IS NULL)", name="ck_review_resolved_has_outcome"),
    )
    op.create_index("ix_review_shape_id", "review", ["shape_id"])
    is_open = sa.text("resolved_at IS NULL")
    op.create_index(
        "uq_review_open",
        "review",
        ["shape_id", "reason"],
        unique=True,
        sqlite_where=is_open,
        postgresql_where=is_open,
    )
    op.create_index(
        "ix_review_open_collection_id",
        "review",
        ["collection_id", "id"],
        sqlite_where=is_open,
        postgresql_where=is_open,
    )


def _fill_present_meshes() -> None:
    """The newest mesh of each shape: ids of blocks grow with time; a mesh without a block is older than any."""
    newest = (
        "(SELECT mesh_hash FROM shape_mesh WHERE shape_mesh.shape_id = shape.id "
        "ORDER BY COALESCE(block_id, 0) DESC LIMIT 1)"
    )
    op.execute(f"UPDATE shape SET mesh_hash = {newest}")  # noqa: S608 # no input in it
    op.execute("UPDATE shape SET original_mesh_hash = mesh_hash")


def _fill_label_parts() -> None:
    connection = op.get_bind()
    page = sa.text(
        "SELECT label_revision.id, labels, n_faces, collection_id FROM label_revision "
        "JOIN shape ON shape.id = label_revision.shape_id WHERE label_revision.id > :after "
        "ORDER BY label_revision.id LIMIT :page"
    )
    insert = sa.text("INSERT INTO label_part (collection_id, part_id, revision_id) VALUES (:collection, :part, :id)")
    after = 0
    while rows := connection.execute(page, {"after": after, "page": _PAGE}).all():
        used = [
            {"collection": row.collection_id, "part": part_id, "id": row.id}
            for row in rows
            for part_id in _part_ids(bytes(row.labels), row.n_faces)
        ]
        if used:
            connection.execute(insert, used)
        after = rows[-1].id


def _part_ids(blob: bytes, n_faces: int) -> list[int]:
    """Parts that labels name, as they were stored then: a zstd frame of little-endian uint16, 0 = unlabelled."""
    if not n_faces:
        return []
    ids: list[int] = np.unique(np.frombuffer(bytes(Zstd().decode(blob)), dtype="<u2")).tolist()
    return [part_id for part_id in ids if part_id]
