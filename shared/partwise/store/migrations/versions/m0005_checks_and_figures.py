"""What a lease tells, what a draft cost, what was accepted in bulk and checked again, how a model's scores were."""

from typing import Any

import sqlalchemy as sa
from alembic import op

revision = "0005"
down_revision = "0004"
branch_labels = None
depends_on = None

_TIME = sa.DateTime(timezone=True)


def upgrade() -> None:
    """Make the columns and tables, and fill the tally of scores from those on record."""
    _leases_and_drafts()
    _rankings()
    _accepts()
    op.execute(
        "INSERT INTO score_tally (model_id, name, n_scores, total) "
        "SELECT model_id, name, COUNT(*), SUM(value) FROM score GROUP BY model_id, name"
    )


def _leases_and_drafts() -> None:
    op.add_column("lease", sa.Column("rank", sa.BigInteger))
    op.add_column("lease", sa.Column("score_name", sa.String(64)))
    op.add_column("lease", sa.Column("score", sa.Double))
    op.add_column("lease", sa.Column("model_version", sa.Integer))
    op.add_column("draft", sa.Column("active_s", sa.Double))
    op.add_column("draft", sa.Column("n_clicks", sa.Integer))
    op.create_index("ix_draft_confirmed", "draft", ["collection_id", "closed_at"], **_where("outcome = 'confirmed'"))


def _rankings() -> None:
    op.create_table(
        "ranking",
        sa.Column("collection_id", sa.Integer, nullable=False),
        sa.Column("score_name", sa.String(64), nullable=False),
        sa.Column("ranked_at", _TIME, nullable=False),
        sa.ForeignKeyConstraint(["collection_id"], ["collection.id"], name="fk_ranking_collection_id"),
        sa.PrimaryKeyConstraint("collection_id", name="pk_ranking"),
    )
    op.create_table(
        "score_tally",
        sa.Column("model_id", sa.Integer, nullable=False),
        sa.Column("name", sa.String(64), nullable=False),
        sa.Column("n_scores", sa.Integer, nullable=False),
        sa.Column("total", sa.Double, nullable=False),
        sa.ForeignKeyConstraint(["model_id"], ["model.id"], name="fk_score_tally_model_id"),
        sa.PrimaryKeyConstraint("model_id", "name", name="pk_score_tally"),
    )
    op.create_index("ix_score_collection_id_name_model_id", "score", ["collection_id", "name", "model_id"])


def _accepts() -> None:
    op.create_table(
        "accept_batch",
        sa.Column("id", sa.Integer),
        sa.Column("collection_id", sa.Integer, nullable=False),
        sa.Column("person_id", sa.Integer, nullable=False),
        sa.Column("segmentation", sa.String(16), nullable=False),
        sa.Column("agreement", sa.Double, nullable=False),
        sa.Column("n_accepted", sa.Integer, nullable=False),
        sa.Column("accepted_at", _TIME, nullable=False),
        sa.ForeignKeyConstraint(["collection_id"], ["collection.id"], name="fk_accept_batch_collection_id"),
        sa.ForeignKeyConstraint(["person_id"], ["person.id"], name="fk_accept_batch_person_id"),
        sa.PrimaryKeyConstraint("id", name="pk_accept_batch"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_accept_batch_collection_id_id", "accept_batch", ["collection_id", "id"])
    op.create_table(
        "recheck",
        sa.Column("id", sa.Integer),
        sa.Column("batch_id", sa.Integer, nullable=False),
        sa.Column("collection_id", sa.Integer, nullable=False),
        sa.Column("shape_id", sa.Integer, nullable=False),
        sa.Column("mesh_hash", sa.String(64), nullable=False),
        sa.Column("labels", sa.LargeBinary, nullable=False),
        sa.Column("n_faces", sa.Integer, nullable=False),
        sa.Column("sha256", sa.String(64), nullable=False),
        sa.Column("revision_id", sa.Integer),
        sa.Column("area_agreement", sa.Double),
        sa.Column("part_iou", sa.Double),
        sa.Column("boundary_distance", sa.Double),
        sa.Column("is_false", sa.Boolean),
        sa.Column("checked_at", _TIME),
        sa.CheckConstraint("(checked_at IS NULL) = (revision_id IS NULL)", name="ck_recheck_checked_has_revision"),
        sa.ForeignKeyConstraint(["batch_id"], ["accept_batch.id"], name="fk_recheck_batch_id"),
        sa.ForeignKeyConstraint(["collection_id"], ["collection.id"], name="fk_recheck_collection_id"),
        sa.ForeignKeyConstraint(["revision_id"], ["label_revision.id"], name="fk_recheck_revision_id"),
        sa.ForeignKeyConstraint(["shape_id"], ["shape.id"], name="fk_recheck_shape_id"),
        sa.PrimaryKeyConstraint("id", name="pk_recheck"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_recheck_batch_id", "recheck", ["batch_id"])
    op.create_index("ix_recheck_open_collection_id", "recheck", ["collection_id", "id"], **_where("checked_at IS NULL"))
    op.create_index("uq_recheck_open", "recheck", ["shape_id"], unique=True, **_where("checked_at IS NULL"))


def _where(condition: str) -> dict[str, Any]:
    """A partial index's condition, for both databases."""
    return {"sqlite_where": sa.text(condition), "postgresql_where": sa.text(condition)}
