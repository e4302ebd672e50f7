"""The table of shapes: what it is filtered by, kept beside what it follows from, and orders that can be jumped into."""

import sqlalchemy as sa
from alembic import op

revision = "0004"
down_revision = "0003"
branch_labels = None
depends_on = None

_TIME = sa.DateTime(timezone=True)


def upgrade() -> None:
    """Make the tables and fill them from what is there."""
    _listing()
    _fill_facets()
    _fill_head_parts()


def _listing() -> None:
    op.create_table(
        "shape_facet",
        sa.Column("shape_id", sa.Integer, autoincrement=False, nullable=False),
        sa.Column("collection_id", sa.Integer, nullable=False),
        sa.Column("state", sa.String(16), nullable=False),
        sa.Column("author_id", sa.Integer),
        sa.Column("failed_stage", sa.String(64)),
        sa.Column("cluster", sa.Integer),
        sa.ForeignKeyConstraint(["author_id"], ["person.id"], name="fk_shape_facet_author_id"),
        sa.ForeignKeyConstraint(["collection_id"], ["collection.id"], name="fk_shape_facet_collection_id"),
        sa.ForeignKeyConstraint(["shape_id"], ["shape.id"], name="fk_shape_facet_shape_id"),
        sa.PrimaryKeyConstraint("shape_id", name="pk_shape_facet"),
    )
    op.create_index(
        "ix_shape_facet_collection_id_author_id_shape_id", "shape_facet", ["collection_id", "author_id", "shape_id"]
    )
    op.create_index(
        "ix_shape_facet_collection_id_cluster_shape_id", "shape_facet", ["collection_id", "cluster", "shape_id"]
    )
    op.create_index(
        "ix_shape_facet_collection_id_failed_stage_shape_id",
        "shape_facet",
        ["collection_id", "failed_stage", "shape_id"],
    )
    op.create_index("ix_shape_facet_collection_id_shape_id", "shape_facet", ["collection_id", "shape_id"])
    op.create_index(
        "ix_shape_facet_collection_id_state_shape_id", "shape_facet", ["collection_id", "state", "shape_id"]
    )
    op.create_table(
        "head_part",
        sa.Column("collection_id", sa.Integer, nullable=False),
        sa.Column("part_id", sa.Integer, autoincrement=False, nullable=False),
        sa.Column("shape_id", sa.Integer, nullable=False),
        sa.ForeignKeyConstraint(["collection_id"], ["collection.id"], name="fk_head_part_collection_id"),
        sa.ForeignKeyConstraint(["shape_id"], ["shape.id"], name="fk_head_part_shape_id"),
        sa.PrimaryKeyConstraint("collection_id", "part_id", "shape_id", name="pk_head_part"),
    )
    op.create_index("ix_head_part_shape_id", "head_part", ["shape_id"])
    op.create_table(
        "ordering",
        sa.Column("id", sa.Integer),
        sa.Column("collection_id", sa.Integer, nullable=False),
        sa.Column("score_name", sa.String(64)),
        sa.Column("n_shapes", sa.Integer, nullable=False),
        sa.Column("built_at", _TIME, nullable=False),
        sa.Column("is_complete", sa.Boolean, nullable=False),
        sa.Column("last_id", sa.Integer),
        sa.Column("last_value", sa.Double),
        sa.ForeignKeyConstraint(["collection_id"], ["collection.id"], name="fk_ordering_collection_id"),
        sa.PrimaryKeyConstraint("id", name="pk_ordering"),
        sqlite_autoincrement=True,
    )
    op.create_index("ix_ordering_collection_id_score_name_id", "ordering", ["collection_id", "score_name", "id"])
    op.create_table(
        "ordering_row",
        sa.Column("ordering_id", sa.Integer, nullable=False),
        sa.Column("rank", sa.Integer, autoincrement=False, nullable=False),
        sa.Column("shape_id", sa.Integer, nullable=False),
        sa.ForeignKeyConstraint(["ordering_id"], ["ordering.id"], name="fk_ordering_row_ordering_id"),
        sa.ForeignKeyConstraint(["shape_id"], ["shape.id"], name="fk_ordering_row_shape_id"),
        sa.PrimaryKeyConstraint("ordering_id", "rank", name="pk_ordering_row"),
    )


def _fill_facets() -> None:
    is_current = {"sqlite": "stage_run.is_superseded = 0", "postgresql": "NOT stage_run.is_superseded"}
    head = (
        "SELECT {column} FROM label_revision WHERE label_revision.shape_id = shape.id "
        "AND label_revision.kind IN ('human', 'imported') ORDER BY label_revision.id DESC LIMIT 1"
    )
    failed = (
        "SELECT stage FROM stage_run WHERE stage_run.shape_id = shape.id AND stage_run.status = 'failed' "
        "ORDER BY stage_run.id DESC LIMIT 1"
    )
    op.execute(
        "INSERT INTO shape_facet (shape_id, collection_id, state, author_id, failed_stage) "  # noqa: S608 # no input in it
        "SELECT shape.id, shape.collection_id, CASE "
        "WHEN EXISTS (SELECT 1 FROM review WHERE review.shape_id = shape.id AND resolved_at IS NULL) THEN 'review' "
        f"WHEN EXISTS ({head.format(column='1')}) THEN 'confirmed' "
        "WHEN EXISTS (SELECT 1 FROM stage_run WHERE stage_run.shape_id = shape.id AND stage_run.stage = 'describe' "
        f"AND stage_run.status = 'done' AND {is_current[op.get_context().dialect.name]}) THEN 'ready' "
        f"WHEN EXISTS ({failed}) THEN 'failed' ELSE 'new' END, "
        f"({head.format(column='author_id')}), ({failed}) FROM shape"
    )


def _fill_head_parts() -> None:
    op.execute(
        "INSERT INTO head_part (collection_id, part_id, shape_id) "
        "SELECT label_part.collection_id, label_part.part_id, label_revision.shape_id FROM label_part "
        "JOIN label_revision ON label_revision.id = label_part.revision_id "
        "WHERE label_revision.id IN (SELECT MAX(newest.id) FROM label_revision AS newest "
        "WHERE newest.kind IN ('human', 'imported') GROUP BY newest.shape_id)"
    )
