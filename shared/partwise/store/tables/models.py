"""Models, scores, the selection, the embedding."""

from sqlalchemy import JSON, Column, Double, ForeignKey, Index, Integer, String, Table, Text, UniqueConstraint

from partwise.store.tables.base import UtcDateTime, metadata

model = Table(
    "model",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("collection_id", ForeignKey("collection.id"), nullable=False),
    Column("version", Integer, nullable=False),
    Column("recipe", JSON, nullable=False),
    Column("weights_key", Text, nullable=False),
    Column("revision_ids", JSON, nullable=False),
    Column("n_shapes", Integer, nullable=False),
    Column("trained_at", UtcDateTime, nullable=False),
    UniqueConstraint("collection_id", "version"),
)

score = Table(  # the latest of each name only: history of every shape under every model would outgrow the rest
    "score",
    metadata,
    Column("shape_id", ForeignKey("shape.id"), primary_key=True),
    Column("name", String(64), primary_key=True),
    Column("model_id", ForeignKey("model.id"), nullable=False),
    Column("value", Double, nullable=False),
    Column("scored_at", UtcDateTime, nullable=False),
    Column("collection_id", ForeignKey("collection.id"), nullable=False),
    Index(None, "collection_id", "name", "value", "shape_id"),
    Index(None, "collection_id", "name", "model_id"),
)

score_tally = Table(  # how the scores were that a model gave, which newer models' take the place of
    "score_tally",
    metadata,
    Column("model_id", ForeignKey("model.id"), primary_key=True),
    Column("name", String(64), primary_key=True),
    Column("n_scores", Integer, nullable=False),
    Column("total", Double, nullable=False),
)

ranking = Table(  # what a collection's queue was ranked by last
    "ranking",
    metadata,
    Column("collection_id", ForeignKey("collection.id"), primary_key=True),
    Column("score_name", String(64), nullable=False),
    Column("ranked_at", UtcDateTime, nullable=False),
)

first_shape = Table(
    "first_shape",
    metadata,
    Column("collection_id", ForeignKey("collection.id"), primary_key=True),
    Column("ordinal", Integer, primary_key=True, autoincrement=False),
    Column("shape_id", ForeignKey("shape.id"), nullable=False),
    Column("cluster", Integer, nullable=False),
)

embedding = Table(
    "embedding",
    metadata,
    Column("collection_id", ForeignKey("collection.id"), primary_key=True),
    Column("key", Text, nullable=False),
    Column("created_at", UtcDateTime, nullable=False),
)
