"""What the table of shapes is filtered and ordered by, kept up to date beside the rows that it follows from."""

from sqlalchemy import Boolean, Column, Double, ForeignKey, Index, Integer, String, Table, Text

from partwise.store.tables.base import UtcDateTime, metadata

FACETS = ("state", "author_id", "cluster", "failed_stage", "source_key")
"""Columns that shapes are filtered by. An index for each order has all of them: who walks along the order, past
however many shapes that a filter leaves out, reads that index and nothing else.
"""

shape_facet = Table(  # a copy of what `sql.state` derives, renewed in the transaction of whatever changes it
    "shape_facet",
    metadata,
    Column("shape_id", ForeignKey("shape.id"), primary_key=True, autoincrement=False),
    Column("collection_id", ForeignKey("collection.id"), nullable=False),
    Column("state", String(16), nullable=False),
    Column("author_id", ForeignKey("person.id")),
    Column("failed_stage", String(64)),
    Column("cluster", Integer),
    Column("source_key", Text, nullable=False, server_default=""),
    Index("ix_shape_facet_by_id", "collection_id", "shape_id", *FACETS),
    Index("ix_shape_facet_by_name", "collection_id", "source_key", "shape_id", *FACETS[:-1]),
    Index("ix_shape_facet_by_state", "collection_id", "state", "shape_id", "author_id", "cluster", "failed_stage"),
    Index("ix_shape_facet_by_author", "collection_id", "author_id", "shape_id", "state", "cluster", "failed_stage"),
    Index("ix_shape_facet_by_cluster", "collection_id", "cluster", "shape_id", "state", "author_id", "failed_stage"),
    Index("ix_shape_facet_by_failure", "collection_id", "failed_stage", "shape_id", "state", "author_id", "cluster"),
)

head_part = Table(  # parts of the newest shown labels of each shape
    "head_part",
    metadata,
    Column("collection_id", ForeignKey("collection.id"), primary_key=True),
    Column("part_id", Integer, primary_key=True, autoincrement=False),
    Column("shape_id", ForeignKey("shape.id"), primary_key=True, index=True),
)

ordering = Table(
    "ordering",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("collection_id", ForeignKey("collection.id"), nullable=False),
    Column("score_name", String(64)),
    Column("n_shapes", Integer, nullable=False),
    Column("built_at", UtcDateTime, nullable=False),
    Column("is_complete", Boolean, nullable=False),
    Column("last_id", Integer),
    Column("last_value", Double),
    Index(None, "collection_id", "score_name", "id"),
    sqlite_autoincrement=True,
)

ordering_row = Table(
    "ordering_row",
    metadata,
    Column("ordering_id", ForeignKey("ordering.id"), primary_key=True),
    Column("rank", Integer, primary_key=True, autoincrement=False),
    Column("shape_id", ForeignKey("shape.id"), nullable=False),
)
