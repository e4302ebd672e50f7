"""Labels of models, accepted in bulk."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import UInt16

from partwise.store import records as r
from partwise.store.engine import reading, writing
from partwise.store.sql import accepts
from partwise.store.sql_catalog.base import SqlBase


class SqlAcceptCatalog(SqlBase):
    def begin_accept(self, collection_id: int, person_id: int, segmentation: str, agreement: float) -> int:
        with writing(self._engine) as connection:
            return accepts.begin_accept(connection, collection_id, person_id, segmentation, agreement, self._clock())

    def accept_shape(self, batch_id: int, revision: r.NewRevision) -> r.LabelRevision:
        with writing(self._engine) as connection:
            return accepts.accept_shape(connection, batch_id, revision, self._clock())

    def draw_shape(
        self, batch_id: int, shape_id: int, mesh_hash: str, schema_version: int, labels: UInt16[np.ndarray, " m"]
    ) -> r.Recheck:
        with writing(self._engine) as connection:
            return accepts.draw_shape(connection, batch_id, shape_id, mesh_hash, schema_version, labels, self._clock())

    def open_rechecks(
        self, collection_id: int, *, shape_id: int | None = None, after: int = 0, limit: int = 100
    ) -> Sequence[r.Recheck]:
        with reading(self._engine) as connection:
            return accepts.open_rechecks(connection, collection_id, shape_id, after, limit)

    def recheck_labels(self, recheck_id: int) -> UInt16[np.ndarray, " m"]:
        with reading(self._engine) as connection:
            return accepts.recheck_labels(connection, recheck_id)

    def settle_recheck(self, result: r.RecheckResult) -> bool:
        with writing(self._engine) as connection:
            return accepts.settle_recheck(connection, result, self._clock())

    def accept_batches(
        self, collection_id: int, *, before: int | None = None, limit: int = 100
    ) -> Sequence[r.AcceptBatch]:
        with reading(self._engine) as connection:
            return accepts.accept_batches(connection, collection_id, before, limit)

    def put_first(self, collection_id: int, shape_ids: Sequence[int], person_id: int) -> Sequence[int]:
        with writing(self._engine) as connection:
            return accepts.put_first(connection, collection_id, shape_ids, person_id, self._clock())
