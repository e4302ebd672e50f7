"""The table of shapes."""

from collections.abc import Collection as SizedIterable
from collections.abc import Mapping, Sequence
from typing import Protocol

from partwise.store.records import ListAnchor, ListedShape, Ordering, ShapeFilter, ShapeOrder, ShapeTile


class ListingCatalog(Protocol):
    """Shapes for people to look through, filtered and in order."""

    def list_shapes(
        self,
        collection_id: int,
        *,
        where: ShapeFilter | None = None,
        order: ShapeOrder | None = None,
        after: ListAnchor | None = None,
        limit: int = 100,
    ) -> Sequence[ListedShape]:
        """A page of shapes that meet the filter, in order; after the last row of the page before."""
        ...

    def shapes_from_rank(
        self,
        collection_id: int,
        first_rank: int,
        *,
        where: ShapeFilter | None = None,
        order: ShapeOrder | None = None,
        limit: int = 100,
    ) -> Sequence[ListedShape]:
        """As `list_shapes`, from the shape with this rank on, counted from 0, as they are now.

        Costs a walk over an index up to there; for deep jumps in a large collection there is `ordered_shapes`.
        """
        ...

    def count_shapes(
        self, collection_id: int, *, where: ShapeFilter | None = None, order: ShapeOrder | None = None
    ) -> int:
        """How many shapes `list_shapes` has on all its pages together."""
        ...

    def score_names(self, collection_id: int) -> Sequence[str]:
        """The scores that any shape of the collection has, by name."""
        ...

    def shape_tiles(self, shape_ids: Sequence[int]) -> Mapping[int, ShapeTile]:
        """What it takes to draw these shapes; unknown ids are left out."""
        ...

    def listed_shapes(self, shape_ids: Sequence[int], score_name: str | None = None) -> Mapping[int, ListedShape]:
        """These shapes' rows of the table; unknown ids are left out."""
        ...

    def set_clusters(self, collection_id: int, clusters: Mapping[int, int]) -> None:
        """Record the embedding's cluster of shapes. Shapes of other collections are left as they are."""
        ...

    def clusters(self, shape_ids: SizedIterable[int]) -> Mapping[int, int]:
        """The cluster of each shape; shapes without one are left out."""
        ...

    def cluster_sizes(self, collection_id: int) -> Mapping[int, int]:
        """How many shapes are in each cluster."""
        ...

    def begin_ordering(self, collection_id: int, score_name: str | None = None) -> Ordering:
        """An ordering without shapes, seen by nobody until it is complete. `score_name` as in `ShapeOrder`."""
        ...

    def extend_ordering(self, ordering_id: int, *, limit: int = 5_000) -> int:
        """Rank the next shapes; how many there were: 0 completes it, and it takes the place of the one before."""
        ...

    def ordering(self, collection_id: int, score_name: str | None = None) -> Ordering | None:
        """The newest complete ordering."""
        ...

    def ordered_shapes(
        self, ordering_id: int, first_rank: int, limit: int = 100, *, descending: bool = False
    ) -> Sequence[int]:
        """Ids of shapes from a rank on: a jump costs the same wherever it goes."""
        ...

    def prune_orderings(self, *, limit: int = 10_000) -> int:
        """Forget rows of orderings that newer ones have replaced, at most `limit`; how many."""
        ...
