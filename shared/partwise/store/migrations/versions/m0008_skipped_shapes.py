"""An index of the leases that were skipped: reasons are read without looking at all that were ever handed out."""

import sqlalchemy as sa
from alembic import op

revision = "0008"
down_revision = "0007"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Make the index."""
    is_skipped = sa.text("outcome = 'skipped'")
    op.create_index(
        "ix_lease_skipped", "lease", ["collection_id", "id"], sqlite_where=is_skipped, postgresql_where=is_skipped
    )
