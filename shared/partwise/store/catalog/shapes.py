"""Shapes and their meshes."""

from collections.abc import Collection as SizedIterable
from collections.abc import Mapping, Sequence
from typing import Protocol

from partwise.store.records import IngestedShape, Mesh, NewShape, Shape, ShapeState


class ShapeCatalog(Protocol):
    """Shapes and their meshes."""

    def add_shapes(self, collection_id: int, batch: Sequence[NewShape]) -> Sequence[IngestedShape]:
        """Add what is new and report on each source in order; safe to repeat. See `IngestOutcome`."""
        ...

    def shape(self, shape_id: int) -> Shape: ...

    def shapes_by_id(self, shape_ids: SizedIterable[int]) -> Mapping[int, Shape]:
        """The shapes of these ids; unknown ids are left out."""
        ...

    def shape_by_key(self, collection_id: int, source_key: str) -> Shape: ...

    def shapes(
        self, collection_id: int, *, after: int = 0, limit: int = 1000, state: ShapeState | None = None
    ) -> Sequence[Shape]:
        """A page of shapes by id, of one state if given."""
        ...

    def shape_states(self, shape_ids: SizedIterable[int]) -> Mapping[int, ShapeState]:
        """The state of each shape; unknown ids are left out."""
        ...

    def state_counts(self, collection_id: int) -> Mapping[ShapeState, int]:
        """How many shapes of the collection are in each state; every state is a key."""
        ...

    def mesh(self, shape_id: int, mesh_hash: str) -> Mesh: ...

    def meshes(self, shape_ids: SizedIterable[int]) -> Mapping[int, Mesh]:
        """The present working mesh of each shape; shapes without one are left out."""
        ...

    def original_meshes(self, shape_ids: SizedIterable[int]) -> Mapping[int, Mesh]:
        """The mesh of each shape's file as it is; shapes of which none is on record are left out."""
        ...

    def keep_mesh(self, mesh_hash: str, kept_key: str) -> None:
        """Record that the bytes of a mesh are also kept under `kept_key`, because labels depend on them."""
        ...
