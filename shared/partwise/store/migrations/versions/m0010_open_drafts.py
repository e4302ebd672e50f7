"""Open drafts of a person are found by the index that has no others: the one of all their drafts led past it."""

from alembic import op

revision = "0010"
down_revision = "0009"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Drop the index that nothing else is read by."""
    op.drop_index("ix_draft_person_id_id", "draft")
