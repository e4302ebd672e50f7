"""Orders that are walked along in one index, whatever is filtered: facets beside scores, names beside facets."""

import sqlalchemy as sa
from alembic import op

revision = "0006"
down_revision = "0005"
branch_labels = None
depends_on = None

_FACETS = ("state", "author_id", "cluster", "failed_stage")
_OWN_INDEXES = {"state": "state", "author": "author_id", "cluster": "cluster", "failure": "failed_stage"}


def upgrade() -> None:
    """Make the columns, fill them, and replace the orders' indexes by such as hold the facets."""
    _names_of_facets()
    _facets_of_scores()


def _names_of_facets() -> None:
    op.add_column("shape_facet", sa.Column("source_key", sa.Text, nullable=False, server_default=""))
    op.execute(
        "UPDATE shape_facet SET source_key = (SELECT shape.source_key FROM shape WHERE shape.id = shape_facet.shape_id)"
    )
    for columns in ("shape_id", "state_shape_id", "author_id_shape_id", "failed_stage_shape_id", "cluster_shape_id"):
        op.drop_index(f"ix_shape_facet_collection_id_{columns}", "shape_facet")
    op.create_index("ix_shape_facet_by_id", "shape_facet", ["collection_id", "shape_id", *_FACETS])
    op.create_index("ix_shape_facet_by_name", "shape_facet", ["collection_id", "source_key", "shape_id", *_FACETS])
    for name, facet in _OWN_INDEXES.items():
        others = (other for other in _FACETS if other != facet)
        op.create_index(f"ix_shape_facet_by_{name}", "shape_facet", ["collection_id", facet, "shape_id", *others])


def _facets_of_scores() -> None:
    op.add_column("score", sa.Column("state", sa.String(16)))
    op.add_column("score", sa.Column("author_id", sa.Integer))
    op.add_column("score", sa.Column("cluster", sa.Integer))
    op.add_column("score", sa.Column("failed_stage", sa.String(64)))
    copied = ", ".join(_FACETS)
    op.execute(
        f"UPDATE score SET ({copied}) = "  # noqa: S608 # no input in it
        f"(SELECT {copied} FROM shape_facet WHERE shape_facet.shape_id = score.shape_id)"
    )
    op.drop_index("ix_score_collection_id_name_value_shape_id", "score")
    op.create_index("ix_score_by_value", "score", ["collection_id", "name", "value", "shape_id", *_FACETS])
    _index_scores("state", ["state"], ["author_id", "cluster"])
    _index_scores("cluster", ["cluster"], ["state", "author_id"])
    for name, facet in (("author", "author_id"), ("failure", "failed_stage")):
        has_one = sa.text(f"{facet} IS NOT NULL")
        _index_scores(name, [facet], ["state", "cluster"], has_one)


def _index_scores(name: str, facet: list[str], others: list[str], where: sa.TextClause | None = None) -> None:
    columns = ["collection_id", "name", *facet, "value", "shape_id", *others]
    op.create_index(f"ix_score_by_{name}", "score", columns, sqlite_where=where, postgresql_where=where)
