"""The table of shapes."""

from collections.abc import Collection as SizedIterable
from collections.abc import Mapping, Sequence

from partwise.store import records as r
from partwise.store.engine import reading, writing
from partwise.store.sql import listing, orderings, tiles
from partwise.store.sql_catalog.base import SqlBase


class SqlListingCatalog(SqlBase):
    def list_shapes(
        self,
        collection_id: int,
        *,
        where: r.ShapeFilter | None = None,
        order: r.ShapeOrder | None = None,
        after: r.ListAnchor | None = None,
        limit: int = 100,
    ) -> Sequence[r.ListedShape]:
        with reading(self._engine) as connection:
            return listing.list_shapes(
                connection, collection_id, where or r.ShapeFilter(), order or r.ShapeOrder(), after, limit
            )

    def shapes_from_rank(
        self,
        collection_id: int,
        first_rank: int,
        *,
        where: r.ShapeFilter | None = None,
        order: r.ShapeOrder | None = None,
        limit: int = 100,
    ) -> Sequence[r.ListedShape]:
        with reading(self._engine) as connection:
            return listing.shapes_from_rank(
                connection, collection_id, where or r.ShapeFilter(), order or r.ShapeOrder(), first_rank, limit
            )

    def count_shapes(
        self, collection_id: int, *, where: r.ShapeFilter | None = None, order: r.ShapeOrder | None = None
    ) -> int:
        with reading(self._engine) as connection:
            return listing.count_shapes(connection, collection_id, where or r.ShapeFilter(), order or r.ShapeOrder())

    def score_names(self, collection_id: int) -> Sequence[str]:
        with reading(self._engine) as connection:
            return listing.score_names(connection, collection_id)

    def shape_tiles(self, shape_ids: Sequence[int]) -> Mapping[int, r.ShapeTile]:
        with reading(self._engine) as connection:
            return tiles.shape_tiles(connection, shape_ids)

    def listed_shapes(self, shape_ids: Sequence[int], score_name: str | None = None) -> Mapping[int, r.ListedShape]:
        with reading(self._engine) as connection:
            return listing.listed_shapes(connection, shape_ids, score_name)

    def set_clusters(self, collection_id: int, clusters: Mapping[int, int]) -> None:
        with writing(self._engine) as connection:
            listing.set_clusters(connection, collection_id, clusters)

    def clusters(self, shape_ids: SizedIterable[int]) -> Mapping[int, int]:
        with reading(self._engine) as connection:
            return listing.clusters(connection, shape_ids)

    def cluster_sizes(self, collection_id: int) -> Mapping[int, int]:
        with reading(self._engine) as connection:
            return listing.cluster_sizes(connection, collection_id)

    def begin_ordering(self, collection_id: int, score_name: str | None = None) -> r.Ordering:
        with writing(self._engine) as connection:
            return orderings.begin(connection, collection_id, score_name, self._clock())

    def extend_ordering(self, ordering_id: int, *, limit: int = 5000) -> int:
        with writing(self._engine) as connection:
            return orderings.extend(connection, ordering_id, limit)

    def ordering(self, collection_id: int, score_name: str | None = None) -> r.Ordering | None:
        with reading(self._engine) as connection:
            return orderings.ordering(connection, collection_id, score_name)

    def ordered_shapes(
        self, ordering_id: int, first_rank: int, limit: int = 100, *, descending: bool = False
    ) -> Sequence[int]:
        with reading(self._engine) as connection:
            return orderings.ordered_shapes(connection, ordering_id, first_rank, limit, descending=descending)

    def prune_orderings(self, *, limit: int = 10000) -> int:
        with writing(self._engine) as connection:
            return orderings.prune(connection, limit)
