"""Names beside scores, so that every order is searched by name along one index; what workers take of their machines."""

import sqlalchemy as sa
from alembic import op

revision = "0007"
down_revision = "0006"
branch_labels = None
depends_on = None

_FACETS = ("state", "author_id", "cluster", "failed_stage", "source_key")


def upgrade() -> None:
    """Make the columns and tables, fill them, and replace the indexes of the orders by id and by score."""
    _names_of_scores()
    _workers()


def _names_of_scores() -> None:
    op.add_column("score", sa.Column("source_key", sa.Text))
    op.execute("UPDATE score SET source_key = (SELECT shape.source_key FROM shape WHERE shape.id = score.shape_id)")
    op.drop_index("ix_shape_facet_by_id", "shape_facet")
    op.create_index("ix_shape_facet_by_id", "shape_facet", ["collection_id", "shape_id", *_FACETS])
    op.drop_index("ix_score_by_value", "score")
    op.create_index("ix_score_by_value", "score", ["collection_id", "name", "value", "shape_id", *_FACETS])


def _workers() -> None:
    op.create_table(
        "worker",
        sa.Column("owner", sa.String(200), nullable=False),
        sa.Column("memory_bytes", sa.BigInteger, nullable=False),
        sa.Column("n_actors", sa.Integer, nullable=False),
        sa.Column("actor_bytes", sa.BigInteger, nullable=False),
        sa.Column("free_bytes", sa.BigInteger),
        sa.Column("seen_at", sa.DateTime(timezone=True), nullable=False),
        sa.PrimaryKeyConstraint("owner", name="pk_worker"),
    )
