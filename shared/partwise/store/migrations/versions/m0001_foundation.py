"""Foundation: collections, shapes, stage runs, blocks, labels, models.

What is written here stays as it is: later changes are later migrations.
"""

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision = None
branch_labels = None
depends_on = None

_TIME = sa.DateTime(timezone=True)
_APPEND_ONLY = ("label_revision", "audit")


def upgrade() -> None:
    """Make every table of the first version, then the triggers that keep labels and the audit trail as written."""
    _people_and_collections()
    _shapes_and_blocks()
    _stage_runs()
    _labels()
    _models()
    for table in _APPEND_ONLY:
        _refuse_changes(table)


def _people_and_collections() -> None:
    op.create_table(
        "collection",
        sa.Column("id", sa.Integer),
        sa.Column("name", sa.String(200), nullable=False),
        sa.Column("settings", sa.JSON, nullable=False),
        sa.Column("schema_version", sa.Integer, nullable=False),
        sa.Column("created_at", _TIME, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_collection"),
        sa.UniqueConstraint("name", name="uq_collection_name"),
    )
    op.create_table(
        "part",
        sa.Column("collection_id", sa.Integer, nullable=False),
        sa.Column("id", sa.Integer, nullable=False, autoincrement=False),
        sa.Column("name", sa.String(64), nullable=False),
        sa.Column("colour", sa.String(7), nullable=False),
        sa.Column("gloss", sa.Text, nullable=False),
        sa.Column("ordinal", sa.Integer, nullable=False),
        sa.Column("schema_version_added", sa.Integer, nullable=False),
        sa.Column("schema_version_removed", sa.Integer),
        sa.PrimaryKeyConstraint("collection_id", "id", name="pk_part"),
        sa.ForeignKeyConstraint(["collection_id"], ["collection.id"], name="fk_part_collection_id"),
        sa.CheckConstraint("id >= 1 AND id <= 65535", name="ck_part_id"),
    )
    _partial_index("uq_part_current_name", "part", ["collection_id", "name"], "schema_version_removed IS NULL")
    op.create_table(
        "person",
        sa.Column("id", sa.Integer),
        sa.Column("name", sa.String(200), nullable=False),
        sa.Column("created_at", _TIME, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_person"),
        sa.UniqueConstraint("name", name="uq_person_name"),
    )
    op.create_table(
        "audit",
        sa.Column("id", sa.Integer),
        sa.Column("at", _TIME, nullable=False),
        sa.Column("actor", sa.String(200), nullable=False),
        sa.Column("action", sa.String(64), nullable=False),
        sa.Column("subject", sa.Text, nullable=False),
        sa.Column("detail", sa.JSON, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_audit"),
    )


def _shapes_and_blocks() -> None:
    op.create_table(
        "shape",
        sa.Column("id", sa.Integer),
        sa.Column("collection_id", sa.Integer, nullable=False),
        sa.Column("source_key", sa.Text, nullable=False),
        sa.Column("source_hash", sa.String(64), nullable=False),
        sa.Column("source_suffix", sa.String(16), nullable=False),
        sa.Column("ingested_at", _TIME, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_shape"),
        sa.ForeignKeyConstraint(["collection_id"], ["collection.id"], name="fk_shape_collection_id"),
        sa.UniqueConstraint("collection_id", "source_key", name="uq_shape_collection_id_source_key"),
    )
    op.create_index("ix_shape_collection_id_id", "shape", ["collection_id", "id"])
    op.create_table(
        "block",
        sa.Column("id", sa.Integer),
        sa.Column("name", sa.String(200), nullable=False),
        sa.Column("kind", sa.String(64), nullable=False),
        sa.Column("n_shapes", sa.Integer, nullable=False),
        sa.Column("n_bytes", sa.BigInteger, nullable=False),
        sa.Column("checksum", sa.String(64), nullable=False),
        sa.Column("created_at", _TIME, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_block"),
        sa.UniqueConstraint("name", name="uq_block_name"),
        sqlite_autoincrement=True,
    )
    op.create_table(
        "mesh",
        sa.Column("hash", sa.String(64), nullable=False),
        sa.Column("n_vertices", sa.Integer, nullable=False),
        sa.Column("n_faces", sa.Integer, nullable=False),
        sa.Column("kept_key", sa.Text),
        sa.Column("created_at", _TIME, nullable=False),
        sa.PrimaryKeyConstraint("hash", name="pk_mesh"),
    )
    op.create_table(
        "shape_mesh",
        sa.Column("shape_id", sa.Integer, nullable=False),
        sa.Column("mesh_hash", sa.String(64), nullable=False),
        sa.Column("block_id", sa.Integer),
        sa.Column("row", sa.Integer),
        sa.PrimaryKeyConstraint("shape_id", "mesh_hash", name="pk_shape_mesh"),
        sa.ForeignKeyConstraint(["shape_id"], ["shape.id"], name="fk_shape_mesh_shape_id"),
        sa.ForeignKeyConstraint(["mesh_hash"], ["mesh.hash"], name="fk_shape_mesh_mesh_hash"),
        sa.ForeignKeyConstraint(["block_id"], ["block.id"], name="fk_shape_mesh_block_id"),
    )
    op.create_index("ix_shape_mesh_block_id", "shape_mesh", ["block_id"])
    op.create_index("ix_shape_mesh_mesh_hash", "shape_mesh", ["mesh_hash"])


def _stage_runs() -> None:
    op.create_table(
        "stage_run",
        sa.Column("id", sa.Integer),
        sa.Column("shape_id", sa.Integer, nullable=False),
        sa.Column("stage", sa.String(64), nullable=False),
        sa.Column("key", sa.String(64), nullable=False),
        sa.Column("status", sa.String(8), nullable=False),
        sa.Column("reason", sa.Text),
        sa.Column("attempts", sa.Integer, nullable=False),
        sa.Column("seconds", sa.Double, nullable=False),
        sa.Column("summary", sa.JSON, nullable=False),
        sa.Column("block_id", sa.Integer),
        sa.Column("row", sa.Integer),
        sa.Column("finished_at", _TIME, nullable=False),
        sa.Column("is_superseded", sa.Boolean, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_stage_run"),
        sa.ForeignKeyConstraint(["shape_id"], ["shape.id"], name="fk_stage_run_shape_id"),
        sa.ForeignKeyConstraint(["block_id"], ["block.id"], name="fk_stage_run_block_id"),
        sa.UniqueConstraint("shape_id", "stage", "key", name="uq_stage_run_shape_id_stage_key"),
        sa.CheckConstraint("status IN ('done', 'failed')", name="ck_stage_run_status"),
        sa.CheckConstraint("status = 'done' OR block_id IS NULL", name="ck_stage_run_failed_has_no_block"),
    )
    op.create_index("ix_stage_run_block_id", "stage_run", ["block_id"])
    current = {"sqlite": "status = 'done' AND is_superseded = 0", "postgresql": "status = 'done' AND NOT is_superseded"}
    _partial_index("uq_stage_run_current", "stage_run", ["shape_id", "stage"], current[op.get_context().dialect.name])
    op.create_index(
        "ix_stage_run_failed",
        "stage_run",
        ["shape_id", "stage"],
        sqlite_where=sa.text("status = 'failed'"),
        postgresql_where=sa.text("status = 'failed'"),
    )


def _labels() -> None:
    op.create_table(
        "label_revision",
        sa.Column("id", sa.Integer),
        sa.Column("shape_id", sa.Integer, nullable=False),
        sa.Column("mesh_hash", sa.String(64), nullable=False),
        sa.Column("kind", sa.String(16), nullable=False),
        sa.Column("parent_id", sa.Integer),
        sa.Column("author_id", sa.Integer, nullable=False),
        sa.Column("schema_version", sa.Integer, nullable=False),
        sa.Column("labels", sa.LargeBinary, nullable=False),
        sa.Column("n_faces", sa.Integer, nullable=False),
        sa.Column("sha256", sa.String(64), nullable=False),
        sa.Column("created_at", _TIME, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_label_revision"),
        sa.ForeignKeyConstraint(["shape_id"], ["shape.id"], name="fk_label_revision_shape_id"),
        sa.ForeignKeyConstraint(
            ["shape_id", "mesh_hash"],
            ["shape_mesh.shape_id", "shape_mesh.mesh_hash"],
            name="fk_label_revision_shape_id_mesh_hash",
        ),
        sa.ForeignKeyConstraint(["parent_id"], ["label_revision.id"], name="fk_label_revision_parent_id"),
        sa.ForeignKeyConstraint(["author_id"], ["person.id"], name="fk_label_revision_author_id"),
        sa.CheckConstraint("kind IN ('human', 'imported', 'reference')", name="ck_label_revision_kind"),
    )
    op.create_index("ix_label_revision_shape_id_kind_id", "label_revision", ["shape_id", "kind", "id"])
    op.create_index("ix_label_revision_mesh_hash", "label_revision", ["mesh_hash"])


def _models() -> None:
    op.create_table(
        "model",
        sa.Column("id", sa.Integer),
        sa.Column("collection_id", sa.Integer, nullable=False),
        sa.Column("version", sa.Integer, nullable=False),
        sa.Column("recipe", sa.JSON, nullable=False),
        sa.Column("weights_key", sa.Text, nullable=False),
        sa.Column("revision_ids", sa.JSON, nullable=False),
        sa.Column("n_shapes", sa.Integer, nullable=False),
        sa.Column("trained_at", _TIME, nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_model"),
        sa.ForeignKeyConstraint(["collection_id"], ["collection.id"], name="fk_model_collection_id"),
        sa.UniqueConstraint("collection_id", "version", name="uq_model_collection_id_version"),
    )
    op.create_table(
        "score",
        sa.Column("shape_id", sa.Integer, nullable=False),
        sa.Column("name", sa.String(64), nullable=False),
        sa.Column("model_id", sa.Integer, nullable=False),
        sa.Column("value", sa.Double, nullable=False),
        sa.Column("scored_at", _TIME, nullable=False),
        sa.Column("collection_id", sa.Integer, nullable=False),
        sa.PrimaryKeyConstraint("shape_id", "name", name="pk_score"),
        sa.ForeignKeyConstraint(["shape_id"], ["shape.id"], name="fk_score_shape_id"),
        sa.ForeignKeyConstraint(["model_id"], ["model.id"], name="fk_score_model_id"),
        sa.ForeignKeyConstraint(["collection_id"], ["collection.id"], name="fk_score_collection_id"),
    )
    op.create_index(
        "ix_score_collection_id_name_value_shape_id", "score", ["collection_id", "name", "value", "shape_id"]
    )
    op.create_table(
        "first_shape",
        sa.Column("collection_id", sa.Integer, nullable=False),
        sa.Column("ordinal", sa.Integer, nullable=False, autoincrement=False),
        sa.Column("shape_id", sa.Integer, nullable=False),
        sa.Column("cluster", sa.Integer, nullable=False),
        sa.PrimaryKeyConstraint("collection_id", "ordinal", name="pk_first_shape"),
        sa.ForeignKeyConstraint(["collection_id"], ["collection.id"], name="fk_first_shape_collection_id"),
        sa.ForeignKeyConstraint(["shape_id"], ["shape.id"], name="fk_first_shape_shape_id"),
    )
    op.create_table(
        "embedding",
        sa.Column("collection_id", sa.Integer, nullable=False, autoincrement=False),
        sa.Column("key", sa.Text, nullable=False),
        sa.Column("created_at", _TIME, nullable=False),
        sa.PrimaryKeyConstraint("collection_id", name="pk_embedding"),
        sa.ForeignKeyConstraint(["collection_id"], ["collection.id"], name="fk_embedding_collection_id"),
    )


def _partial_index(name: str, table: str, columns: list[str], condition: str) -> None:
    where = sa.text(condition)
    op.create_index(name, table, columns, unique=True, sqlite_where=where, postgresql_where=where)


def _refuse_changes(table: str) -> None:
    """Triggers in the database itself, so that no program, not even this one, changes what was committed."""
    message = f"{table} is append-only"
    if op.get_context().dialect.name == "sqlite":
        for action in ("UPDATE", "DELETE"):
            op.execute(
                f"CREATE TRIGGER {table}_no_{action.lower()} BEFORE {action} ON {table} "
                f"BEGIN SELECT RAISE(ABORT, '{message}'); END"
            )
        return
    op.execute(
        f"CREATE FUNCTION {table}_append_only() RETURNS trigger LANGUAGE plpgsql AS "
        f"$$ BEGIN RAISE EXCEPTION '{message}'; END $$"
    )
    op.execute(
        f"CREATE TRIGGER {table}_append_only BEFORE UPDATE OR DELETE OR TRUNCATE ON {table} "
        f"FOR EACH STATEMENT EXECUTE FUNCTION {table}_append_only()"
    )
