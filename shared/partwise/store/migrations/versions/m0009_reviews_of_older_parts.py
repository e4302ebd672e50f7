"""Reviews of labels that were made under other parts than the present ones, which nothing opened before."""

from datetime import UTC, datetime

import sqlalchemy as sa
from alembic import op

revision = "0009"
down_revision = "0008"
branch_labels = None
depends_on = None

_REVIEW = sa.table(
    "review",
    sa.column("collection_id", sa.Integer),
    sa.column("shape_id", sa.Integer),
    sa.column("revision_id", sa.Integer),
    sa.column("reason", sa.String),
    sa.column("detail", sa.JSON),
    sa.column("created_at", sa.DateTime(timezone=True)),
)
_OUTDATED = """
SELECT shape.collection_id, shape.id AS shape_id, head.id AS revision_id, collection.schema_version AS version
FROM label_revision AS head
JOIN shape ON shape.id = head.shape_id
JOIN collection ON collection.id = shape.collection_id
WHERE head.schema_version < collection.schema_version
AND head.id = (
    SELECT max(newest.id) FROM label_revision AS newest
    WHERE newest.shape_id = head.shape_id AND newest.kind IN ('human', 'imported')
)
AND NOT EXISTS (
    SELECT 1 FROM review WHERE review.shape_id = head.shape_id AND review.reason = 'schema' AND resolved_at IS NULL
)
"""
_IN_REVIEW = """
UPDATE shape_facet SET state = 'review'
WHERE shape_id IN (SELECT review.shape_id FROM review WHERE review.reason = 'schema' AND resolved_at IS NULL)
"""
_COPIED = """
UPDATE score SET state = 'review'
WHERE shape_id IN (SELECT review.shape_id FROM review WHERE review.reason = 'schema' AND resolved_at IS NULL)
"""


def upgrade() -> None:
    """Open them, and have the table of shapes and the orders follow."""
    now = datetime.now(UTC)
    found = op.get_bind().execute(sa.text(_OUTDATED)).all()
    rows = [
        {
            "collection_id": row.collection_id,
            "shape_id": row.shape_id,
            "revision_id": row.revision_id,
            "reason": "schema",
            "detail": {"version": row.version},
            "created_at": now,
        }
        for row in found
    ]
    op.bulk_insert(_REVIEW, rows)
    op.execute(_IN_REVIEW)
    op.execute(_COPIED)
