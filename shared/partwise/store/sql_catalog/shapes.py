"""Shapes and meshes."""

from collections.abc import Collection as SizedIterable
from collections.abc import Mapping, Sequence

from partwise.store import records as r
from partwise.store.engine import reading, writing
from partwise.store.sql import shapes
from partwise.store.sql_catalog.base import SqlBase


class SqlShapeCatalog(SqlBase):
    def add_shapes(self, collection_id: int, batch: Sequence[r.NewShape]) -> Sequence[r.IngestedShape]:
        with writing(self._engine) as connection:
            return shapes.add_shapes(connection, collection_id, batch, self._clock())

    def shape(self, shape_id: int) -> r.Shape:
        with reading(self._engine) as connection:
            return shapes.refuse_unknown_shapes(connection, [shape_id])[shape_id]

    def shapes_by_id(self, shape_ids: SizedIterable[int]) -> Mapping[int, r.Shape]:
        with reading(self._engine) as connection:
            return shapes.shapes_by_id(connection, shape_ids)

    def shape_by_key(self, collection_id: int, source_key: str) -> r.Shape:
        with reading(self._engine) as connection:
            return shapes.shape_by_key(connection, collection_id, source_key)

    def shapes(
        self, collection_id: int, *, after: int = 0, limit: int = 1000, state: r.ShapeState | None = None
    ) -> Sequence[r.Shape]:
        with reading(self._engine) as connection:
            return shapes.shapes(connection, collection_id, after, limit, state)

    def shape_states(self, shape_ids: SizedIterable[int]) -> Mapping[int, r.ShapeState]:
        with reading(self._engine) as connection:
            return shapes.shape_states(connection, shape_ids)

    def state_counts(self, collection_id: int) -> Mapping[r.ShapeState, int]:
        with reading(self._engine) as connection:
            return shapes.state_counts(connection, collection_id)

    def mesh(self, shape_id: int, mesh_hash: str) -> r.Mesh:
        with reading(self._engine) as connection:
            return shapes.mesh(connection, shape_id, mesh_hash)

    def meshes(self, shape_ids: SizedIterable[int]) -> Mapping[int, r.Mesh]:
        with reading(self._engine) as connection:
            return shapes.meshes(connection, shape_ids, r.MeshRole.WORKING)

    def original_meshes(self, shape_ids: SizedIterable[int]) -> Mapping[int, r.Mesh]:
        with reading(self._engine) as connection:
            return shapes.meshes(connection, shape_ids, r.MeshRole.ORIGINAL)

    def keep_mesh(self, mesh_hash: str, kept_key: str) -> None:
        with writing(self._engine) as connection:
            shapes.keep_mesh(connection, mesh_hash, kept_key)
