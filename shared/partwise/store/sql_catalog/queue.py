"""Who works on what."""

from collections.abc import Collection as SizedIterable
from collections.abc import Mapping, Sequence

from partwise.store import records as r
from partwise.store.engine import reading, writing
from partwise.store.sql import leases, places, queue, skips, told
from partwise.store.sql.collections import schema_version
from partwise.store.sql_catalog.base import SqlBase


class SqlQueueCatalog(SqlBase):
    def claim_next(self, claim: r.NewClaim) -> r.Lease | None:
        with writing(self._engine) as connection:
            return queue.claim_next(connection, claim, self._clock())

    def claim_shape(self, shape_id: int, person_id: int, lease_s: float) -> r.Lease:
        with writing(self._engine) as connection:
            return queue.claim_shape(connection, shape_id, person_id, lease_s, self._clock())

    def lease(self, lease_id: int) -> r.Lease:
        with reading(self._engine) as connection:
            return leases.lease(connection, lease_id)

    def leases_of(self, person_id: int) -> Sequence[r.Lease]:
        with reading(self._engine) as connection:
            return leases.leases_of(connection, person_id)

    def leased_by(self, person_id: int) -> Sequence[r.LeasedShape]:
        with reading(self._engine) as connection:
            return leases.leased_by(connection, person_id)

    def leased_shapes(self, lease_ids: SizedIterable[int]) -> Mapping[int, r.LeasedShape]:
        with reading(self._engine) as connection:
            return leases.leased_shapes(connection, lease_ids)

    def active_leases(self, collection_id: int, *, after: int = 0, limit: int = 1000) -> Sequence[r.Lease]:
        with reading(self._engine) as connection:
            return leases.active_leases(connection, collection_id, after, limit)

    def skips(self, collection_id: int, *, before: int | None = None, limit: int = 1000) -> Sequence[r.SkippedShape]:
        with reading(self._engine) as connection:
            return skips.skips(connection, collection_id, before, limit)

    def held_shapes(self, shape_ids: SizedIterable[int]) -> Mapping[int, Sequence[r.Lease]]:
        with reading(self._engine) as connection:
            return leases.held_shapes(connection, shape_ids)

    def renew_lease(
        self, lease_id: int, person_id: int, lease_s: float, *, is_prefetched: bool | None = None
    ) -> r.Lease:
        with writing(self._engine) as connection:
            return leases.renew(connection, lease_id, person_id, lease_s, is_prefetched, self._clock())

    def release_lease(self, lease_id: int, person_id: int) -> r.Lease:
        with writing(self._engine) as connection:
            return leases.release(connection, lease_id, person_id, self._clock())

    def skip_lease(self, lease_id: int, person_id: int, reason: str) -> r.Lease:
        with writing(self._engine) as connection:
            return leases.skip(connection, lease_id, person_id, reason, self._clock())

    def clear_lease(self, lease_id: int, operator_id: int) -> r.Lease:
        with writing(self._engine) as connection:
            return leases.clear(connection, lease_id, operator_id, self._clock())

    def reopen_shape(self, shape_id: int, operator_id: int, *, for_person_id: int | None = None) -> None:
        with writing(self._engine) as connection:
            places.reopen(connection, shape_id, operator_id, for_person_id, self._clock())

    def assign_shapes(self, shape_ids: Sequence[int], person_id: int | None, operator_id: int) -> int:
        with writing(self._engine) as connection:
            return places.assign(connection, shape_ids, person_id, operator_id, self._clock())

    def set_ranks(self, collection_id: int, ranks: Mapping[int, int]) -> int:
        with writing(self._engine) as connection:
            return places.set_ranks(connection, collection_id, ranks)

    def record_ranking(self, collection_id: int, score_name: str) -> None:
        with writing(self._engine) as connection:
            schema_version(connection, collection_id)
            told.record_ranking(connection, collection_id, score_name, self._clock())

    def ranking_score(self, collection_id: int) -> str:
        with reading(self._engine) as connection:
            schema_version(connection, collection_id)
            return told.ranking_score(connection, collection_id)

    def fill_queue(self, collection_id: int, *, after: int = 0, limit: int = 1000) -> int | None:
        with writing(self._engine) as connection:
            return places.fill(connection, collection_id, after, limit, self._clock())

    def queue_depth(self, collection_id: int) -> r.QueueDepth:
        with reading(self._engine) as connection:
            return places.queue_depth(connection, collection_id, self._clock())
