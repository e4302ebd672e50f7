"""Stage runs and blocks."""

from collections.abc import Collection as SizedIterable
from collections.abc import Mapping, Sequence
from datetime import datetime

from partwise.store import records as r
from partwise.store.engine import reading, writing
from partwise.store.sql import blocks, figures, stages
from partwise.store.sql_catalog.base import SqlBase


class SqlStageCatalog(SqlBase):
    def publish_block(
        self,
        block: r.NewBlock,
        runs: Sequence[r.NewStageRun],
        scores: Sequence[r.NewScore] = (),
        meshes: Sequence[r.NewMesh] = (),
    ) -> int:
        with writing(self._engine) as connection:
            return stages.publish_block(connection, block, runs, scores, meshes, self._clock())

    def record_done(self, runs: Sequence[r.NewStageRun], scores: Sequence[r.NewScore] = ()) -> None:
        with writing(self._engine) as connection:
            stages.record_done(connection, runs, scores, self._clock())

    def record_failure(self, failure: r.NewFailure) -> None:
        with writing(self._engine) as connection:
            stages.record_failure(connection, failure, self._clock())

    def clear_failures(
        self,
        collection_id: int,
        stage: str | None = None,
        shape_ids: SizedIterable[int] | None = None,
        *,
        kind: r.FailureKind | None = None,
        reason_contains: str = "",
    ) -> int:
        with writing(self._engine) as connection:
            return stages.clear_failures(
                connection, collection_id, stage, shape_ids, kind, reason_contains, self._clock()
            )

    def stage_runs(self, shape_ids: SizedIterable[int], stage: str) -> Mapping[int, r.StageRun]:
        with reading(self._engine) as connection:
            return stages.stage_runs(connection, shape_ids, stage)

    def failed_runs(self, shape_ids: SizedIterable[int], stage: str) -> Mapping[int, r.StageRun]:
        with reading(self._engine) as connection:
            return stages.failed_runs(connection, shape_ids, stage)

    def failures(
        self,
        collection_id: int,
        *,
        stage: str | None = None,
        kind: r.FailureKind | None = None,
        after: int = 0,
        limit: int = 1000,
    ) -> Sequence[r.Failure]:
        with reading(self._engine) as connection:
            return stages.failures(connection, collection_id, stage, kind, after, limit)

    def stage_counts(self, collection_id: int) -> Sequence[r.StageCount]:
        with reading(self._engine) as connection:
            return stages.stage_counts(connection, collection_id)

    def stage_paces(self, collection_id: int, since: datetime) -> Mapping[str, int]:
        with reading(self._engine) as connection:
            return figures.stage_paces(connection, collection_id, since)

    def failure_kinds(self, collection_id: int) -> Mapping[r.FailureKind, int]:
        with reading(self._engine) as connection:
            return figures.failure_kinds(connection, collection_id)

    def block(self, name: str) -> r.Block:
        with reading(self._engine) as connection:
            return blocks.block(connection, name)

    def visible_blocks(self, *, after: int = 0, limit: int = 1000) -> Sequence[r.Block]:
        with reading(self._engine) as connection:
            return blocks.visible_blocks(connection, after, limit)

    def unused_blocks(self, *, limit: int = 1000) -> Sequence[r.Block]:
        with reading(self._engine) as connection:
            return blocks.unused_blocks(connection, limit)

    def supersede_block(self, name: str) -> int:
        with writing(self._engine) as connection:
            return blocks.supersede_block(connection, name, self._clock())

    def delete_blocks(self, names: SizedIterable[str]) -> None:
        with writing(self._engine) as connection:
            blocks.delete_blocks(connection, names)
