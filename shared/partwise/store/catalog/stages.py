"""Stage runs and blocks."""

from collections.abc import Collection as SizedIterable
from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import Protocol

from partwise.store.records import (
    Block,
    Failure,
    FailureKind,
    NewBlock,
    NewFailure,
    NewMesh,
    NewScore,
    NewStageRun,
    StageCount,
    StageRun,
)


class StageCatalog(Protocol):
    """What was done to each shape, and the blocks that hold the results."""

    def publish_block(
        self,
        block: NewBlock,
        runs: Sequence[NewStageRun],
        scores: Sequence[NewScore] = (),
        meshes: Sequence[NewMesh] = (),
    ) -> int:
        """Make a written block visible and return its id: block, done runs, scores and meshes in one transaction.

        Older done runs of the same shape and stage are superseded and its failed runs of that stage are cleared. A
        score replaces the shape's score of that name unless the one on record comes from a newer model.

        Raises `ConflictError` if the block's name is on record, `ParameterError` for a row outside the block or a score
        that is not finite.
        """
        ...

    def record_done(self, runs: Sequence[NewStageRun], scores: Sequence[NewScore] = ()) -> None:
        """As `publish_block`, for stages that have no arrays."""
        ...

    def record_failure(self, failure: NewFailure) -> None:
        """Quarantine a shape at a stage, with the reason. Never displaces a current done run."""
        ...

    def clear_failures(
        self,
        collection_id: int,
        stage: str | None = None,
        shape_ids: SizedIterable[int] | None = None,
        *,
        kind: FailureKind | None = None,
        reason_contains: str = "",
    ) -> int:
        """Forget failed runs so that they are tried again, those that meet all that is given; returns how many.

        kind : what the failure's detail says. reason_contains : any text, in either case of its letters.
        """
        ...

    def stage_runs(self, shape_ids: SizedIterable[int], stage: str) -> Mapping[int, StageRun]:
        """The current done run of each shape; shapes without one are left out."""
        ...

    def failed_runs(self, shape_ids: SizedIterable[int], stage: str) -> Mapping[int, StageRun]:
        """The latest failed run of each shape; shapes without one are left out."""
        ...

    def failures(
        self,
        collection_id: int,
        *,
        stage: str | None = None,
        kind: FailureKind | None = None,
        after: int = 0,
        limit: int = 1000,
    ) -> Sequence[Failure]:
        """A page of failed runs by run id, of this stage and kind if given."""
        ...

    def stage_counts(self, collection_id: int) -> Sequence[StageCount]:
        """How far each stage is, by stage name."""
        ...

    def stage_paces(self, collection_id: int, since: datetime) -> Mapping[str, int]:
        """How many shapes each stage was done for since then; stages that did none are left out."""
        ...

    def failure_kinds(self, collection_id: int) -> Mapping[FailureKind, int]:
        """How many failed runs there are of each kind; every kind is a key."""
        ...

    def block(self, name: str) -> Block: ...

    def visible_blocks(self, *, after: int = 0, limit: int = 1000) -> Sequence[Block]:
        """A page of all blocks on record by id."""
        ...

    def unused_blocks(self, *, limit: int = 1000) -> Sequence[Block]:
        """Blocks that no current run needs and that are not the only place of a mesh somebody labelled."""
        ...

    def supersede_block(self, name: str) -> int:
        """Record that a block's arrays are lost: its runs are current no more, so they will be done again.

        Returns how many runs that were.
        """
        ...

    def delete_blocks(self, names: SizedIterable[str]) -> None:
        """Forget blocks and their superseded runs. `ConflictError` if one is in use: then nothing is deleted."""
        ...
