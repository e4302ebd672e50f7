"""People at work: queue, leases, drafts, answers, jobs, events, tokens.

Shapes that are ready and without shown labels go into the queue; reference labels on record become known ones.
"""

from datetime import UTC, datetime
from typing import Any

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"
branch_labels = None
depends_on = None

_TIME = sa.DateTime(timezone=True)
_APPEND_ONLY = ("stroke", "answer")


def upgrade() -> None:
    """Make the tables, the triggers that keep people's work as written, and the queue of what is there."""
    _leases()
    _drafts()
    _answers()
    _jobs()
    _tokens()
    for table in _APPEND_ONLY:
        _refuse_changes(table)
    _fill_queue()
    _fill_honeypots()


def _leases() -> None:
    op.create_table(
        "lease",
        sa.Column("id", sa.Integer),
        sa.Column("collection_id", sa.Integer, nullable=False),
        sa.Column("shape_id", sa.Integer, nullable=False),
        sa.Column("slot", sa.Integer, nullable=False),
        sa.Column("round", sa.Integer, nullable=False),
        sa.Column("person_id", sa.Integer, nullable=False),
        sa.Column("purpose", sa.String(16), nullable=False),
        sa.Column("is_prefetched", sa.Boolean, nullable=False),
        sa.Column("acquired_at", _TIME, nullable=False),
        sa.Column("expires_at", _TIME, nullable=False),
        sa.Column("released_at", _TIME),
        sa.Column("outcome", sa.String(16)),
        sa.Column("reason", sa.Text),
        sa.CheckConstraint("(released_at IS NULL) = (outcome IS NULL)", name="ck_lease_released_has_outcome"),
        sa.ForeignKeyConstraint(["collection_id"], ["collection.id"], name="fk_lease_collection_id"),
        sa.ForeignKeyConstraint(["person_id"], ["person.id"], name="fk_lease_person_id"),
        sa.ForeignKeyConstraint(["shape_id"], ["shape.id"], name="fk_lease_shape_id"),
        sa.PrimaryKeyConstraint("id", name="pk_lease"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_lease_active_collection_id", "lease", ["collection_id", "id"], **_where("released_at IS NULL"))
    op.create_index("ix_lease_active_expires_at", "lease", ["expires_at"], **_where("released_at IS NULL"))
    op.create_index("ix_lease_person_id_shape_id", "lease", ["person_id", "shape_id"])
    op.create_index("ix_lease_shape_id_round", "lease", ["shape_id", "round"])
    op.create_index(
        "uq_lease_active_person", "lease", ["person_id", "shape_id"], unique=True, **_where("released_at IS NULL")
    )
    op.create_index("uq_lease_active_slot", "lease", ["shape_id", "slot"], unique=True, **_where("released_at IS NULL"))
    op.create_table(
        "queue_rank",
        sa.Column("shape_id", sa.Integer, nullable=False),
        sa.Column("slot", sa.Integer, autoincrement=False, nullable=False),
        sa.Column("collection_id", sa.Integer, nullable=False),
        sa.Column("rank", sa.BigInteger, nullable=False),
        sa.Column("round", sa.Integer, nullable=False),
        sa.Column("n_slots", sa.Integer, nullable=False),
        sa.Column("person_id", sa.Integer),
        sa.Column("lease_id", sa.Integer),
        sa.Column("opened_at", _TIME, nullable=False),
        sa.ForeignKeyConstraint(["collection_id"], ["collection.id"], name="fk_queue_rank_collection_id"),
        sa.ForeignKeyConstraint(["lease_id"], ["lease.id"], name="fk_queue_rank_lease_id"),
        sa.ForeignKeyConstraint(["person_id"], ["person.id"], name="fk_queue_rank_person_id"),
        sa.ForeignKeyConstraint(["shape_id"], ["shape.id"], name="fk_queue_rank_shape_id"),
        sa.PrimaryKeyConstraint("shape_id", "slot", name="pk_queue_rank"),
    )
    op.create_index("uq_queue_rank_held", "queue_rank", ["lease_id"], unique=True, **_where("lease_id IS NOT NULL"))
    op.create_index(
        "ix_queue_rank_assigned",
        "queue_rank",
        ["collection_id", "person_id", "rank", "shape_id", "slot"],
        **_where("lease_id IS NULL AND person_id IS NOT NULL"),
    )
    op.create_index("ix_queue_rank_collection_id_shape_id", "queue_rank", ["collection_id", "shape_id"])
    op.create_index(
        "ix_queue_rank_free",
        "queue_rank",
        ["collection_id", "rank", "shape_id", "slot"],
        **_where("lease_id IS NULL AND person_id IS NULL"),
    )
    op.create_table(
        "honeypot",
        sa.Column("collection_id", sa.Integer, nullable=False),
        sa.Column("shape_id", sa.Integer, nullable=False),
        sa.Column("revision_id", sa.Integer, nullable=False),
        sa.ForeignKeyConstraint(["collection_id"], ["collection.id"], name="fk_honeypot_collection_id"),
        sa.ForeignKeyConstraint(["revision_id"], ["label_revision.id"], name="fk_honeypot_revision_id"),
        sa.ForeignKeyConstraint(["shape_id"], ["shape.id"], name="fk_honeypot_shape_id"),
        sa.PrimaryKeyConstraint("collection_id", "shape_id", name="pk_honeypot"),
    )


def _drafts() -> None:
    op.create_table(
        "draft",
        sa.Column("id", sa.Integer),
        sa.Column("collection_id", sa.Integer, nullable=False),
        sa.Column("shape_id", sa.Integer, nullable=False),
        sa.Column("slot", sa.Integer, nullable=False),
        sa.Column("round", sa.Integer, nullable=False),
        sa.Column("person_id", sa.Integer, nullable=False),
        sa.Column("purpose", sa.String(16), nullable=False),
        sa.Column("mesh_hash", sa.String(64), nullable=False),
        sa.Column("base_revision", sa.Integer),
        sa.Column("base_sha256", sa.String(64), nullable=False),
        sa.Column("seen_revision", sa.Integer),
        sa.Column("schema_version", sa.Integer, nullable=False),
        sa.Column("n_strokes", sa.Integer, nullable=False),
        sa.Column("created_at", _TIME, nullable=False),
        sa.Column("updated_at", _TIME, nullable=False),
        sa.Column("closed_at", _TIME),
        sa.Column("outcome", sa.String(16)),
        sa.Column("labels_sha256", sa.String(64)),
        sa.CheckConstraint("(closed_at IS NULL) = (outcome IS NULL)", name="ck_draft_closed_has_outcome"),
        sa.ForeignKeyConstraint(["base_revision"], ["label_revision.id"], name="fk_draft_base_revision"),
        sa.ForeignKeyConstraint(["seen_revision"], ["label_revision.id"], name="fk_draft_seen_revision"),
        sa.ForeignKeyConstraint(["collection_id"], ["collection.id"], name="fk_draft_collection_id"),
        sa.ForeignKeyConstraint(["person_id"], ["person.id"], name="fk_draft_person_id"),
        sa.ForeignKeyConstraint(
            ["shape_id", "mesh_hash"],
            ["shape_mesh.shape_id", "shape_mesh.mesh_hash"],
            name="fk_draft_shape_id_mesh_hash",
        ),
        sa.ForeignKeyConstraint(["shape_id"], ["shape.id"], name="fk_draft_shape_id"),
        sa.PrimaryKeyConstraint("id", name="pk_draft"),
    )
    op.create_index("ix_draft_person_id_id", "draft", ["person_id", "id"])
    op.create_index("ix_draft_shape_id_mesh_hash", "draft", ["shape_id", "mesh_hash"])
    op.create_index("uq_draft_open", "draft", ["person_id", "shape_id"], unique=True, **_where("closed_at IS NULL"))
    op.create_table(
        "stroke",
        sa.Column("draft_id", sa.Integer, nullable=False),
        sa.Column("sequence", sa.Integer, autoincrement=False, nullable=False),
        sa.Column("id", sa.String(36), nullable=False),
        sa.Column("payload", sa.JSON, nullable=False),
        sa.Column("recorded_at", _TIME, nullable=False),
        sa.ForeignKeyConstraint(["draft_id"], ["draft.id"], name="fk_stroke_draft_id"),
        sa.PrimaryKeyConstraint("draft_id", "sequence", name="pk_stroke"),
        sa.UniqueConstraint("draft_id", "id", name="uq_stroke_draft_id_id"),
    )


def _answers() -> None:
    op.create_table(
        "answer",
        sa.Column("id", sa.Integer),
        sa.Column("shape_id", sa.Integer, nullable=False),
        sa.Column("slot", sa.Integer, nullable=False),
        sa.Column("round", sa.Integer, nullable=False),
        sa.Column("person_id", sa.Integer, nullable=False),
        sa.Column("draft_id", sa.Integer, nullable=False),
        sa.Column("purpose", sa.String(16), nullable=False),
        sa.Column("mesh_hash", sa.String(64), nullable=False),
        sa.Column("schema_version", sa.Integer, nullable=False),
        sa.Column("labels", sa.LargeBinary, nullable=False),
        sa.Column("n_faces", sa.Integer, nullable=False),
        sa.Column("sha256", sa.String(64), nullable=False),
        sa.Column("created_at", _TIME, nullable=False),
        sa.ForeignKeyConstraint(["draft_id"], ["draft.id"], name="fk_answer_draft_id"),
        sa.ForeignKeyConstraint(["person_id"], ["person.id"], name="fk_answer_person_id"),
        sa.ForeignKeyConstraint(["shape_id"], ["shape.id"], name="fk_answer_shape_id"),
        sa.PrimaryKeyConstraint("id", name="pk_answer"),
        sa.UniqueConstraint("draft_id", name="uq_answer_draft_id"),
    )
    op.create_index("ix_answer_shape_id_round", "answer", ["shape_id", "round"])
    op.create_table(
        "consensus",
        sa.Column("id", sa.Integer),
        sa.Column("shape_id", sa.Integer, nullable=False),
        sa.Column("round", sa.Integer, nullable=False),
        sa.Column("answer_ids", sa.JSON, nullable=False),
        sa.Column("area_agreement", sa.Double, nullable=False),
        sa.Column("part_iou", sa.Double, nullable=False),
        sa.Column("boundary_distance", sa.Double, nullable=False),
        sa.Column("is_agreed", sa.Boolean, nullable=False),
        sa.Column("medoid_id", sa.Integer, nullable=False),
        sa.Column("revision_id", sa.Integer, nullable=False),
        sa.Column("settled_at", _TIME, nullable=False),
        sa.ForeignKeyConstraint(["medoid_id"], ["answer.id"], name="fk_consensus_medoid_id"),
        sa.ForeignKeyConstraint(["revision_id"], ["label_revision.id"], name="fk_consensus_revision_id"),
        sa.ForeignKeyConstraint(["shape_id"], ["shape.id"], name="fk_consensus_shape_id"),
        sa.PrimaryKeyConstraint("id", name="pk_consensus"),
        sa.UniqueConstraint("shape_id", "round", name="uq_consensus_shape_id_round"),
    )
    op.create_table(
        "blind_check",
        sa.Column("id", sa.Integer),
        sa.Column("collection_id", sa.Integer, nullable=False),
        sa.Column("shape_id", sa.Integer, nullable=False),
        sa.Column("person_id", sa.Integer, nullable=False),
        sa.Column("answer_id", sa.Integer, nullable=False),
        sa.Column("reference_id", sa.Integer, nullable=False),
        sa.Column("area_agreement", sa.Double, nullable=False),
        sa.Column("part_iou", sa.Double, nullable=False),
        sa.Column("boundary_distance", sa.Double, nullable=False),
        sa.Column("checked_at", _TIME, nullable=False),
        sa.ForeignKeyConstraint(["answer_id"], ["answer.id"], name="fk_blind_check_answer_id"),
        sa.ForeignKeyConstraint(["collection_id"], ["collection.id"], name="fk_blind_check_collection_id"),
        sa.ForeignKeyConstraint(["person_id"], ["person.id"], name="fk_blind_check_person_id"),
        sa.ForeignKeyConstraint(["reference_id"], ["label_revision.id"], name="fk_blind_check_reference_id"),
        sa.ForeignKeyConstraint(["shape_id"], ["shape.id"], name="fk_blind_check_shape_id"),
        sa.PrimaryKeyConstraint("id", name="pk_blind_check"),
        sa.UniqueConstraint("answer_id", name="uq_blind_check_answer_id"),
    )
    op.create_index("ix_blind_check_collection_id_id", "blind_check", ["collection_id", "id"])


def _jobs() -> None:
    op.create_table(
        "job",
        sa.Column("id", sa.Integer),
        sa.Column("collection_id", sa.Integer, nullable=False),
        sa.Column("kind", sa.String(16), nullable=False),
        sa.Column("parameters", sa.JSON, nullable=False),
        sa.Column("state", sa.String(16), nullable=False),
        sa.Column("owner", sa.String(200)),
        sa.Column("attempts", sa.Integer, nullable=False),
        sa.Column("n_done", sa.Integer, nullable=False),
        sa.Column("n_failed", sa.Integer, nullable=False),
        sa.Column("n_total", sa.Integer),
        sa.Column("message", sa.Text, nullable=False),
        sa.Column("result", sa.JSON),
        sa.Column("cancel_requested", sa.Boolean, nullable=False),
        sa.Column("created_at", _TIME, nullable=False),
        sa.Column("started_at", _TIME),
        sa.Column("heartbeat_at", _TIME),
        sa.Column("finished_at", _TIME),
        sa.CheckConstraint("state IN ('pending', 'running', 'done', 'failed', 'cancelled')", name="ck_job_state"),
        sa.ForeignKeyConstraint(["collection_id"], ["collection.id"], name="fk_job_collection_id"),
        sa.PrimaryKeyConstraint("id", name="pk_job"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_job_collection_id_id", "job", ["collection_id", "id"])
    op.create_index("ix_job_pending", "job", ["id"], **_where("state = 'pending'"))
    op.create_index("ix_job_running", "job", ["collection_id", "kind"], **_where("state = 'running'"))
    op.create_index("ix_job_running_heartbeat_at", "job", ["heartbeat_at"], **_where("state = 'running'"))
    op.create_index(
        "uq_job_pending",
        "job",
        ["collection_id", "kind"],
        unique=True,
        **_where("state = 'pending' AND kind IN ('preprocess', 'train', 'evaluate', 'refine')"),
    )
    op.create_table(
        "training_tally",
        sa.Column("collection_id", sa.Integer, nullable=False),
        sa.Column("n_confirmed", sa.Integer, nullable=False),
        sa.ForeignKeyConstraint(["collection_id"], ["collection.id"], name="fk_training_tally_collection_id"),
        sa.PrimaryKeyConstraint("collection_id", name="pk_training_tally"),
    )
    op.create_table(
        "event",
        sa.Column("id", sa.Integer),
        sa.Column("at", _TIME, nullable=False),
        sa.Column("collection_id", sa.Integer),
        sa.Column("kind", sa.String(16), nullable=False),
        sa.Column("payload", sa.JSON, nullable=False),
        sa.ForeignKeyConstraint(["collection_id"], ["collection.id"], name="fk_event_collection_id"),
        sa.PrimaryKeyConstraint("id", name="pk_event"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_event_at", "event", ["at"])


def _tokens() -> None:
    op.create_table(
        "token",
        sa.Column("id", sa.Integer),
        sa.Column("person_id", sa.Integer, nullable=False),
        sa.Column("role", sa.String(16), nullable=False),
        sa.Column("scope", sa.JSON),
        sa.Column("note", sa.Text, nullable=False),
        sa.Column("secret_sha256", sa.String(64), nullable=False),
        sa.Column("is_session", sa.Boolean, nullable=False),
        sa.Column("parent_id", sa.Integer),
        sa.Column("created_at", _TIME, nullable=False),
        sa.Column("expires_at", _TIME, nullable=False),
        sa.Column("revoked_at", _TIME),
        sa.Column("last_used_at", _TIME),
        sa.CheckConstraint("role IN ('annotator', 'reviewer', 'operator', 'admin')", name="ck_token_role"),
        sa.ForeignKeyConstraint(["parent_id"], ["token.id"], name="fk_token_parent_id"),
        sa.ForeignKeyConstraint(["person_id"], ["person.id"], name="fk_token_person_id"),
        sa.PrimaryKeyConstraint("id", name="pk_token"),
        sa.UniqueConstraint("secret_sha256", name="uq_token_secret_sha256"),
    )
    op.create_index("ix_token_parent_id", "token", ["parent_id"])
    op.create_index("ix_token_person_id", "token", ["person_id"])
    op.create_table(
        "login_code",
        sa.Column("id", sa.Integer),
        sa.Column("token_id", sa.Integer, nullable=False),
        sa.Column("code_sha256", sa.String(64), nullable=False),
        sa.Column("created_at", _TIME, nullable=False),
        sa.Column("expires_at", _TIME, nullable=False),
        sa.Column("used_at", _TIME),
        sa.ForeignKeyConstraint(["token_id"], ["token.id"], name="fk_login_code_token_id"),
        sa.PrimaryKeyConstraint("id", name="pk_login_code"),
        sa.UniqueConstraint("code_sha256", name="uq_login_code_code_sha256"),
    )
    op.create_index("ix_login_code_token_id", "login_code", ["token_id"])


def _where(condition: str) -> dict[str, Any]:
    """A partial index's condition, for both databases."""
    return {"sqlite_where": sa.text(condition), "postgresql_where": sa.text(condition)}


def _refuse_changes(table: str) -> None:
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


def _fill_queue() -> None:
    is_current = {"sqlite": "stage_run.is_superseded = 0", "postgresql": "NOT stage_run.is_superseded"}
    fill = sa.text(
        "INSERT INTO queue_rank (shape_id, slot, collection_id, rank, round, n_slots, opened_at) "  # noqa: S608 # no input in it
        "SELECT shape.id, 0, shape.collection_id, 1000000000 + shape.id, 1, 1, :now FROM shape "
        "WHERE EXISTS (SELECT 1 FROM stage_run WHERE stage_run.shape_id = shape.id AND stage_run.stage = 'describe' "
        f"AND stage_run.status = 'done' AND {is_current[op.get_context().dialect.name]}) "
        "AND NOT EXISTS (SELECT 1 FROM label_revision WHERE label_revision.shape_id = shape.id "
        "AND label_revision.kind IN ('human', 'imported'))"
    )
    op.get_bind().execute(fill.bindparams(sa.bindparam("now", type_=_TIME)), {"now": datetime.now(UTC)})


def _fill_honeypots() -> None:
    op.execute(
        "INSERT INTO honeypot (collection_id, shape_id, revision_id) "
        "SELECT shape.collection_id, shape.id, MAX(label_revision.id) FROM label_revision "
        "JOIN shape ON shape.id = label_revision.shape_id WHERE label_revision.kind = 'reference' "
        "GROUP BY shape.collection_id, shape.id"
    )
