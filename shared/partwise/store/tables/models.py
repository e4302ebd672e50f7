"""Models, scores, the selection, the embedding."""

from sqlalchemy import JSON, Column, Double, ForeignKey, Index, Integer, String, Table, Text, UniqueConstraint, text

from partwise.store.tables.base import UtcDateTime, metadata
from partwise.store.tables.listing import FACETS, shape_facet

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
    # its shape's facets stand beside it, so that an order by score is walked along without a look at any shape
    "score",
    metadata,
    Column("shape_id", ForeignKey("shape.id"), primary_key=True),
    Column("name", String(64), primary_key=True),
    Column("model_id", ForeignKey("model.id"), nullable=False),
    Column("value", Double, nullable=False),
    Column("scored_at", UtcDateTime, nullable=False),
    Column("collection_id", ForeignKey("collection.id"), nullable=False),
    *(Column(facet.name, facet.type) for facet in (shape_facet.c[name] for name in FACETS)),
    Index("ix_score_by_value", "collection_id", "name", "value", "shape_id", *FACETS),
    Index(None, "collection_id", "name", "model_id"),
)

_OF_NAME = (score.c.collection_id, score.c.name)
_PLACE = (score.c.value, score.c.shape_id)
Index("ix_score_by_state", *_OF_NAME, score.c.state, *_PLACE, score.c.author_id, score.c.cluster)
Index("ix_score_by_cluster", *_OF_NAME, score.c.cluster, *_PLACE, score.c.state, score.c.author_id)
for _name, _facet in (("author", score.c.author_id), ("failure", score.c.failed_stage)):  # of the few that have one
    _has_one = text(f"{_facet.name} IS NOT NULL")
    _of_facet = (*_OF_NAME, _facet, *_PLACE, score.c.state, score.c.cluster)
    Index(f"ix_score_by_{_name}", *_of_facet, sqlite_where=_has_one, postgresql_where=_has_one)

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
